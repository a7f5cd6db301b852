// A plot of a document: gnuplot draws it where there is a gnuplot.
#pragma once

#include <string>

namespace intaglio::report {

struct Plot {
    std::string name;    // as a file name, without extension
    std::string script;  // for gnuplot; writes SVG to its standard output
};

// A name as a file name and a heading's anchor alike: letters, digits and low lines.
std::string file_name(std::string name);

}  // namespace intaglio::report

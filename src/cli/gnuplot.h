// Plots of documents: gnuplot, the program, draws them.
#pragma once

#include <string>

#include "generator/base/result.h"

namespace intaglio::cli {

// What gnuplot writes for a script whose terminal is a text format, svg.  Errors: "no-gnuplot",
// "file-unwritable" where there is no place for the script.
Result<std::string> plotted(const std::string& script);

}  // namespace intaglio::cli

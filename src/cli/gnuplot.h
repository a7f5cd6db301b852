// Plots of documents: gnuplot, the program, draws them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/report/plot.h"

namespace intaglio::cli {

// What gnuplot writes for a script whose terminal is a text format, svg.  Errors: "no-gnuplot",
// "file-unwritable" where there is no place for the script.
Result<std::string> plotted(const std::string& script);

// Each as NAME.svg in a folder, which is made; all are drawn before the first is written.
Status write_plots(const std::vector<report::Plot>& plots, const std::filesystem::path& folder);

}  // namespace intaglio::cli

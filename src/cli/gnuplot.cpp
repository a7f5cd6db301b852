// The script lies in a file of its own while gnuplot reads it: it has no other way to take a script
// and give its plot back over one pipe.
#include "src/cli/gnuplot.h"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/report/command.h"

namespace intaglio::cli {

namespace fs = std::filesystem;

Result<std::string> plotted(const std::string& script) {
    std::error_code failure;
    const fs::path folder = fs::temp_directory_path(failure);
    std::string path = (folder / "intaglio-plot-XXXXXX").string();
    const int file = failure ? -1 : mkstemp(path.data());
    if (file < 0)
        return input_error(
            "file-unwritable",
            fmt::format("no temporary file can be made in {}; TMPDIR names the "
                        "folder",
                        failure ? "this system's folder for such" : folder.string()));
    const auto size = static_cast<ssize_t>(script.size());
    const bool written = write(file, script.data(), script.size()) == size;
    close(file);
    std::string plot;
    int code = -1;
    const std::string command = "gnuplot " + report::shell_quoted(path);
    if (FILE* pipe = written ? popen(command.c_str(), "r") : nullptr) {
        std::array<char, 65536> block;
        for (std::size_t n; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
            plot.append(block.data(), n);
        code = pclose(pipe);
    }
    fs::remove(path, failure);
    if (code != 0 || plot.empty())
        return input_error("no-gnuplot",
                           "gnuplot did not draw the plots; on Debian it is in gnuplot-nox");
    return plot;
}

Status write_plots(const std::vector<report::Plot>& plots, const fs::path& folder) {
    std::vector<std::string> drawn;
    for (const report::Plot& plot : plots) {
        Result<std::string> svg = plotted(plot.script);
        if (!svg) return svg.error();
        drawn.push_back(std::move(*svg));
    }
    std::error_code failure;
    fs::create_directories(folder, failure);
    for (std::size_t i = 0; i < plots.size(); ++i)
        if (Status status =
                write_product((folder / (plots[i].name + ".svg")).string(), drawn[i], false);
            !status)
            return status;
    return Done{};
}

}  // namespace intaglio::cli

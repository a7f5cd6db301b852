// The hard suite from the command line.
#include "src/cli/hard.h"

#include <fmt/format.h>
#include <filesystem>
#include <functional>

#include "src/cli/commands.h"
#include "src/cli/gnuplot.h"
#include "src/cli/progress.h"
#include "src/measure/hard.h"
#include "src/report/hard_table.h"
#include "src/report/stability_page.h"

namespace intaglio::cli {
namespace {

struct HardOptions {
    std::string only;  // part of a technique's name; empty: all
    std::string device;
    std::string output = "-";
};

Status hard(const dsl::Catalogue& catalogue, const HardOptions& options) {
    std::vector<measure::HardRow> rows;
    for (const measure::HardRow& row : measure::hard_rows())
        if (row.name.find(options.only) != std::string::npos) rows.push_back(row);
    if (rows.empty())
        return input_error("option-value",
                           fmt::format("--only: no technique's name contains '{}'; they read "
                                       "relief, shadow march, normal map",
                                       options.only));
    const Result<vulkan::Device> device = vulkan::Device::create({options.device, false});
    if (!device) return device.error();
    const Result<measure::HardSuite> suite = [&] {
        ProgressLine progress("judged", "techniques");
        return measure::run_hard_suite(*device, catalogue, rows, measure::hard_cases(),
                                       std::ref(progress));
    }();
    if (!suite) return suite.error();
    return write_product(options.output, report::hard_page(*suite), false);
}

struct StabilityOptions {
    std::string device;
    std::string output = "-";
};

Status stability(const dsl::Catalogue& catalogue, const StabilityOptions& options) {
    const Result<vulkan::Device> device = vulkan::Device::create({options.device, false});
    if (!device) return device.error();
    std::vector<measure::GuardRow> guards = measure::guard_rows();
    if (Status status = measure::measure_guards(*device, catalogue, guards); !status) return status;
    const Result<std::vector<measure::FarRow>> far = measure::far_rows(catalogue);
    if (!far) return far.error();
    const Result<std::vector<measure::FarCost>> costs = measure::far_costs(catalogue);
    if (!costs) return costs.error();
    const std::filesystem::path file = options.output == "-" ? "stability.md" : options.output;
    const std::filesystem::path pictures = "images" / file.stem();
    const report::StabilityPage page = report::stability_page(measure::stability_curves(), *far,
                                                              *costs, guards, pictures.string());
    if (options.output != "-")
        if (Status status = write_plots(page.plots, file.parent_path() / pictures); !status)
            return status;
    return write_product(options.output, page.text, false);
}

}  // namespace

void add_stability(CLI::App& app, const dsl::Catalogue& catalogue,
                   std::function<Status()>& chosen) {
    auto options = std::make_shared<StabilityOptions>();
    CLI::App* command = app.add_subcommand(
        "stability",
        "Published formulas beside the stable ones, and what each guard costs, as a page; "
        "beside a file its plots, images/NAME/*.svg");
    command->add_option("--device", options->device,
                        "Part of a Vulkan device's name; lavapipe if not given");
    command->add_option("-o,--output", options->output, "File; - is stdout")->capture_default_str();
    command->callback([&chosen, &catalogue, options] {
        chosen = [&, options] { return stability(catalogue, *options); };
    });
}

void add_hard(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen) {
    auto options = std::make_shared<HardOptions>();
    CLI::App* command = app.add_subcommand(
        "hard", "Every technique on every input that relief shaders break on, in Markdown");
    command->add_option("--only", options->only, "Techniques whose name contains this");
    command->add_option("--device", options->device,
                        "Part of a Vulkan device's name; lavapipe if not given");
    command->add_option("-o,--output", options->output, "File; - is stdout")->capture_default_str();
    command->callback([&chosen, &catalogue, options] {
        chosen = [&, options] { return hard(catalogue, *options); };
    });
}

}  // namespace intaglio::cli

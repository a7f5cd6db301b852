// `intaglio report`.
#include <charconv>
#include <filesystem>

#include <fmt/format.h>

#include "src/budget/budgets.h"
#include "src/cli/commands.h"
#include "src/cli/gnuplot.h"
#include "src/maps/files.h"
#include "src/measure/named_metric.h"
#include "src/report/command.h"
#include "src/report/front.h"
#include "src/report/gallery.h"
#include "src/report/html.h"
#include "src/report/live.h"
#include "src/report/page_times.h"

namespace intaglio::cli {
namespace {

constexpr std::size_t largest_results = std::size_t{1} << 30;

// A sweep's results where the folder has them, else a measurement's.
Result<report::PageData> read_data(const dsl::Catalogue& catalogue,
                                   const std::filesystem::path& folder) {
    const bool is_sweep = std::filesystem::exists(folder / "results.jsonl");
    const std::filesystem::path file = folder / (is_sweep ? "results.jsonl" : "results.json");
    const Result<std::vector<unsigned char>> bytes = maps::read_file(file, largest_results);
    if (!bytes) return bytes.error();
    const std::string text(bytes->begin(), bytes->end());
    return is_sweep ? report::page_data_of_sweep(text, file.string(), catalogue)
                    : report::page_data_of_measurement(text, file.string());
}

// A file of the data, as seen from here.
std::string map_file(const std::string& folder, const std::string& file) {
    return (std::filesystem::path(folder) / file).lexically_normal().string();
}

// The maps that the data's commands name; an unnamed one is an empty set, and one that cannot be
// read is an error.
Result<std::vector<measure::MapSet>> maps_of(const report::PageData& page,
                                             const std::string& folder) {
    std::vector<measure::MapSet> sets;
    for (const auto& [arguments, scale] : page.maps) {
        MapOptions options;
        options.scale = scale;
        for (std::size_t i = 0; i + 1 < arguments.size(); i += 2) {
            const std::string& value = arguments[i + 1];
            if (arguments[i] == "--height") options.height = map_file(folder, value);
            if (arguments[i] == "--normal") options.normal = map_file(folder, value);
            if (arguments[i] == "--colour") options.colour = map_file(folder, value);
            if (arguments[i] == "--maker") options.maker = value;
            if (arguments[i] == "--map-size") options.map_size = value;
            if (arguments[i] == "--seed")
                std::from_chars(value.data(), value.data() + value.size(), options.seed);
        }
        sets.emplace_back();
        if (arguments.empty()) continue;
        Result<measure::MapSet> set = map_set_of(options);
        if (!set) return set.error();
        sets.back() = std::move(*set);
    }
    return sets;
}

// The section that runs shaders, on the first maps of the data.
Result<std::string> live_part(const report::PageData& page,
                              const std::vector<measure::MapSet>& sets,
                              const dsl::Catalogue& catalogue) {
    constexpr std::size_t most_maps = 3;  // each is about 200 KB of the page
    report::LiveOptions options;
    for (std::size_t i = 0; i < sets.size() && options.maps.size() < most_maps; ++i)
        if (!sets[i].heights.texels.empty())
            options.maps.push_back({sets[i], page.maps[i].arguments});
    if (options.maps.empty()) return std::string();
    options.scale = page.maps.front().scale;
    return report::live_section(catalogue, options);
}

// What a budget file says of the page's variants.
Status add_budgets(report::PageData& page, const std::string& file) {
    const Result<budget::Budgets> budgets = budget::read_budgets(file);
    if (!budgets) return budgets.error();
    std::vector<report::PageLimit> limits;
    for (std::size_t i = 0; i < page.variants.size(); ++i) {
        const VariantRequest& variant = page.variants[i];
        // As `check` names them: a scene's shaders by its surfaces, whatever was chosen for them.
        const std::string named = page.json["variants"][i].value("scene_surface", "");
        const std::string settings = named.empty() ? report::settings_of(variant) : "";
        for (const measure::Metric& metric : measure::metrics()) {
            const std::optional<budget::Bound> bound = budgets->bound(
                named.empty() ? variant.surface : named, variant.target, settings, metric.name);
            if (bound && bound->max) limits.push_back({i, std::string(metric.name), *bound->max});
        }
    }
    report::add_limits(page, limits, file);
    return Done{};
}

Status write_page(report::PageData& page, const dsl::Catalogue& catalogue,
                  const ReportOptions& options) {
    if (Status status = report::add_sources(page, catalogue); !status) return status;
    if (!options.budgets.empty())
        if (Status status = add_budgets(page, options.budgets); !status) return status;
    if (!options.chips.empty())
        if (Status status = report::add_chips(page, catalogue, options.chips); !status)
            return status;
    std::string live;
    if (options.pictures) {
        const Result<std::vector<measure::MapSet>> sets = maps_of(page, options.maps);
        if (!sets) return sets.error();
        if (Status status = report::add_gallery(page, catalogue, *sets, {options.picture_size});
            !status)
            return status;
        if (Status status = report::add_times(page, catalogue, *sets, options.rounds); !status)
            return status;
        Result<std::string> section = live_part(page, *sets, catalogue);
        if (!section) return section.error();
        live = std::move(*section);
    }
    std::string command = fmt::format("intaglio report {}", report::shell_quoted(options.folder));
    if (options.maps != ".") command += " --maps " + report::shell_quoted(options.maps);
    if (!options.budgets.empty()) command += " --budgets " + report::shell_quoted(options.budgets);
    for (const std::string& chip : options.chips)
        command += " --chip " + report::shell_quoted(chip);
    page.json["commands"] = {command + " -o " + report::shell_quoted(options.output)};
    return write_product(options.output, report::html(page, live), false);
}

Status write_document(const report::PageData& page, const std::string& file) {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    const std::string pictures = "images/" + std::filesystem::path(file).stem().string();
    const Result<std::vector<unsigned char>> before = maps::read_file(file, largest_results);
    if (!before) return before.error();
    const report::FrontDocument made = report::front_document(page, pictures);
    Result<std::string> text =
        report::with_front(std::string(before->begin(), before->end()), made.text);
    if (!text) {
        Diagnostic error = text.error();
        error.file = file;
        return error;
    }
    if (Status status = write_plots(made.plots, folder / pictures); !status) return status;
    return write_product(file, *text, false);
}

}  // namespace

Status make_report(const dsl::Catalogue& catalogue, const ReportOptions& options) {
    if (options.output.empty() && options.markdown.empty())
        return input_error("usage", "nothing to make: give a page, -o FILE, or --markdown FILE");
    Result<report::PageData> page = read_data(catalogue, options.folder);
    if (!page) return page.error();
    if (!options.markdown.empty())
        if (Status status = write_document(*page, options.markdown); !status) return status;
    if (!options.output.empty()) return write_page(*page, catalogue, options);
    return Done{};
}

}  // namespace intaglio::cli

// `intaglio check` and `intaglio diff`: budgets, and what changed.
#include <ctime>

#include <fmt/format.h>

#include "src/budget/formats.h"
#include "src/budget/planned.h"
#include "src/budget/verdict.h"
#include "src/build/depfile.h"
#include "src/cli/commands.h"
#include "src/cli/planned.h"
#include "src/maps/files.h"
#include "src/scene/measurement.h"
#include "src/scene/scene.h"

namespace intaglio::cli {
namespace {

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    return fmt::format("{:04}-{:02}-{:02}", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday);
}

Result<std::string> formatted(const budget::Verdict& verdict, const std::string& format) {
    if (format == "text") return budget::to_text(verdict);
    if (format == "json") return budget::to_json(verdict);
    if (format == "junit") return budget::to_junit(verdict);
    if (format == "github") return budget::to_github(verdict);
    if (format == "sarif") return budget::to_sarif(verdict);
    return input_error(
        "unknown-format",
        fmt::format("unknown format '{}'; there are: text, json, junit, github, sarif", format));
}

// A baseline that is not there yet holds nothing.
Result<std::vector<budget::Observation>> baseline_of(const std::filesystem::path& path) {
    std::error_code ignored;
    if (path.empty() || !std::filesystem::exists(path, ignored))
        return std::vector<budget::Observation>();
    return budget::read_lines(path);
}

// What the budgets' scene is now, whichever kind of file it is; `read` gets the files.
Result<std::vector<budget::Observation>> observed(const dsl::Catalogue& catalogue,
                                                  const std::filesystem::path& file,
                                                  std::vector<std::filesystem::path>& read) {
    const Result<bool> has_surfaces = scene::is_scene(file);
    if (!has_surfaces) return has_surfaces.error();
    if (*has_surfaces) {
        const Result<PlannedScene> planned = planned_scene(catalogue, file.string());
        if (!planned) return planned.error();
        read = planned->scene.inputs;
        return budget::observe(catalogue, planned->scene, planned->plan);
    }
    const auto measurement = scene::read_measurement_with_sources(file);
    if (!measurement) return measurement.error();
    read = measurement->inputs;
    return budget::observe(catalogue, *measurement);
}

// What a budget's verdict depends on, as a build wants to know it.
Status write_depfile(const CheckOptions& options, const std::filesystem::path& baseline,
                     const std::vector<std::filesystem::path>& measured) {
    if (options.depfile.empty()) return Done{};
    std::vector<std::string> read = {options.budgets};
    std::error_code ignored;
    // Make and Ninja take a file that is not there for one that changed.
    if (std::filesystem::exists(baseline, ignored)) read.push_back(baseline.string());
    for (const std::filesystem::path& path : measured) read.push_back(path.string());
    const Result<std::string> text = build::depfile_text(
        options.depfile_target.empty() ? options.budgets : options.depfile_target, read);
    return text ? write_product(options.depfile, *text, false) : text.error();
}

}  // namespace

Status check(const dsl::Catalogue& catalogue, const CheckOptions& options) {
    const auto budgets = budget::read_budgets(options.budgets);
    if (!budgets) return budgets.error();
    // Said before minutes of measuring.
    if (const auto known = formatted({}, options.format); !known) return known.error();
    const std::filesystem::path baseline = options.baseline.empty()
                                               ? budgets->baseline.value_or(std::filesystem::path())
                                               : std::filesystem::path(options.baseline);
    if (baseline.empty() && (options.update || options.patch))
        return input_error("no-baseline",
                           "the budgets name no baseline to write: add baseline = \"FILE\" or give "
                           "--baseline FILE",
                           options.budgets);
    auto before = baseline_of(baseline);
    if (!before) return before.error();
    std::vector<std::filesystem::path> measured;
    const auto now = observed(catalogue, budgets->scene, measured);
    if (!now) return now.error();
    if (options.patch) {
        const std::string text = budget::to_patch(
            baseline.generic_string(), budget::to_lines(*before), budget::to_lines(*now));
        return write_product(options.output, text, false);
    }
    if (options.update) {
        if (Status status = write_product(baseline.string(), budget::to_lines(*now), false);
            !status)
            return status;
        before = *now;
    }
    const budget::Verdict verdict =
        budget::judge(*budgets, *now, *before, options.today.empty() ? today() : options.today);
    const auto text = formatted(verdict, options.format);
    if (!text) return text.error();
    if (!options.quiet || !verdict.passes())
        if (Status status = write_product(options.output, *text, false); !status) return status;
    if (Status status = write_depfile(options, baseline, measured); !status) return status;
    if (verdict.passes()) return Done{};
    Diagnostic error = input_error(std::string(over_budget), "not within budget", options.budgets);
    if (!baseline.empty() && !options.update)
        error.notes.push_back(fmt::format(
            "hint: growth that is meant: intaglio check {} --update, or --patch for a patch",
            options.budgets));
    return error;
}

Status diff(const DiffOptions& options) {
    const auto before = budget::read_lines(options.before),
               after = budget::read_lines(options.after);
    if (!before) return before.error();
    if (!after) return after.error();
    const auto text = formatted(budget::difference(*before, *after), options.format);
    if (!text) return text.error();
    return write_product("-", *text, false);
}

}  // namespace intaglio::cli

// `intaglio measure`.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/cli/planned.h"
#include "src/cli/progress.h"
#include "src/maps/png.h"
#include "src/measure/measure.h"
#include "src/measure/shot.h"
#include "src/measure/sweep.h"
#include "src/plan/sweep.h"
#include "src/report/command.h"
#include "src/report/picture.h"
#include "src/report/report.h"
#include "src/scene/measurement.h"

namespace intaglio::cli {

namespace {

// For each map one sheet: a line per variant with its picture and its error map, at the middle view
// of the plan.
Status write_case_sheets(const dsl::Catalogue& catalogue, const measure::Plan& plan,
                         const std::filesystem::path& folder) {
    const Result<vulkan::Device> device = vulkan::Device::create({plan.device, plan.validation});
    if (!device) return device.error();
    const measure::Shot shot{plan.views[plan.views.size() / 2], plan.lights[plan.lights.size() / 2],
                             plan.scale, plan.size, plan.size};
    for (const measure::MapSet& set : plan.maps) {
        const measure::Textures textures(set, plan.filtering);
        std::vector<std::vector<report::Tile>> lines;
        for (const VariantRequest& row : plan.rows) {
            // Targets draw the same pixels; one line per surface and settings is enough.
            if (row.target != plan.rows.front().target) continue;
            const Result<vulkan::Picture> picture =
                measure::draw_shot(*device, catalogue, row, textures, shot);
            if (!picture) return picture.error();
            const Result<std::vector<measure::HitError>> errors =
                measure::shot_errors(*device, catalogue, row, set, textures, shot);
            if (!errors) return errors.error();
            const measure::HitStatistics hits = measure::summarize(*errors, shot.width);
            lines.push_back({{report::to_image(*picture),
                              fmt::format("{} {}", row.surface, report::settings_of(row))},
                             {report::error_map(*errors, shot.width),
                              fmt::format("p95 {:.2f} texels, missed {:.1f} %", hits.p95,
                                          100.0 * static_cast<double>(hits.missed) /
                                              static_cast<double>(hits.pixels))}});
        }
        const Result<maps::Image> sheet = report::contact_sheet(
            lines, fmt::format("{}: eye at {:g} degrees, light at {:g}", set.name,
                               shot.view.elevation, shot.light.elevation));
        if (!sheet) return sheet.error();
        if (Status status = maps::write_png(folder / (set.name + ".png"), *sheet); !status)
            return status;
    }
    return Done{};
}

// What a plan chose for each surface and target, on its own map, views and lights: a sweep.
Status measure_planned(const dsl::Catalogue& catalogue, const MeasureOptions& options) {
    if (!options.height.empty() || !options.baked.empty())
        return input_error("usage",
                           "the surfaces of a scene have maps of their own; --height and --baked "
                           "are for measurement files",
                           options.scene);
    Result<PlannedScene> planned = planned_scene(catalogue, options.scene);
    if (!planned) return planned.error();
    if (options.size > 0) planned->scene.size = options.size;
    measure::SweepPlan plan = plan::sweep_of(planned->scene, planned->plan);
    plan.device = options.device;
    measure::SweepOptions sweep;
    sweep.folder = options.output;
    sweep.workers = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    sweep.validation = options.validation;
    const Result<measure::SweepSummary> summary = [&] {
        ProgressLine progress("measured", "cases");
        sweep.progress = [&](int, int done, int all) { progress(done, all); };
        return measure::run_sweep(catalogue, plan, sweep);
    }();
    if (!summary) return summary.error();
    const std::filesystem::path folder = std::filesystem::path(options.scene).parent_path();
    Status told = write_product(
        "-",
        fmt::format("{} shaders of {} surfaces on {} cases, {} known from before; to look at "
                    "them:\n  intaglio report {} --maps {} -o report.html\n",
                    plan.rows.size(), planned->scene.surfaces.size(), summary->all, summary->found,
                    report::shell_quoted(options.output),
                    report::shell_quoted(folder.empty() ? "." : folder.string())),
        false);
    // What could be chosen is measured all the same.
    return told ? check_satisfied(planned->plan, options.scene) : told;
}

}  // namespace

Status measure_scene(const dsl::Catalogue& catalogue, const MeasureOptions& options) {
    const Result<bool> has_surfaces = scene::is_scene(options.scene);
    if (!has_surfaces) return has_surfaces.error();
    if (*has_surfaces) return measure_planned(catalogue, options);
    std::optional<measure::MapFiles> own_map;
    const Result<std::map<std::string, std::filesystem::path>> baked = baked_files(options.baked);
    if (!baked) return baked.error();
    if (!options.height.empty()) own_map = measure::MapFiles{options.height, {}, {}, *baked};
    Result<scene::Measurement> scene = scene::read_measurement_with_sources(options.scene, own_map);
    if (!scene) return scene.error();
    measure::Plan& plan = scene->plan;
    if (options.size > 0) plan.size = options.size;
    if (!options.device.empty()) plan.device = options.device;
    plan.validation = options.validation;

    const std::filesystem::path folder = options.output;
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure)
        return input_error("file-unwritable",
                           fmt::format("cannot make this folder: {}", failure.message()),
                           options.output);
    const Result<measure::Measurement> measurement = [&] {
        ProgressLine progress("measured", "views");
        return measure::measure(catalogue, plan, std::ref(progress));
    }();
    if (!measurement) return measurement.error();
    const std::string table = report::table(plan, *measurement);
    for (const auto& [name, text] :
         {std::pair{"results.json", report::to_json(plan, *measurement, scene->map_arguments)},
          std::pair{"results.csv", report::to_csv(plan, *measurement, scene->map_arguments)},
          std::pair{"table.txt", table}})
        if (Status status = write_product((folder / name).string(), text, false); !status)
            return status;
    if (Status status = write_case_sheets(catalogue, plan, folder); !status) return status;
    return write_product("-", table, false);
}

}  // namespace intaglio::cli

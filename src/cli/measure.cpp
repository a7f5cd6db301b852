// `intaglio measure` and `intaglio bake`.
#include <unistd.h>

#include <filesystem>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/maps/bake.h"
#include "src/maps/png.h"
#include "src/measure/measure.h"
#include "src/report/report.h"
#include "src/scene/scene.h"

namespace intaglio::cli {

Status measure_scene(const dsl::Catalogue& catalogue, const MeasureOptions& options) {
    Result<measure::Plan> plan = scene::read_scene(options.scene);
    if (!plan) return plan.error();
    if (!options.height.empty()) {
        Result<measure::MapSet> set = measure::load_map_set({options.height, {}, {}}, plan->scale);
        if (!set) return set.error();
        plan->maps = {std::move(*set)};
    }
    if (!options.device.empty()) plan->device = options.device;
    plan->validation = options.validation;

    std::error_code failure;
    std::filesystem::create_directories(options.output, failure);
    if (failure) return input_error("file-unwritable", fmt::format("cannot make this folder: {}", failure.message()), options.output);
    const bool terminal = isatty(STDERR_FILENO);
    const Result<measure::Measurement> measurement = measure::measure(catalogue, *plan, [&](int done, int all) {
        if (terminal) fmt::print(stderr, "\rmeasured {} of {} views{}", done, all, done == all ? "\n" : "");
    });
    if (!measurement) return measurement.error();
    const std::filesystem::path folder = options.output;
    for (const auto& [name, text] : {std::pair{"results.json", report::to_json(*plan, *measurement)},
                                     std::pair{"results.csv", report::to_csv(*plan, *measurement)},
                                     std::pair{"table.txt", report::table(*plan, *measurement)}})
        if (Status status = write_product((folder / name).string(), text, false); !status) return status;
    return write_product("-", report::table(*plan, *measurement), false);
}

Status bake_normal(const BakeOptions& options) {
    if (options.kernel != "central" && options.kernel != "sobel")
        return input_error("option-value", fmt::format("--kernel is central or sobel, not '{}'", options.kernel));
    if (options.wrap != "repeat" && options.wrap != "clamp")
        return input_error("option-value", fmt::format("--wrap is repeat or clamp, not '{}'", options.wrap));
    const Result<maps::Image> source = maps::read_png(options.input);
    if (!source) return source.error();
    const Result<maps::Image> heights = maps::heights_of(*source, maps::HeightSource::Automatic);
    if (!heights) return heights.error();
    Result<maps::Image> normals =
        maps::bake_normal(*heights, options.scale, options.kernel == "central" ? maps::NormalKernel::Central : maps::NormalKernel::Sobel,
                          options.wrap == "repeat" ? maps::Wrap::Repeat : maps::Wrap::Clamp);
    if (normals && options.keep_height) normals = maps::with_height_in_alpha(*normals, *heights);
    if (!normals) return normals.error();
    return maps::write_png(options.output, *normals);
}

}  // namespace intaglio::cli

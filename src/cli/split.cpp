// `intaglio split`: the passes of a split surface and their cost, and what the format of the
// picture between them costs in error.
#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/measure/split.h"

namespace intaglio::cli {
namespace {

// "1: section 1 of 2 of the search; 40 arithmetic and ..."
Status print_passes(const dsl::Catalogue& catalogue, VariantRequest request) {
    const int passes = dsl::pass_count(request.split);
    for (request.pass = 1; request.pass <= passes; ++request.pass) {
        const Result<Variant> variant = make_variant(catalogue, request);
        if (!variant) return variant.error();
        const Result<Judged> judged = judge_variant(*variant);
        if (!judged) return judged.error();
        fmt::print("pass {}, {}: {}\n", request.pass, dsl::pass_work(request.split, request.pass),
                   cost_text(*variant->target, *judged));
    }
    return Done{};
}

void print_formats(const VariantRequest& request, const std::vector<measure::FormatError>& errors) {
    fmt::print("\nhits moved against {}, in texels; greatest offset {:.4g} texture units\n",
               request.split.sections > 1 ? "the same passes in RGBA32F" : "one pass",
               errors.front().code.range);
    fmt::print("{:<8} {:>8} {:>8} {:>8} {:>8} {:>7} {:>9} {:>7} {:>9} {:>9} | {:>8} {:>8}\n",
               "format", "bound", "median", "p99", "max", "beyond", "height", "shadow", "colour",
               "rms", "median*", "p99*");
    for (const measure::FormatError& error : errors)
        fmt::print(
            "{:<8} {:>8.2g} {:>8.2g} {:>8.2g} {:>8.2g} {:>7} {:>9.2g} {:>7} {:>9.2g} {:>9.2g} | "
            "{:>8.3g} {:>8.3g}\n",
            vulkan::name_of(error.code.format), error.bound, error.median, error.p99, error.max,
            error.beyond, error.height_max, error.visibility_changed, error.colour_max,
            error.colour_rms, error.hits.median, error.hits.p99);
    fmt::print(
        "beyond: pixels above the bound; height, colour: greatest change; shadow: pixels whose "
        "visibility changed by more than half; rms: of the colours\n* against the exact hit: with "
        "the error of the technique\n");
}

}  // namespace

Status split_table(const dsl::Catalogue& catalogue, const SplitOptions& options) {
    const Result<VariantRequest> request = request_of(options.variant);
    if (!request) return request.error();
    if (Status status = check_view(options.view, *request); !status) return status;
    if (dsl::pass_count(request->split) == 1)
        return input_error("option-value",
                           "--split is missing: shading, shadow, sections=3, or several by commas");
    const Result<measure::Filtering> filtering = filtering_of(options.map.filtering);
    if (!filtering) return filtering.error();
    const Result<measure::MapSet> set = map_set_of(options.map);
    if (!set) return set.error();
    if (Status status = print_passes(catalogue, *request); !status) return status;
    const Result<vulkan::Device> device = vulkan::Device::create({options.view.device, false});
    if (!device) return device.error();
    const measure::Textures textures(*set, *filtering);
    measure::Shot shot;
    shot.view = {options.view.elevation, options.view.azimuth};
    shot.light = options.view.light();
    shot.look = options.view.look();
    shot.scale = options.map.scale;
    shot.width = shot.height = options.size;
    const Result<std::vector<measure::FormatError>> errors = measure::shot_formats(
        *device, catalogue, *request, *set, textures, shot, measure::pass_formats());
    if (!errors) return errors.error();
    print_formats(*request, *errors);
    return Done{};
}

}  // namespace intaglio::cli

// Shots.
#include "src/measure/shot.h"

#include "src/measure/hits_request.h"
#include "src/measure/split.h"

namespace intaglio::measure {

Result<vulkan::Picture> draw_shot(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                                  const VariantRequest& request, const Textures& textures,
                                  const Shot& shot) {
    const Result<std::vector<check::Program>> passes = link_passes(catalogue, request);
    if (!passes) return passes.error();
    return draw_passes(*passes, offset_code(shot.format, shot_range(shot)),
                       prepare_shot(device, textures, shot));
}

Result<std::vector<HitError>> shot_errors(const vulkan::Device& device,
                                          const dsl::Catalogue& catalogue, VariantRequest request,
                                          const MapSet& set, const Textures& textures,
                                          const Shot& shot) {
    const Result<vulkan::Picture> displaced =
        draw_shot(device, catalogue, hits_request(catalogue, std::move(request)), textures, shot);
    if (!displaced) return displaced.error();
    const reference::HeightField field = set.height_field(reference::FilterWeights::Exact);
    const float scale = static_cast<float>(shot.scale);
    const ExactPicture exact =
        trace_exact(field, shot.view, shot.light, scale, shot.width, shot.height);
    return compare_hits(*displaced, exact, field, shot.view, scale);
}

}  // namespace intaglio::measure

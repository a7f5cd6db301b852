// Shots.
#include "src/measure/shot.h"

namespace intaglio::measure {

Result<vulkan::Picture> draw_shot(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                                  const VariantRequest& request, const Textures& textures,
                                  const Shot& shot) {
    const Result<Variant> variant = make_variant(catalogue, request);
    if (!variant) return variant.error();
    const Result<check::Program> shaders = link_variant(*variant);
    if (!shaders) return shaders.error();
    Result<vulkan::Program> program =
        prepare_quad(device, *shaders, textures, shot.scale, shot.width, shot.height);
    if (!program) return program.error();
    if (Status status = aim(*program, shot.view, shot.light); !status) return status.error();
    Result<std::vector<vulkan::Picture>> pictures = program->draw();
    if (!pictures) return pictures.error();
    return std::move(pictures->front());
}

Result<std::vector<HitError>> shot_errors(const vulkan::Device& device,
                                          const dsl::Catalogue& catalogue, VariantRequest request,
                                          const MapSet& set, const Textures& textures,
                                          const Shot& shot) {
    request.surface = dsl::with_part(request.surface, "output", "displaced");
    const Result<vulkan::Picture> displaced = draw_shot(device, catalogue, request, textures, shot);
    if (!displaced) return displaced.error();
    const reference::HeightField field = set.height_field(reference::FilterWeights::Exact);
    const float scale = static_cast<float>(shot.scale);
    const ExactPicture exact =
        trace_exact(field, shot.view, shot.light, scale, shot.width, shot.height);
    return compare_hits(*displaced, exact, field, shot.view, scale);
}

}  // namespace intaglio::measure

// One picture of a variant on a quad seen from infinity, and its errors: what people look at beside
// the numbers.
#pragma once

#include <vector>

#include "src/measure/hits.h"
#include "src/measure/render.h"
#include "src/variant/variant.h"

namespace intaglio::measure {

struct Shot {
    Direction view, light;
    double scale = 0.08;
    int width = 256, height = 256;
    // Of the pictures between the passes of a split surface, and the greatest offset they hold, in
    // texture units; 0: as the view needs.
    vulkan::Texture::Format format = vulkan::Texture::Format::Rgba32Float;
    double range = 0;
    Look look = {};
};

// The variant's first colour target; of a split surface that of its last pass.
Result<vulkan::Picture> draw_shot(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                                  const VariantRequest& request, const Textures& textures,
                                  const Shot& shot);

// The error of each pixel's hit against the exact one, whatever the surface writes.
Result<std::vector<HitError>> shot_errors(const vulkan::Device& device,
                                          const dsl::Catalogue& catalogue, VariantRequest request,
                                          const MapSet& set, const Textures& textures,
                                          const Shot& shot);

}  // namespace intaglio::measure

// A surface in passes, drawn pass after pass, and what the format of the picture between them
// costs: offsets are rounded to what the format holds, heights and visibility too (docs/split.md).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/measure/shot.h"

namespace intaglio::measure {

// How offsets, which are small and of either sign, are coded into the picture between passes.
struct OffsetCode {
    vulkan::Texture::Format format = vulkan::Texture::Format::Rgba32Float;
    double range = 0;                         // greatest |offset| along u and v, texture units
    std::array<float, 2> to_colour = {1, 0};  // colour = offset * [0] + [1]
    std::array<float, 2> to_offset = {1, 0};  // offset = colour * [0] + [1]
    // The most that an offset within the range may change by on its way, in texture units: half a
    // step in the unorm formats, a whole one in RGBA16F, where devices may round or truncate.
    // Roundings of binary32 come on top of it.
    double error = 0;
};

// RGBA8 and RGBA16 store offset / range, so that an offset of 0 is a step of its own (128 of 255,
// 32768 of 65535) and straight down nothing moves; the float formats store the offset itself.
// `range` is positive; offsets beyond it are clamped by the unorm formats.
OffsetCode offset_code(vulkan::Texture::Format format, double range);

// The greatest |offset| there is in a relief of depth `scale` seen so; at least a little for
// straight down.
double offset_range(Direction view, double scale);

// The formats in the order of their bits.
const std::vector<vulkan::Texture::Format>& pass_formats();
// rgba8, rgba16, rgba16f or rgba32f.  Error "format".
Result<vulkan::Texture::Format> format_named(const std::string& name);

// Every pass of a split surface as SPIR-V.
Result<std::vector<check::Program>> link_passes(const dsl::Catalogue& catalogue,
                                                const VariantRequest& request);

// Prepares one pass for drawing, ready to be drawn.
using PreparePass =
    std::function<Result<vulkan::Program>(const check::Program& shaders, const PassLink& link)>;
// The last pass' picture, in float32; those between in the code's format.
Result<vulkan::Picture> draw_passes(const std::vector<check::Program>& passes,
                                    const OffsetCode& code, const PreparePass& prepare);

// What a format costs on one draw, against the same surface unsplit, or, where the search runs in
// sections and so has another number of steps unsplit, against the same passes in RGBA32F.
struct FormatError {
    OffsetCode code;
    double bound = 0;  // texels: what code.error allows, and the roundings of binary32
    double median = 0, p99 = 0, max = 0;  // texels between the hits
    std::int64_t pixels = 0;
    std::int64_t beyond = 0;                // pixels above the bound
    double height_max = 0;                  // between the heights
    std::int64_t visibility_changed = 0;    // pixels: by more than half
    double colour_max = 0, colour_rms = 0;  // of linear rgb, after the shading
    HitStatistics hits;                     // against the exact first hit; only of shots
};

// What to compare, and how it is drawn.
struct SplitDraw {
    VariantRequest request;  // with its split
    double range = 0;        // see OffsetCode
    int map_width = 0, map_height = 0;
    PreparePass prepare;
    // Pixels of the displaced picture with this value show no surface, and do not count.
    std::optional<std::array<float, 4>> background = {};
};
// One row for each format.
Result<std::vector<FormatError>> compare_formats(
    const dsl::Catalogue& catalogue, const SplitDraw& draw,
    const std::vector<vulkan::Texture::Format>& formats);

// Draws a pass on a quad over the whole map; textures and shot must outlive it.
PreparePass prepare_shot(const vulkan::Device& device, const Textures& textures, const Shot& shot);
// shot.range, or what the view needs.
double shot_range(const Shot& shot);

// The same for a quad over the whole map, with the errors against the exact reference.
Result<std::vector<FormatError>> shot_formats(const vulkan::Device& device,
                                              const dsl::Catalogue& catalogue,
                                              const VariantRequest& request, const MapSet& set,
                                              const Textures& textures, const Shot& shot,
                                              const std::vector<vulkan::Texture::Format>& formats);

}  // namespace intaglio::measure

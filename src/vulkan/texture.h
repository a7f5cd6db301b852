// A texture as the runner takes it: RGBA floats with their mip levels, the format they are stored
// in on the device, and how they are sampled.  Formats are the witness: RGBA8 is filtered by
// lavapipe with 8-bit weights, RGBA32F exactly.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::vulkan {

struct Texture {
    enum class Filter { Nearest, Linear };
    enum class Wrap { Repeat, Clamp };
    enum class Format { Rgba8Unorm, Rgba16Unorm, Rgba16Float, Rgba32Float };

    int width = 0, height = 0;
    int depth = 0;  // 0: a 2D texture; else the slices of a volume, slice 0 at w = 0
    // Level l is max(1, width >> l) by max(1, height >> l) texels (by max(1, depth >> l) slices,
    // one after the other), row 0 at v = 0, four floats a texel.  The unorm formats store each
    // float as the nearest of 255 or 65535 steps in [0, 1].
    std::vector<std::vector<float>> levels;
    Filter filter = Filter::Linear;      // within a level
    Filter mip_filter = Filter::Linear;  // between levels
    Wrap wrap = Wrap::Repeat;
    Format format = Format::Rgba8Unorm;
};

// Says what is wrong with the sizes of `texture`, which the caller knows as `name`, as error
// `bad-texture`.
Status validate(const Texture& texture, const std::string& name);

// Texels of a level in the bytes of the format: the nearest number there is, ties to even in
// Rgba16Float; NaN is stored as 0 in the unorm formats.
std::vector<std::byte> encode(const std::vector<float>& level, Texture::Format format);
// The numbers that the bytes stand for, exactly but for the rounding of k / 255 and k / 65535 to
// float: encode gives the same bytes again.
std::vector<float> decode(std::span<const std::byte> bytes, Texture::Format format);

std::size_t bytes_per_texel(Texture::Format format);
// "RGBA8", "RGBA16", "RGBA16F", "RGBA32F".
const char* name_of(Texture::Format format);

}  // namespace intaglio::vulkan

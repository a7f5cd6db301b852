// Textures for the evaluator, read as Vulkan defines it: texel coordinate = uv * size - 0.5 for
// linear filtering, floor(uv * size) for nearest (Vulkan 1.3, "Texel Input Operations").
#pragma once

#include <array>
#include <vector>

namespace intaglio::ir {

struct Texture {
    enum class Filter { Nearest, Linear };
    enum class Wrap { Repeat, Clamp };
    // Exact: the fraction between texels as computed.  EightBit: the texel coordinate is first
    // rounded to a multiple of 1/256, as texture units commonly do.
    enum class Weights { Exact, EightBit };

    int width = 1;
    int height = 1;
    int depth = 1;  // 1 for a 2D texture
    // RGBA floats, x running fastest, then y, then z.  Level l has max(1, width >> l) columns, and
    // so on; there may be fewer levels than the full chain, but at least one.
    std::vector<std::vector<float>> levels;
    Filter filter = Filter::Linear;      // within a level
    Filter mip_filter = Filter::Linear;  // between levels; the fraction is exact
    Wrap wrap = Wrap::Repeat;
    Weights weights = Weights::Exact;

    // True if every level has as many texels as its size says.
    bool is_complete() const;
};

// A read at a coordinate (z is ignored if the depth is 1) and a level, which is clamped to the
// chain; all in T's precision.  Any numbers are safe: a NaN coordinate or level counts as 0, as
// does an infinite coordinate that repeats. A texture that is not complete reads as 0 where texels
// are missing.
template <typename T>
std::array<T, 4> sample_level(const Texture& texture, const std::array<T, 3>& coordinate, T level);

// The same, but the nearest texel of the nearest level, whatever filters the texture has.
template <typename T>
std::array<T, 4> sample_nearest(const Texture& texture, const std::array<T, 3>& coordinate,
                                T level);

// The level that two gradients (d uvw / dx and dy) ask for: log2 of the longer one in texels of
// level 0; not clamped.
template <typename T>
T level_of_gradients(const Texture& texture, const std::array<T, 3>& dx,
                     const std::array<T, 3>& dy);

}  // namespace intaglio::ir

// The height field of the reference: texels, and the surface a texture unit reconstructs from them.
// Between four neighbouring texel centres lies a cell; in it the surface is a bilinear patch.  With
// 8-bit filter weights (Direct3D 11 and 12, CUDA's 1.8 fixed point, lavapipe on 8-bit formats) it
// is a staircase instead: constant on each of 256 x 256 steps that are centred on the multiples of
// 1/256 texel.
#pragma once

#include <vector>

namespace intaglio::reference {

struct Vec2 {
    double x, y;
};

struct Vec3 {
    double x, y, z;
};

enum class Wrap { Repeat, Clamp };

enum class FilterWeights {
    Exact,     // real numbers
    EightBit,  // rounded to the nearest multiple of 1/256, halves up
};

// Row-major texels; row 0 is at v = 0 and the centre of texel (x, y) at ((x + 0.5) / width, (y +
// 0.5) / height). Heights are in [0, 1]: 1 is the polygon, 0 the deepest point.
struct HeightField {
    int width = 0;
    int height = 0;
    std::vector<double> heights;
    Wrap wrap = Wrap::Repeat;
    FilterWeights weights = FilterWeights::Exact;
};

// Both sides positive and one height for each texel.
bool is_valid(const HeightField& field);

// The height of the reconstructed surface at `uv`, exact to a few 1e-16 plus 1e-16 |uv| times the
// slope.  NaN where `uv` is not finite or the field not valid.
double height_at(const HeightField& field, Vec2 uv);

}  // namespace intaglio::reference

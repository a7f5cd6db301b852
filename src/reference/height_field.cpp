// The reconstructed surface at one point, for exact and for 8-bit filter weights.
#include "src/reference/height_field.h"

#include <cmath>
#include <limits>

#include "src/reference/patch.h"

namespace intaglio::reference {

bool is_valid(const HeightField& field) {
    return field.width > 0 && field.height > 0 &&
           field.heights.size() ==
               static_cast<std::size_t>(field.width) * static_cast<std::size_t>(field.height);
}

double height_at(const HeightField& field, Vec2 uv) {
    if (!is_valid(field) || !std::isfinite(uv.x) || !std::isfinite(uv.y)) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const double x = texel_coordinate(uv.x, field.width, field.wrap);
    const double y = texel_coordinate(uv.y, field.height, field.wrap);
    const double cell_x = std::floor(x);
    const double cell_y = std::floor(y);
    double fx = x - cell_x;
    double fy = y - cell_y;
    if (field.weights == FilterWeights::EightBit) {
        fx = std::floor(fx * 256 + 0.5) / 256;
        fy = std::floor(fy * 256 + 0.5) / 256;
    }
    return Patch(field, TexelPair(cell_x, field.width, field.wrap),
                 TexelPair(cell_y, field.height, field.wrap))
        .at(fx, fy);
}

}  // namespace intaglio::reference

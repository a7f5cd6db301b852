// One hemisphere.
#include "src/maps/bake_phong.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "src/maps/bake_grid.h"

namespace intaglio::maps {

Result<Image> bake_phong(double shininess, int size) {
    if (size < 16 || size > 4096)
        return input_error("image-size",
                           fmt::format("a phong map has 16 to 4096 texels a side, not {}", size));
    if (!(shininess > 0 && shininess <= 1024))
        return input_error(
            "shininess-range",
            fmt::format("a shininess is above 0 and at most 1024; {} is not", shininess));
    Image map = blank_image(size, size, 2, 8);
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const double x = ((column + 0.5) / size * 2 - 1) * phong_edge,
                         y = ((row + 0.5) / size * 2 - 1) * phong_edge;
            const double cosine = std::sqrt(std::max(0.0, 1 - x * x - y * y));
            map.at(column, row, 0) = rounded(cosine, 8);
            map.at(column, row, 1) = rounded(std::pow(cosine, shininess), 8);
        }
    return map;
}

}  // namespace intaglio::maps

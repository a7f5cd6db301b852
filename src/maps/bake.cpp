// Slopes by finite differences in double precision; a border texel under Clamp divides by the
// distance that its two samples really have, so that a plane keeps its slope up to the border.
#include "src/maps/bake.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "src/maps/bake_grid.h"

namespace intaglio::maps {
namespace {

// Far beyond any relief, and far from where the square of a slope overflows.
constexpr double largest_scale = 1e6;

// One axis of the map: which texels stand beside texel i, and how far apart they are.
struct Neighbours {
    int before = 0;
    int after = 0;
    double distance = 0;  // in texture units; 0: a single texel, without slope
};

Neighbours neighbours_of(int i, int size, Wrap wrap) {
    if (size == 1) return {i, i, 0};
    if (wrap == Wrap::Repeat) return {(i + size - 1) % size, (i + 1) % size, 2.0 / size};
    const int before = std::max(i - 1, 0);
    const int after = std::min(i + 1, size - 1);
    return {before, after, static_cast<double>(after - before) / size};
}

double slope(double before, double after, double distance) {
    return distance == 0 ? 0 : (after - before) / distance;
}

struct Slopes {
    double u = 0;
    double v = 0;
};

Slopes slopes_at(const Image& heights, int x, int y, NormalKernel kernel, Wrap wrap) {
    const Neighbours h = neighbours_of(x, heights.width, wrap);
    const Neighbours v = neighbours_of(y, heights.height, wrap);
    const auto along_u = [&](int row) {
        return slope(heights.at(h.before, row), heights.at(h.after, row), h.distance);
    };
    const auto along_v = [&](int column) {
        return slope(heights.at(column, v.before), heights.at(column, v.after), v.distance);
    };
    if (kernel == NormalKernel::Central) return {along_u(y), along_v(x)};
    // The outer two first: the sum is then the same for a flipped map.
    return {((along_u(v.before) + along_u(v.after)) + 2 * along_u(y)) / 4,
            ((along_v(h.before) + along_v(h.after)) + 2 * along_v(x)) / 4};
}

}  // namespace

Result<Image> bake_normal(const Image& heights, double scale, NormalKernel kernel, Wrap wrap,
                          const Work& work) {
    if (Status sound = check_image(heights); !sound) return sound.error();
    if (!(std::abs(scale) <= largest_scale)) {
        return input_error(
            "scale-range",
            fmt::format("the scale of the relief is a number from -{0} to {0}, not {1}",
                        largest_scale, scale));
    }
    Image normals = blank_image(heights.width, heights.height, 3, heights.bits);
    const auto fill_row = [&](int y) {
        for (int x = 0; x < heights.width; ++x) {
            const Slopes slopes = slopes_at(heights, x, y, kernel, wrap);
            std::array<double, 3> normal = {-slopes.u * scale, -slopes.v * scale, 1.0};
            const double length = std::hypot(normal[0], normal[1], normal[2]);
            for (int c = 0; c < 3; ++c) {
                const double component = normal[static_cast<std::size_t>(c)] / length;
                normals.at(x, y, c) = static_cast<float>(component * 0.5 + 0.5);
            }
        }
    };
    for_each_row(heights.height, fill_row, work);
    return normals;
}

}  // namespace intaglio::maps

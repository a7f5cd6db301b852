// The exact first hit for every texel and direction, then four directions to a texel.
#include "src/maps/bake_view_dependent.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "src/maps/bake_grid.h"

namespace intaglio::maps {
namespace {

// The first s in [0, length] with a + b s + c s^2 >= 0; negative if there is none.
double first_root(double a, double b, double c, double length) {
    if (a >= 0) return 0;
    const double inside = b * b - 4 * a * c;
    if (inside < 0) return -1;
    // Of the two roots 2 a / (-b -+ sqrt) the smaller positive one, without cancellation.
    const double half = -(b + std::copysign(std::sqrt(inside), b)) / 2;
    double first = -1;
    for (const double root : {half == 0 ? -1 : a / half, c == 0 ? -1 : half / c})
        if (root >= 0 && (first < 0 || root < first)) first = root;
    return first <= length ? first : -1;
}

// The t in [0, 1] at which the ray over (x, y), in texels, meets the surface.
double first_hit(const Grid& grid, double x, double y, double reach_u, double reach_v) {
    const double dx = -reach_u * grid.width(), dy = -reach_v * grid.height();
    // Above the highest texel there is nothing to meet.
    const double start = 1 - grid.top();
    double hit = 1;
    walk_line(grid, x + dx * start, y + dy * start, dx, dy, 1 - start, [&](const Piece& piece) {
        // Height of the surface less that of the ray, 1 - t.
        const double root = first_root(piece.a - grid.top() + piece.begin, piece.b + 1, piece.c,
                                       piece.end - piece.begin);
        if (root < 0) return true;
        hit = start + piece.begin + root;
        return false;
    });
    return std::clamp(hit, 0.0, 1.0);
}

// The reach of a direction of the grid, from -1 to 1 along both axes.
std::array<double, 2> reach_of(double x, double y) {
    const double length = std::hypot(x, y);
    if (length == 0) return {0, 0};
    const double kept = std::min(length, widest_view);
    const double reach = view_middle * kept / (1 - kept);
    return {x / length * reach, y / length * reach};
}

}  // namespace

Result<Volume> bake_view_dependent(const Image& heights, int columns, int rows, int views,
                                   const Work& work) {
    if (Status sound = check_image(heights); !sound) return sound.error();
    if (views < 2 || views > 32)
        return input_error(
            "views-range",
            fmt::format("a view-dependent map has 2 to 32 views along an axis, not {}", views));
    columns = std::clamp(columns, 1, heights.width);
    rows = std::clamp(rows, 1, heights.height);
    const int cells = views - 1, slices = cells * cells;
    if (Status fits = check_size(columns, static_cast<long long>(rows) * slices); !fits)
        return fits.error();
    const Grid grid(heights);
    Volume volume{slices, blank_image(columns, rows * slices, 4, heights.bits)};
    const auto fill_row = [&](int y) {
        const double v = (y + 0.5) * heights.height / rows - 0.5;
        for (int x = 0; x < columns; ++x) {
            const double u = (x + 0.5) * heights.width / columns - 0.5;
            for (int b = 0; b < views; ++b)
                for (int a = 0; a < views; ++a) {
                    const auto [reach_u, reach_v] =
                        reach_of(2.0 * a / cells - 1, 2.0 * b / cells - 1);
                    const float t = rounded(first_hit(grid, u, v, reach_u, reach_v), heights.bits);
                    for (int corner = 0; corner < 4; ++corner) {
                        const int i = a - (corner & 1), j = b - (corner >> 1);
                        if (i >= 0 && i < cells && j >= 0 && j < cells)
                            volume.at(x, y, j * cells + i, corner) = t;
                    }
                }
        }
    };
    for_each_row(rows, fill_row, work);
    return volume;
}

}  // namespace intaglio::maps

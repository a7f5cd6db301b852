// Along each line the steepest slope is at an end of a cell's piece or where the line of sight
// touches its parabola.
#include "src/maps/bake_horizon.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "src/maps/bake_grid.h"

namespace intaglio::maps {
namespace {

// The steepest slope from height `eye` at r = 0 to a point of the piece.
double steepest(const Piece& piece, double eye) {
    const double rise = piece.a - eye, length = piece.end - piece.begin;
    const auto slope = [&](double s) {
        return (rise + (piece.b + piece.c * s) * s) / (piece.begin + s);
    };
    // At the eye itself the slope is the surface's.
    double best = std::max(piece.begin > 0 ? slope(0) : piece.b, slope(length));
    if (piece.c == 0) return best;
    // The derivative of the slope vanishes where c s^2 + 2 c begin s + b begin - rise = 0.
    const double inside = piece.begin * piece.begin - (piece.b * piece.begin - rise) / piece.c;
    if (inside <= 0) return best;
    const double s = std::sqrt(inside) - piece.begin;
    return s > 0 && s < length ? std::max(best, slope(s)) : best;
}

double horizon(const Grid& grid, int x, int y, double cosine, double sine, double last) {
    const double eye = grid.at(x, y);
    double best = 0;
    const auto visit = [&](const Piece& piece) {
        if (piece.begin * best >= grid.top() - eye) return false;
        best = std::max(best, steepest(piece, eye));
        return true;
    };
    walk_line(grid, x, y, cosine * grid.width(), sine * grid.height(), last, visit);
    return best;
}

// Exact on the axes and diagonals, where a rounded cosine would leave the row of texels.
double exact_cosine(int direction, int azimuths) {
    const double turn = static_cast<double>(direction) / azimuths;
    const double quarter = turn * 4;
    if (quarter == std::round(quarter)) {
        const int k = Grid::wrapped(static_cast<int>(std::round(quarter)), 4);
        return k == 0 ? 1 : k == 2 ? -1 : 0;
    }
    const double value = std::cos(2 * std::numbers::pi * turn);
    const double diagonal = std::numbers::sqrt2 / 2;
    return std::abs(std::abs(value) - diagonal) < 1e-12 ? std::copysign(diagonal, value) : value;
}

}  // namespace

Result<std::vector<Image>> bake_horizon(const Image& heights, int azimuths, const Work& work) {
    if (Status sound = check_image(heights); !sound) return sound.error();
    if (azimuths < 4 || azimuths > 64 || azimuths % 4 != 0)
        return input_error(
            "azimuths-range",
            fmt::format("a horizon map has a multiple of 4 azimuths, 4 to 64, not {}", azimuths));
    const Grid grid(heights);
    const int count = azimuths / 4;
    std::vector<Image> images(static_cast<std::size_t>(count),
                              blank_image(heights.width, heights.height, 4, heights.bits));
    const double last = azimuths == 4 ? 1 : azimuths == 8 ? std::numbers::sqrt2 : 2;
    const auto fill_row = [&](int y) {
        for (int x = 0; x < heights.width; ++x)
            for (int k = 0; k < azimuths; ++k) {
                const double cosine = exact_cosine(k, azimuths),
                             sine = exact_cosine(k + 3 * azimuths / 4, azimuths);
                const double slope = horizon(grid, x, y, cosine, sine, last);
                images[static_cast<std::size_t>(k % count)].at(x, y, k / count) =
                    rounded(slope / (slope + horizon_middle), heights.bits);
            }
    };
    for_each_row(heights.height, fill_row, work);
    return images;
}

}  // namespace intaglio::maps

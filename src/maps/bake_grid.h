// What the bakes share: a height map as the bilinear surface between texel centres, which repeats;
// rows shared out to threads; values rounded to a side.  Internal to src/maps.
//
// Cell (i, j) is the patch between the centres of texels (i, j) and (i + 1, j + 1).  Positions are
// in texels, with the centre of texel (x, y) at (x, y); texture coordinates are (x + 0.5) / width.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "src/maps/image.h"
#include "src/maps/work.h"

namespace intaglio::maps {

class Grid {
  public:
    // The first channel of a sound image.
    explicit Grid(const Image& heights);

    int width() const { return width_; }
    int height() const { return height_; }
    double top() const { return top_; }  // the highest texel

    int column(int x) const { return wrapped(x, width_); }
    int row(int y) const { return wrapped(y, height_); }
    double at(int x, int y) const { return heights_[index(column(x), row(y))]; }
    // The corners of a cell: (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1).
    std::array<double, 4> corners(int i, int j) const { return wrapped_corners(column(i), row(j)); }
    // The same for a cell of the map itself.
    std::array<double, 4> wrapped_corners(int left, int upper) const {
        const int right = left + 1 == width_ ? 0 : left + 1;
        const int lower = upper + 1 == height_ ? 0 : upper + 1;
        return {heights_[index(left, upper)], heights_[index(right, upper)],
                heights_[index(left, lower)], heights_[index(right, lower)]};
    }
    // The surface at a position.
    double height_at(double x, double y) const;

    static int wrapped(int at, int size) {
        const int rest = at % size;
        return rest < 0 ? rest + size : rest;
    }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }
    int width_, height_;
    double top_ = 0;
    std::vector<double> heights_;
};

// A piece of a line over the surface that lies in one cell: for r from `begin` to `end` the height
// is a + b s + c s^2 with s = r - begin.
struct Piece {
    double begin = 0, end = 0;
    double a = 0, b = 0, c = 0;
};

// Walks the line (x + dx r, y + dy r), positions in texels, from r = 0 to r = last, cell by cell,
// until `visit` gives false.  A line that stands still (dx = dy = 0) is one piece.
template <typename Visit>
void walk_line(const Grid& grid, double x, double y, double dx, double dy, double last,
               const Visit& visit) {
    const double infinity = HUGE_VAL;
    // On a border between two cells the one ahead is the first.
    const auto first_cell = [](double at, double step) {
        const double below = std::floor(at);
        return static_cast<int>(step < 0 && below == at ? below - 1 : below);
    };
    // The same cell inside the map, kept along: a remainder for each cell would cost as much as all
    // the rest.
    const auto step = [](int& at, int& inside, bool forward, int size) {
        at += forward ? 1 : -1;
        inside += forward ? 1 : -1;
        if (inside == size) inside = 0;
        if (inside < 0) inside = size - 1;
    };
    int i = first_cell(x, dx), j = first_cell(y, dy);
    int column = grid.column(i), row = grid.row(j);
    double begin = 0;
    while (begin < last) {
        const double to_x = dx == 0 ? infinity : ((dx > 0 ? i + 1 : i) - x) / dx;
        const double to_y = dy == 0 ? infinity : ((dy > 0 ? j + 1 : j) - y) / dy;
        const double end = std::min(std::min(to_x, to_y), last);
        if (end > begin) {
            const std::array<double, 4> h = grid.wrapped_corners(column, row);
            const double fx = x + dx * begin - i, fy = y + dy * begin - j;
            const double gx = h[1] - h[0], gy = h[2] - h[0], twist = h[3] - h[2] - gx;
            Piece piece{begin, end, 0, 0, 0};
            piece.a = h[0] + gx * fx + gy * fy + twist * fx * fy;
            piece.b = (gx + twist * fy) * dx + (gy + twist * fx) * dy;
            piece.c = twist * dx * dy;
            if (!visit(piece)) return;
        }
        if (end >= last) return;
        if (to_x <= end) step(i, column, dx > 0, grid.width());
        if (to_y <= end) step(j, row, dy > 0, grid.height());
        begin = end;
    }
}

// The nodes of a level of `fine` that node `at` of one of `coarse` touches: first, and one past the
// last.
struct Children {
    int first, end;
};
inline Children children_of(int at, int fine, int coarse) {
    const auto wide = [&](int node) { return static_cast<long long>(node) * fine; };
    return {static_cast<int>(wide(at) / coarse),
            static_cast<int>((wide(at + 1) + coarse - 1) / coarse)};
}

// Runs `row` for 0 to count - 1, shared out to threads; each row is done by one of them, so results
// do not depend on their number.
void for_each_row(int count, const std::function<void(int)>& row, const Work& work = {});

// The greatest multiple of 1 / (2^bits - 1) that is not above `value`, clamped to [0, 1]: what a
// texel of that many bits holds without claiming more.
float rounded_down(double value, int bits);
// The nearest one.
float rounded(double value, int bits);

}  // namespace intaglio::maps

// The steepest slope by which the surface rises from each cell, found by pruned search over all
// other cells; a texel's cone is the narrowest of the four cells around it.
#include "src/maps/bake_cone.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/maps/bake_grid.h"

namespace intaglio::maps {
namespace {

struct Range {
    double low = 0, high = 0;
};

Range range_of(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

// A bilinear patch.  Slopes are in height per texture unit.
struct Cell {
    std::array<double, 4> corners{};
    Range heights, slope_x, slope_y;
    // At its centre, the gradient in height per texel, and by how much twice each part varies.
    double centre = 0, gradient_x = 0, gradient_y = 0, twist = 0;
};

// Bound of the part of a gradient along an axis that a step in the direction `sign` climbs; sign 0:
// either direction.
double climb(Range slope, int sign) {
    if (sign > 0) return std::max(slope.high, 0.0);
    if (sign < 0) return std::max(-slope.low, 0.0);
    return std::max(slope.high, -slope.low);
}

// The steepest climb inside a cell in the directions of a quadrant, half plane or all.
double climb(const Cell& cell, int sign_x, int sign_y) {
    return std::hypot(climb(cell.slope_x, sign_x), climb(cell.slope_y, sign_y));
}

double farthest(Range path, Range end) {
    return std::max(path.high - end.low, end.high - path.low);
}

Range joined(Range a, Range b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

// Cells of one block along an axis, as seen from a cell: offsets first to first + count - 1.
struct Span {
    int block = 0;
    int first = 0;
    int count = 0;
    double gap = 0;  // least distance between a point of the cell and one of the span
};

// Least distance along an axis between cell 0 and the cells first to first + count - 1, in texels.
double gap_to(int first, int count) {
    return std::max(0.0, static_cast<double>(std::max(first - 1, -(first + count))));
}

// What a cell at `from` sees along an axis, nearest first.  A point farther away than half a period
// has a nearer copy, so half a period and the two cells' own extent is all there is.
std::vector<Span> spans_from(int from, int size, int side) {
    std::vector<Span> spans;
    const int reach = size / 2 + 1;
    for (int copy = -1; copy <= 1; ++copy)
        for (int block = 0; block * side < size; ++block) {
            const int begin = block * side + copy * size - from;
            const int end = std::min((block + 1) * side, size) + copy * size - from;
            const int first = std::max(begin, -reach), last = std::min(end - 1, reach);
            if (first <= last)
                spans.push_back(
                    {block, first, last - first + 1, gap_to(first, last - first + 1) / size});
        }
    std::sort(spans.begin(), spans.end(),
              [](const Span& a, const Span& b) { return a.gap < b.gap; });
    return spans;
}

class ConeBake {
  public:
    ConeBake(const Grid& grid, ConeKind kind) : grid_(grid), kind_(kind) {
        for (int j = 0; j < grid.height(); ++j)
            for (int i = 0; i < grid.width(); ++i) cells_.push_back(make_cell(i, j));
        const int larger = std::max(grid.width(), grid.height());
        side_ = std::max(8, larger / 64);
        blocks_x_ = (grid.width() + side_ - 1) / side_;
        const int blocks_y = (grid.height() + side_ - 1) / side_;
        tops_.assign(static_cast<std::size_t>(blocks_x_) * static_cast<std::size_t>(blocks_y), 0);
        for (int j = 0; j < grid.height(); ++j)
            for (int i = 0; i < grid.width(); ++i) {
                double& top = tops_[block_index(i / side_, j / side_)];
                top = std::max(top, cell(i, j).heights.high);
            }
        for (int i = 0; i < grid.width(); ++i)
            columns_.push_back(spans_from(i, grid.width(), side_));
        for (int j = 0; j < grid.height(); ++j)
            rows_.push_back(spans_from(j, grid.height(), side_));
    }

    // The bound of the slopes from any point of cell (i, j) to any point that counts.
    double slope_of(int i, int j) const {
        const Cell& from = cell(i, j);
        double slope = std::max(1 / widest_cone, near_slope(i, j));
        const auto& columns = columns_[static_cast<std::size_t>(i)];
        const auto& rows = rows_[static_cast<std::size_t>(j)];
        const std::size_t rings = std::max(columns.size(), rows.size());
        for (std::size_t ring = 0; ring < rings; ++ring) {
            const double gap = std::min(ring < columns.size() ? columns[ring].gap : HUGE_VAL,
                                        ring < rows.size() ? rows[ring].gap : HUGE_VAL);
            if (grid_.top() - from.heights.low <= slope * gap) break;
            for (std::size_t k = 0; k <= ring; ++k) {
                if (ring < columns.size() && k < rows.size())
                    visit(i, j, columns[ring], rows[k], slope);
                if (k < ring && k < columns.size() && ring < rows.size())
                    visit(i, j, columns[k], rows[ring], slope);
            }
        }
        return slope;
    }

  private:
    const Cell& cell(int i, int j) const {
        return cells_[static_cast<std::size_t>(grid_.row(j)) *
                          static_cast<std::size_t>(grid_.width()) +
                      static_cast<std::size_t>(grid_.column(i))];
    }
    std::size_t block_index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_x_) +
               static_cast<std::size_t>(x);
    }

    Cell make_cell(int i, int j) const {
        Cell made;
        made.corners = grid_.corners(i, j);
        const auto& h = made.corners;
        const auto [low, high] = std::minmax_element(h.begin(), h.end());
        made.heights = {*low, *high};
        made.slope_x = range_of((h[1] - h[0]) * grid_.width(), (h[3] - h[2]) * grid_.width());
        made.slope_y = range_of((h[2] - h[0]) * grid_.height(), (h[3] - h[1]) * grid_.height());
        made.centre = (h[0] + h[1] + h[2] + h[3]) / 4;
        made.gradient_x = (h[1] - h[0] + h[3] - h[2]) / 2;
        made.gradient_y = (h[2] - h[0] + h[3] - h[1]) / 2;
        made.twist = std::abs(h[0] - h[1] - h[2] + h[3]);
        return made;
    }

    // Points of the cell itself and of the eight around it: the slope between two points is a mean
    // of the surface's slopes along the way.
    double near_slope(int i, int j) const {
        double slope = 0;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                if (kind_ == ConeKind::Empty)
                    slope = std::max(slope, climb(cell(i + dx, j + dy), dx, dy));
                else if (cell(i + dx, j + dy).heights.high > cell(i, j).heights.low)
                    slope = std::max(slope, relaxed_near_slope(i, j, dx, dy));
            }
        return slope;
    }

    // Where the surface falls at the far end, it gained no more on the way there than its gradient
    // changed.
    double relaxed_near_slope(int i, int j, int dx, int dy) const {
        const Cell& end = cell(i + dx, j + dy);
        if (dx == 0 && dy == 0) {
            // Along a segment of a patch, of extent (x, y) in texels, height has the second
            // difference 2 twist x y: the gain is at most |twist| x y, and the length at least
            // sqrt(2 x y / (width height)).
            const double area = static_cast<double>(grid_.width()) * grid_.height();
            return std::min(climb(end, 0, 0), end.twist * std::sqrt(area / 2));
        }
        Range path_x = end.slope_x, path_y = end.slope_y;
        double steepest = climb(end, dx, dy);
        for (const auto& [x, y] : {std::pair{0, 0}, std::pair{dx, 0}, std::pair{0, dy}}) {
            const Cell& between = cell(i + x, j + y);
            path_x = joined(path_x, between.slope_x);
            path_y = joined(path_y, between.slope_y);
            steepest = std::max(steepest, climb(between, dx, dy));
        }
        const double change =
            std::hypot(farthest(path_x, end.slope_x), farthest(path_y, end.slope_y));
        return std::min(steepest, change);
    }

    void visit(int i, int j, const Span& columns, const Span& rows, double& slope) const {
        const Cell& from = cell(i, j);
        const double gain = tops_[block_index(columns.block, rows.block)] - from.heights.low;
        if (gain <= slope * std::hypot(columns.gap, rows.gap)) return;
        // A span lies in one block, so it does not wrap.
        const Cell* first = &cell(i + columns.first, j + rows.first);
        for (int dy = rows.first; dy < rows.first + rows.count; ++dy, first += grid_.width())
            for (int dx = columns.first; dx < columns.first + columns.count; ++dx) {
                if (std::abs(dx) <= 1 && std::abs(dy) <= 1) continue;
                const Cell& to = first[dx - columns.first];
                const double rise = to.heights.high - from.heights.low;
                if (rise <= 0) continue;
                const double distance =
                    std::hypot(gap_to(dx, 1) / grid_.width(), gap_to(dy, 1) / grid_.height());
                if (rise <= slope * distance) continue;
                double bound = rise / distance;
                if (kind_ == ConeKind::Relaxed) {
                    bound = std::min(bound, falling_rise(from, to, dx, dy) / distance);
                    if (bound <= slope) continue;
                }
                bound = std::min(bound, corner_slope(from, to, dx, dy, slope));
                slope = std::max(slope, bound);
            }
    }

    // The steepest of the 16 slopes between corners, seen along the direction between the cells;
    // `enough` if none is steeper.
    double corner_slope(const Cell& from, const Cell& to, int dx, int dy, double enough) const {
        const double nx = static_cast<double>(dx) / grid_.width(),
                     ny = static_cast<double>(dy) / grid_.height();
        const double length = std::hypot(nx, ny);
        const double step_x = nx / length / grid_.width(), step_y = ny / length / grid_.height();
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = 0; k < 4; ++k) {
            const double along = (k & 1) * step_x + (k >> 1) * step_y;
            const auto at = static_cast<std::size_t>(k);
            low = std::min(low, from.corners[at] - enough * along);
            high = std::max(high, to.corners[at] - enough * (length + along));
        }
        if (high <= low) return enough;
        double steepest = enough;
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b) {
                const double along =
                    length + ((b & 1) - (a & 1)) * step_x + ((b >> 1) - (a >> 1)) * step_y;
                steepest = std::max(steepest, (to.corners[static_cast<std::size_t>(b)] -
                                               from.corners[static_cast<std::size_t>(a)]) /
                                                  along);
            }
        return steepest;
    }

    // A bound of the rise to those points of `to` where the surface falls in the direction d from
    // `from`.  There g.d <= e |d|, with g the gradient at the cell's centre and e what it varies
    // by, so the rise is at most rise - g.d + e |d|: what the tangent plane at the far end,
    // followed back, is above the near end.  On a plane that is nothing.
    static double falling_rise(const Cell& from, const Cell& to, int dx, int dy) {
        const double gx = to.gradient_x, gy = to.gradient_y;
        const double slack = to.twist / 2 * (std::abs(dx) + std::abs(dy) + 2);
        const double least_climb = gx * dx + gy * dy - std::abs(gx) - std::abs(gy);
        if (least_climb > slack) return 0;
        // The tangent plane over the corner (0, 0) of `from`, then over each of its corners.
        const double plane = to.centre - gx * (dx + 0.5) - gy * (dy + 0.5);
        const auto& h = from.corners;
        const double above = std::max(std::max(plane - h[0], plane + gx - h[1]),
                                      std::max(plane + gy - h[2], plane + gx + gy - h[3]));
        return std::max(0.0, above + to.twist / 4 + slack);
    }

    const Grid& grid_;
    ConeKind kind_;
    std::vector<Cell> cells_;
    int side_ = 8, blocks_x_ = 0;
    std::vector<double> tops_;                       // of blocks
    std::vector<std::vector<Span>> columns_, rows_;  // what each column and row of cells sees
};

}  // namespace

Result<Image> bake_cone(const Image& heights, ConeKind kind, const Work& work) {
    if (Status sound = check_image(heights); !sound) return sound.error();
    const Grid grid(heights);
    const ConeBake bake(grid, kind);
    const int width = grid.width(), height = grid.height();
    std::vector<double> slopes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto slope = [&](int i, int j) -> double& {
        return slopes[static_cast<std::size_t>(grid.row(j)) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(grid.column(i))];
    };
    const auto fill_row = [&](int j) {
        for (int i = 0; i < width; ++i) slope(i, j) = bake.slope_of(i, j);
    };
    for_each_row(height, fill_row, work);
    Image cones = blank_image(width, height, 2, heights.bits);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double steepest = std::max(std::max(slope(x, y), slope(x - 1, y)),
                                             std::max(slope(x, y - 1), slope(x - 1, y - 1)));
            // Less by far more than the bounds were rounded by.
            const double root = std::sqrt(1 / steepest) * (1 - 1e-9);
            cones.at(x, y, 0) = heights.at(x, y);
            cones.at(x, y, 1) = rounded_down(steepest <= 1 / widest_cone ? 1 : root, heights.bits);
        }
    return cones;
}

}  // namespace intaglio::maps

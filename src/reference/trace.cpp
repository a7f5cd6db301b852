// The walk along the view ray and the walk along the light.  A cell whose highest corner is below
// the ray's lowest point in it costs one comparison; only the others are solved.
#include "src/reference/trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/reference/patch.h"
#include "src/reference/quadratic.h"
#include "src/reference/walk.h"

namespace intaglio::reference {

namespace {

// A straight line over the map, in texel coordinates, whose height changes by `rise` (1 or -1) per
// unit of t.
struct Path {
    double x, y;
    double step_x, step_y;
    double height, rise;

    double height_at(double t) const { return height + rise * t; }
};

struct Slope {
    bool usable;
    Vec2 per_height;  // how far uv moves while the height changes by 1
};

Slope slope_of(const HeightField& field, Vec2 uv, Vec3 direction, double scale) {
    const Slope none{false, {0, 0}};
    if (!is_valid(field) || !std::isfinite(uv.x) || !std::isfinite(uv.y)) return none;
    if (!(direction.z > 0) || !std::isfinite(direction.z)) return none;
    const Vec2 move{direction.x / direction.z * scale, direction.y / direction.z * scale};
    // Written so that NaN and infinity are refused too.
    if (!(std::abs(move.x) * field.width <= max_travel)) return none;
    if (!(std::abs(move.y) * field.height <= max_travel)) return none;
    return {true, move};
}

Path path_over(const HeightField& field, Vec2 uv, Vec2 move, double height, double rise) {
    return {texel_coordinate(uv.x, field.width, field.wrap),
            texel_coordinate(uv.y, field.height, field.wrap),
            move.x * field.width,
            move.y * field.height,
            height,
            rise};
}

// A cell on the path, and the surface's height less the path's between t_in and t_out.
struct Crossing {
    const Path& path;
    const Patch& patch;
    const Axis& x;
    const Axis& y;
    double t_in, t_out;

    Quadratic gap(double raised_by) const {
        const double x_in = x.fraction(t_in), y_in = y.fraction(t_in);
        const double x_out = x.fraction(t_out), y_out = y.fraction(t_out);
        return {patch.at(x_in, y_in) - path.height_at(t_in) + raised_by,
                patch.at(x_out, y_out) - path.height_at(t_out) + raised_by,
                patch.twist() * (x_out - x_in) * (y_out - y_in)};
    }

    // 8-bit weights: calls visit(height, t_in, t_out) for the steps of the staircase from `begin`
    // on, without the steps that the path only touches at a corner.
    template <typename Visit>
    bool walk_steps(double begin, Visit&& visit) const {
        const double first_x = x.cell() * 256, first_y = y.cell() * 256;
        const auto step = [&](const Axis& fine_x, const Axis& fine_y, double a, double b) {
            if (a == b) return false;
            const double weight_x = std::clamp((fine_x.cell() - first_x) / 256, 0.0, 1.0);
            const double weight_y = std::clamp((fine_y.cell() - first_y) / 256, 0.0, 1.0);
            return visit(patch.at(weight_x, weight_y), a, b);
        };
        return walk(x.refined(256, begin), y.refined(256, begin), begin, t_out, step);
    }
};

// Visits the cells under the path whose highest corner reaches `slack` below the path's lowest
// point in them or more.
template <typename Visit>
bool walk_cells(const HeightField& field, const Path& path, double begin, double end, double slack,
                Visit&& visit) {
    const Axis x(path.x, path.step_x, begin), y(path.y, path.step_y, begin);
    TexelPair columns(x.cell(), field.width, field.wrap);
    TexelPair rows(y.cell(), field.height, field.wrap);
    return walk(x, y, begin, end, [&](const Axis& ax, const Axis& ay, double t_in, double t_out) {
        columns.follow(ax.cell());
        rows.follow(ay.cell());
        const Patch patch(field, columns, rows);
        if (patch.top() < path.height_at(path.rise < 0 ? t_out : t_in) + slack) return false;
        return visit(Crossing{path, patch, ax, ay, t_in, t_out});
    });
}

// The first t in the cell at which the surface is at or above the falling path; greater than 1 when
// there is none.
double first_contact(const Crossing& cell) {
    const double s = cell.gap(0).first_nonnegative();
    if (!(s <= 1)) return 2;
    return std::min(cell.t_in + s * (cell.t_out - cell.t_in), cell.t_out);
}

// The same on the staircase.  It lies within weight_error() of the patch, so its steps are walked
// only from where the patch, raised by so much, reaches the path.
double first_contact_on_steps(const Crossing& cell) {
    const double s = cell.gap(cell.patch.weight_error()).first_nonnegative();
    if (!(s <= 1)) return 2;
    double contact = 2;
    const double begin = std::min(cell.t_in + s * (cell.t_out - cell.t_in), cell.t_out);
    cell.walk_steps(begin, [&](double height, double t_in, double t_out) {
        if (!(height >= cell.path.height_at(t_out))) return false;
        contact = std::clamp(cell.path.height - height, t_in, t_out);  // the path falls by 1 per t
        return true;
    });
    return contact;
}

bool is_occluder(const Crossing& cell, double tolerance) {
    return cell.gap(-tolerance).maximum() > 0;
}

bool is_occluder_on_steps(const Crossing& cell, double tolerance) {
    const double s = cell.gap(cell.patch.weight_error() - tolerance).first_nonnegative();
    if (!(s <= 1)) return false;
    const double begin = std::min(cell.t_in + s * (cell.t_out - cell.t_in), cell.t_out);
    return cell.walk_steps(begin, [&](double height, double t_in, double) {
        return height - cell.path.height_at(t_in) > tolerance;
    });
}

}  // namespace

Hit first_hit(const HeightField& field, Vec2 uv, Vec3 view, double scale) {
    const Hit missed{false, 0, uv, 1};
    const Slope slope = slope_of(field, uv, view, scale);
    if (!slope.usable) return missed;
    const Vec2 move{-slope.per_height.x, -slope.per_height.y};
    const bool steps = field.weights == FilterWeights::EightBit;

    double t = 2;
    walk_cells(field, path_over(field, uv, move, 1, -1), 0, 1, 0, [&](const Crossing& cell) {
        t = steps ? first_contact_on_steps(cell) : first_contact(cell);
        return t <= 1;
    });
    if (!(t <= 1)) return missed;
    return {true, t, {uv.x + move.x * t, uv.y + move.y * t}, 1 - t};
}

bool lit(const HeightField& field, Vec2 uv, double height, Vec3 light, double scale,
         double tolerance) {
    constexpr double start_gap =
        1e-6;  // texels: above the rounding of a hit's uv, up to |uv| = 1e5
    const Slope slope = slope_of(field, uv, light, scale);
    if (!slope.usable || !std::isfinite(height) || !(tolerance >= 0)) return false;
    const Path path = path_over(field, uv, slope.per_height, height, 1);
    const double end = 1 - height;
    if (end <= 0) return true;

    const double speed = std::max(std::abs(path.step_x), std::abs(path.step_y));
    const double begin = speed > 0 ? std::min(start_gap / speed, end) : 0;
    const bool steps = field.weights == FilterWeights::EightBit;
    return !walk_cells(field, path, begin, end, tolerance, [&](const Crossing& cell) {
        return steps ? is_occluder_on_steps(cell, tolerance) : is_occluder(cell, tolerance);
    });
}

bool leaves_relief(const HeightField& field, Vec2 uv, Vec3 view, double scale, double t_begin,
                   double t_end, double tolerance) {
    const Slope slope = slope_of(field, uv, view, scale);
    if (!slope.usable || !(t_begin >= 0) || !(t_end <= 1) || !(t_begin < t_end) ||
        !(tolerance >= 0))
        return false;
    const Path path = path_over(field, uv, {-slope.per_height.x, -slope.per_height.y}, 1, -1);
    // Cells that lie wholly below the ray are those it has left: none may be skipped.
    constexpr double no_slack = -std::numeric_limits<double>::infinity();
    return walk_cells(field, path, t_begin, t_end, no_slack,
                      [&](const Crossing& cell) { return cell.gap(tolerance).minimum() < 0; });
}

}  // namespace intaglio::reference

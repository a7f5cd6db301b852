// Grids over (u, v): positions, normals and tangents are the closed forms of each surface, computed
// in double.
#include "src/vulkan/mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace intaglio::vulkan {
namespace {

std::array<float, 3> to_float(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

// The tangent along the circles around the z axis; v grows downwards, hence the handedness.
std::array<float, 4> tangent_around_z(double angle) {
    return {static_cast<float>(-std::sin(angle)), static_cast<float>(std::cos(angle)), 0, -1};
}

// Rows of columns + 1 vertices; the seam is doubled, so that uv runs on to the last repeat.  v
// grows downwards where one sees u grow to the right, or upwards.
struct Grid {
    int columns, rows;
    bool v_upwards = false;
    bool ends_are_points = false;  // the first and the last row
};

std::vector<std::uint32_t> grid_indices(const Grid& grid) {
    std::vector<std::uint32_t> indices;
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (grid.v_upwards) std::swap(b, c);
        indices.insert(indices.end(), {a, b, c});
    };
    const auto at = [&](int column, int row) {
        return static_cast<std::uint32_t>(row * (grid.columns + 1) + column);
    };
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const std::uint32_t left = at(column, row), right = at(column + 1, row);
            const std::uint32_t below = at(column, row + 1), below_right = at(column + 1, row + 1);
            if (!(grid.ends_are_points && row == 0)) triangle(left, below_right, right);
            if (!(grid.ends_are_points && row == grid.rows - 1)) triangle(left, below, below_right);
        }
    }
    return indices;
}

// Equal shares.
std::vector<double> even_lines(int count) {
    std::vector<double> lines;
    for (int i = 0; i <= count; ++i) lines.push_back(static_cast<double>(i) / count);
    return lines;
}

Grid grid_of(const GridLines& lines) {
    return {static_cast<int>(lines.u.size()) - 1, static_cast<int>(lines.v.size()) - 1};
}

std::array<float, 2> repeated(double u, double v, float repeat_u, float repeat_v) {
    return {static_cast<float>(u * repeat_u), static_cast<float>(v * repeat_v)};
}

}  // namespace

Mesh quad() {
    Mesh mesh;
    for (const float y : {0.0f, 1.0f}) {
        for (const float x : {0.0f, 1.0f}) {
            mesh.vertices.push_back({{x, y, 0}, {0, 0, 1}, {1, 0, 0, 1}, {x, y}});
        }
    }
    mesh.indices = {0, 1, 3, 0, 3, 2};
    return mesh;
}

Mesh quad(const GridLines& lines, float repeat_u, float repeat_v) {
    Mesh mesh;
    for (const double v : lines.v)
        for (const double u : lines.u)
            mesh.vertices.push_back(
                {to_float(u, v, 0), {0, 0, 1}, {1, 0, 0, 1}, repeated(u, v, repeat_u, repeat_v)});
    Grid grid = grid_of(lines);
    grid.v_upwards = true;
    mesh.indices = grid_indices(grid);
    return mesh;
}

Mesh sphere(int segments, float repeat_u, float repeat_v) {
    const int columns = std::max(segments, 3);
    const int rows = std::max(columns / 2, 2);
    Mesh mesh = sphere({even_lines(columns), even_lines(rows)}, repeat_u, repeat_v);
    mesh.indices = grid_indices({columns, rows, false, true});
    return mesh;
}

Mesh sphere(const GridLines& lines, float repeat_u, float repeat_v) {
    Mesh mesh;
    for (const double v : lines.v) {
        const double polar = std::numbers::pi * v;
        for (const double u : lines.u) {
            const double angle = 2 * std::numbers::pi * u;
            const std::array<float, 3> out =
                to_float(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                         std::cos(polar));
            mesh.vertices.push_back(
                {out, out, tangent_around_z(angle), repeated(u, v, repeat_u, repeat_v)});
        }
    }
    mesh.indices = grid_indices(grid_of(lines));
    return mesh;
}

Mesh torus(int segments, float major, float minor, float repeat_u, float repeat_v) {
    const std::vector<double> lines = even_lines(std::max(segments, 3));
    return torus({lines, lines}, major, minor, repeat_u, repeat_v);
}

Mesh torus(const GridLines& lines, float major, float minor, float repeat_u, float repeat_v) {
    Mesh mesh;
    for (const double v : lines.v) {
        const double around_tube = -2 * std::numbers::pi * v;
        for (const double u : lines.u) {
            const double angle = 2 * std::numbers::pi * u;
            const double radius = major + minor * std::cos(around_tube);
            mesh.vertices.push_back(
                {to_float(radius * std::cos(angle), radius * std::sin(angle),
                          minor * std::sin(around_tube)),
                 to_float(std::cos(around_tube) * std::cos(angle),
                          std::cos(around_tube) * std::sin(angle), std::sin(around_tube)),
                 tangent_around_z(angle), repeated(u, v, repeat_u, repeat_v)});
        }
    }
    mesh.indices = grid_indices(grid_of(lines));
    return mesh;
}

}  // namespace intaglio::vulkan

// Grids over (u, v): positions, normals and tangents are the closed forms of each surface, computed
// in double.
#include "src/vulkan/mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace intaglio::vulkan {
namespace {

std::array<float, 3> to_float(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

// The tangent along the circles around the z axis; v grows downwards, hence the handedness.
std::array<float, 4> tangent_around_z(double angle) {
    return {static_cast<float>(-std::sin(angle)), static_cast<float>(std::cos(angle)), 0, -1};
}

// Rows of columns + 1 vertices; the seam is doubled, so that uv runs on to the last repeat.
std::vector<std::uint32_t> grid_indices(int columns, int rows, bool first_row_is_a_point,
                                        bool last_row_is_a_point) {
    std::vector<std::uint32_t> indices;
    const auto at = [&](int column, int row) {
        return static_cast<std::uint32_t>(row * (columns + 1) + column);
    };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const std::uint32_t left = at(column, row), right = at(column + 1, row);
            const std::uint32_t below = at(column, row + 1), below_right = at(column + 1, row + 1);
            if (!(first_row_is_a_point && row == 0)) {
                indices.insert(indices.end(), {left, below_right, right});
            }
            if (!(last_row_is_a_point && row == rows - 1)) {
                indices.insert(indices.end(), {left, below, below_right});
            }
        }
    }
    return indices;
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

Mesh sphere(int segments, float repeat_u, float repeat_v) {
    const int columns = std::max(segments, 3);
    const int rows = std::max(columns / 2, 2);
    Mesh mesh;
    for (int row = 0; row <= rows; ++row) {
        const double v = static_cast<double>(row) / rows;
        const double polar = std::numbers::pi * v;
        for (int column = 0; column <= columns; ++column) {
            const double u = static_cast<double>(column) / columns;
            const double angle = 2 * std::numbers::pi * u;
            const std::array<float, 3> out =
                to_float(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                         std::cos(polar));
            mesh.vertices.push_back(
                {out,
                 out,
                 tangent_around_z(angle),
                 {static_cast<float>(u * repeat_u), static_cast<float>(v * repeat_v)}});
        }
    }
    mesh.indices = grid_indices(columns, rows, true, true);
    return mesh;
}

Mesh torus(int segments, float major, float minor, float repeat_u, float repeat_v) {
    const int count = std::max(segments, 3);
    Mesh mesh;
    for (int row = 0; row <= count; ++row) {
        const double v = static_cast<double>(row) / count;
        const double around_tube = -2 * std::numbers::pi * v;
        for (int column = 0; column <= count; ++column) {
            const double u = static_cast<double>(column) / count;
            const double angle = 2 * std::numbers::pi * u;
            const double radius = major + minor * std::cos(around_tube);
            mesh.vertices.push_back(
                {to_float(radius * std::cos(angle), radius * std::sin(angle),
                          minor * std::sin(around_tube)),
                 to_float(std::cos(around_tube) * std::cos(angle),
                          std::cos(around_tube) * std::sin(angle), std::sin(around_tube)),
                 tangent_around_z(angle),
                 {static_cast<float>(u * repeat_u), static_cast<float>(v * repeat_v)}});
        }
    }
    mesh.indices = grid_indices(count, count, false, false);
    return mesh;
}

}  // namespace intaglio::vulkan

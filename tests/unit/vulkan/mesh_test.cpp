// Properties of every mesh: unit orthogonal frames, triangles turned outwards, and tangents that
// agree with what the triangles' positions and texture coordinates say by finite differences.
#include "src/vulkan/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace intaglio::vulkan {
namespace {

using Vector = std::array<double, 3>;

template <typename Array>
Vector xyz(const Array& a) {
    return {a[0], a[1], a[2]};
}
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector plus(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector times(const Vector& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vector& a) { return std::sqrt(dot(a, a)); }
double cosine(const Vector& a, const Vector& b) { return dot(a, b) / (length(a) * length(b)); }

struct Case {
    std::string name;
    Mesh mesh;
    // Vertices whose u is free (poles): triangles with one of them say nothing about the tangent
    // there.
    bool has_poles = false;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class EveryMesh : public testing::TestWithParam<Case> {};

TEST_P(EveryMesh, FramesAreOrthonormal) {
    for (const Vertex& v : GetParam().mesh.vertices) {
        // Each is rounded to float once: 3 components of half an ulp.
        EXPECT_NEAR(length(xyz(v.normal)), 1, 2e-7);
        EXPECT_NEAR(length(xyz(v.tangent)), 1, 2e-7);
        EXPECT_NEAR(dot(xyz(v.normal), xyz(v.tangent)), 0, 2e-7);
        EXPECT_EQ(std::abs(v.tangent[3]), 1);
    }
}

TEST_P(EveryMesh, TrianglesAreCounterClockwiseFromOutside) {
    const Mesh& mesh = GetParam().mesh;
    ASSERT_EQ(mesh.indices.size() % 3, 0u);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vertex& a = mesh.vertices.at(mesh.indices[i]);
        const Vertex& b = mesh.vertices.at(mesh.indices[i + 1]);
        const Vertex& c = mesh.vertices.at(mesh.indices[i + 2]);
        const Vector face =
            cross(minus(xyz(b.position), xyz(a.position)), minus(xyz(c.position), xyz(a.position)));
        ASSERT_GT(length(face), 0) << "triangle " << i / 3 << " has no area";
        const Vector normal = plus(plus(xyz(a.normal), xyz(b.normal)), xyz(c.normal));
        // A facet of 1/64 of a turn is tilted by at most a few degrees against its corners.
        EXPECT_GT(cosine(face, normal), 0.98) << "triangle " << i / 3;
    }
}

TEST_P(EveryMesh, FrameFollowsTheTextureCoordinates) {
    const Mesh& mesh = GetParam().mesh;
    int checked = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vertex* corner[3];
        bool at_pole = false;
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = &mesh.vertices.at(mesh.indices[i + k]);
            at_pole |= GetParam().has_poles && std::abs(corner[k]->position[2]) > 0.95f;
        }
        if (at_pole) continue;
        const Vector p = minus(xyz(corner[1]->position), xyz(corner[0]->position));
        const Vector q = minus(xyz(corner[2]->position), xyz(corner[0]->position));
        const double pu = corner[1]->uv[0] - corner[0]->uv[0],
                     pv = corner[1]->uv[1] - corner[0]->uv[1];
        const double qu = corner[2]->uv[0] - corner[0]->uv[0],
                     qv = corner[2]->uv[1] - corner[0]->uv[1];
        const double area = pu * qv - qu * pv;
        ASSERT_NE(area, 0);
        const Vector along_u = times(minus(times(p, qv), times(q, pv)), 1 / area);
        const Vector along_v = times(minus(times(q, pu), times(p, qu)), 1 / area);
        for (const Vertex* v : corner) {
            const Vector bitangent = times(cross(xyz(v->normal), xyz(v->tangent)), v->tangent[3]);
            // Within a few degrees: a finite difference over 1/64 of a turn.
            EXPECT_GT(cosine(along_u, xyz(v->tangent)), 0.97) << "triangle " << i / 3;
            EXPECT_GT(cosine(along_v, bitangent), 0.97) << "triangle " << i / 3;
            ++checked;
        }
    }
    EXPECT_GT(checked, 0);
}

// Uneven, and close enough for facets of a few degrees.
GridLines uneven_lines(double first, double last) {
    GridLines lines;
    for (int i = 0; i <= 90; ++i) {
        const double share = i / 90.0;
        lines.u.push_back(share * (0.6 + 0.4 * share));
        lines.v.push_back(first + (last - first) * share);
    }
    return lines;
}

INSTANTIATE_TEST_SUITE_P(Mesh, EveryMesh,
                         testing::Values(Case{"quad", quad()}, Case{"sphere", sphere(64), true},
                                         Case{"quad_grid", quad(uneven_lines(-0.5, 2), 3, 2)},
                                         Case{"torus_grid", torus(uneven_lines(0, 1))},
                                         Case{"sphere_belt", sphere(uneven_lines(0.1, 0.9)), true},
                                         Case{"sphere_repeated", sphere(64, 4, 2), true},
                                         Case{"torus", torus(64)},
                                         Case{"thin_torus", torus(64, 2, 0.1f, 16, 3)}),
                         [](const auto& param) { return param.param.name; });

TEST(Mesh, TextureCoordinatesReachTheRepeats) {
    const auto largest = [](const Mesh& mesh, std::size_t axis) {
        float value = 0;
        for (const Vertex& v : mesh.vertices) value = std::max(value, v.uv[axis]);
        return value;
    };
    EXPECT_EQ(largest(sphere(8, 4, 2), 0), 4);
    EXPECT_EQ(largest(sphere(8, 4, 2), 1), 2);
    EXPECT_EQ(largest(torus(8, 1, 0.5f, 6, 3), 0), 6);
    EXPECT_EQ(largest(torus(8, 1, 0.5f, 6, 3), 1), 3);
}

// Over even lines the same, but for the triangles of a pole, which have no area until they move.
TEST(Mesh, GridsAreTheMeshesOfTheirLines) {
    const GridLines lines = {{0, 0.25, 0.5, 0.75, 1}, {0, 0.5, 1}};
    const Mesh grid = sphere(lines, 4, 2), smooth = sphere(4, 4, 2);
    EXPECT_EQ(grid.indices.size(), smooth.indices.size() + 2 * 4 * 3);
    ASSERT_EQ(grid.vertices.size(), smooth.vertices.size());
    for (std::size_t i = 0; i < grid.vertices.size(); ++i) {
        EXPECT_EQ(grid.vertices[i].position, smooth.vertices[i].position);
        EXPECT_EQ(grid.vertices[i].uv, smooth.vertices[i].uv);
    }
    EXPECT_EQ(quad({{0, 1}, {0, 1}}).vertices[3].uv, quad().vertices[3].uv);
    EXPECT_EQ(quad({{0, 1}, {0, 1}}, 3, 2).vertices[3].uv, (std::array<float, 2>{3, 2}));
}

TEST(Mesh, VerticesLieOnTheSurface) {
    for (const Vertex& v : sphere(12).vertices) EXPECT_NEAR(length(xyz(v.position)), 1, 2e-7);
    for (const Vertex& v : torus(12, 2, 0.5f).vertices) {
        const double from_axis = std::hypot(v.position[0], v.position[1]);
        EXPECT_NEAR(std::hypot(from_axis - 2, v.position[2]), 0.5, 5e-7);
    }
}

TEST(Mesh, TooFewSegmentsBecomeThree) {
    EXPECT_EQ(torus(0).indices, torus(3).indices);
    EXPECT_EQ(sphere(-5).indices, sphere(3).indices);
}

}  // namespace
}  // namespace intaglio::vulkan

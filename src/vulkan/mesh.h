// Meshes to put a relief on: the unit quad, a sphere and a torus, each with a tangent frame that
// follows its texture coordinates.  A frame is (tangent.xyz, bitangent, normal) with bitangent =
// tangent.w * cross(normal, tangent.xyz): the tangent points along growing u, the bitangent along
// growing v, the normal out of the surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace intaglio::vulkan {

struct Vertex {
    std::array<float, 3> position{};
    std::array<float, 3> normal{};   // unit
    std::array<float, 4> tangent{};  // unit, orthogonal to the normal; w is the handedness, 1 or -1
    std::array<float, 2> uv{};
};

// A list of triangles.  In the meshes below each is counter-clockwise seen from the normal's side.
struct Mesh {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;  // three to a triangle
};

// Where the lines of a grid run over a surface: ascending, as shares of its whole extent along u
// and v, the first 0 and the last 1.  A quad's may begin before and end after: it then goes on.
struct GridLines {
    std::vector<double> u, v;
};

// The unit square in the plane z = 0 with uv = (x, y), normal +z and tangent +x.
Mesh quad();
// The same in a grid, uv = (repeat_u x, repeat_v y).
Mesh quad(const GridLines& lines, float repeat_u = 1, float repeat_v = 1);

// The unit sphere about the origin, its poles on the z axis, in `segments` slices (at least 3) and
// half as many stacks. Seen from outside with z up, u grows to the right and v grows downwards, so
// that row 0 of a map is at the top; over the whole sphere they reach repeat_u and repeat_v.
Mesh sphere(int segments, float repeat_u = 1, float repeat_v = 1);
// The same over given lines.  The triangles between vertices of a pole, which have no area, stay:
// moving the vertices gives them some.
Mesh sphere(const GridLines& lines, float repeat_u = 1, float repeat_v = 1);

// The torus about the z axis: a tube of radius `minor` around a circle of radius `major` (larger
// than `minor`), in `segments` slices around the axis (at least 3) and as many around the tube.  u
// runs around the axis up to repeat_u; v runs around the tube up to repeat_v, downwards on the
// outside.
Mesh torus(int segments, float major = 1, float minor = 0.4f, float repeat_u = 1,
           float repeat_v = 1);
Mesh torus(const GridLines& lines, float major = 1, float minor = 0.4f, float repeat_u = 1,
           float repeat_v = 1);

}  // namespace intaglio::vulkan

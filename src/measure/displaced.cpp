// Vertices moved to their heights, and the cameras that look at them.
#include "src/measure/displaced.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "src/measure/shells.h"

namespace intaglio::measure {
namespace {

using namespace dsl;

// The mesh is where the relief is.
class OnDisplaced : public Search {
  public:
    Hit find(const Relief& relief, const Ray& ray) const override {
        return {ray.uv, let("map_height", relief.height(ray.uv)), bool1(true)};
    }
};

}  // namespace

dsl::Catalogue with_geometry(const dsl::Catalogue& catalogue) {
    dsl::Catalogue extended = catalogue;
    extended.searches.push_back(entry<Search, OnDisplaced>(
        "displaced", "Geometry that is displaced itself: the coordinate stays where it is", ""));
    add_shells(extended);
    return extended;
}

Result<std::vector<double>> texel_lines(double first, double last, int texels, double repeat,
                                        int subdivisions) {
    constexpr double most_lines = 1 << 22;
    const double per_unit = texels * repeat;
    if (subdivisions < 1 || subdivisions > 64 || !(first < last) || !(per_unit > 0) ||
        !((last - first) * per_unit * subdivisions < most_lines))
        return input_error(
            "grid-size",
            fmt::format("{} subdivisions of {} texels, {} times in a unit, from {:.3g} to {:.3g} "
                        "make no grid: 1 to 64 subdivisions, at most {} lines",
                        subdivisions, texels, repeat, first, last, most_lines));
    // Centre of texel i at (i + 0.5) / per_unit; lines are numbered from texel 0's centre on.
    std::vector<double> lines = {first};
    const double steps = per_unit * subdivisions;
    const double least = 1e-9 / steps;  // no second line where an end is a line itself
    for (double i = std::ceil(first * steps - 0.5 * subdivisions);; ++i) {
        const double line = (i + 0.5 * subdivisions) / steps;
        if (line > last - least) break;
        if (line > first + least) lines.push_back(line);
    }
    lines.push_back(last);
    return lines;
}

Status check_mesh_size(std::size_t vertices) {
    constexpr std::size_t most_vertices = std::size_t{1} << 23;
    if (vertices > most_vertices)
        return input_error("mesh-size",
                           fmt::format("geometry of {} vertices, and at most {}: use a smaller "
                                       "map, fewer repetitions, subdivisions or layers",
                                       vertices, most_vertices));
    return Done{};
}

Result<vulkan::Mesh> displace(vulkan::Mesh mesh, const reference::HeightField& field,
                              double depth) {
    if (Status status = check_mesh_size(mesh.vertices.size()); !status) return status.error();
    for (vulkan::Vertex& vertex : mesh.vertices) {
        const double height = reference::height_at(field, {vertex.uv[0], vertex.uv[1]});
        for (std::size_t i = 0; i < 3; ++i)
            vertex.position[i] = static_cast<float>(
                vertex.position[i] - static_cast<double>(vertex.normal[i]) * (1 - height) * depth);
    }
    return mesh;
}

Result<vulkan::Camera> parallel_camera(Direction view, double depth) {
    const std::array<float, 3> v = vector_of(view);
    if (!(v[2] > 0))
        return input_error("view-below",
                           fmt::format("parallel rays at an elevation of {} degrees do not come "
                                       "from above",
                                       view.elevation));
    // A point below the plane is seen where its ray to the eye leaves it.
    const float x = v[0] / v[2], y = v[1] / v[2];
    // Depth from 0.01 at the plane to 0.99 at the floor.
    const float z = static_cast<float>(-0.98 / std::max(depth, 1e-6));
    vulkan::Camera camera;
    camera.view_projection = {2, 0, -2 * x, -1, 0, 2, -2 * y, -1, 0, 0, z, 0.01f, 0, 0, 0, 1};
    camera.eye = {v[0] * 1e6f, v[1] * 1e6f, v[2] * 1e6f};
    return camera;
}

Result<vulkan::Program> prepare_parallel(const vulkan::Device& device,
                                         const check::Program& shaders, const Textures& textures,
                                         double scale, int width, int height,
                                         const vulkan::Mesh& mesh, Direction view, Direction light,
                                         const PassLink& link, const Look& look) {
    const Result<vulkan::Camera> camera = parallel_camera(view, scale);
    if (!camera) return camera.error();
    Result<vulkan::Program> program = prepare_mesh(device, shaders, textures, scale, width, height,
                                                   {mesh, *camera, vector_of(light)}, look, link);
    if (!program) return program;
    if (Status status = aim(*program, view, light); !status) return status.error();
    return program;
}

double reach_of(Direction view, double scale) {
    const std::array<float, 3> v = vector_of(view);
    return std::max(std::abs(v[0]), std::abs(v[1])) / static_cast<double>(v[2]) * scale;
}

Result<vulkan::Mesh> displaced_map(const reference::HeightField& field, double scale,
                                   int subdivisions, double margin) {
    const Result<std::vector<double>> u =
        texel_lines(-margin, 1 + margin, field.width, 1, subdivisions);
    if (!u) return u.error();
    const Result<std::vector<double>> v =
        texel_lines(-margin, 1 + margin, field.height, 1, subdivisions);
    if (!v) return v.error();
    if (Status status = check_mesh_size(u->size() * v->size()); !status) return status.error();
    return displace(vulkan::quad({*u, *v}), field, scale);
}

}  // namespace intaglio::measure

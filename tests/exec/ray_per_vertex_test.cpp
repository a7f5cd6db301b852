// The ray's reach interpolated from the vertices: on a flat polygon V before normalisation has the
// same z everywhere, so that V.xy / V.z is affine and interpolation gives what each pixel computes;
// on a round mesh it bends.
#include <algorithm>
#include <cmath>

#include "src/vulkan/camera.h"
#include "src/vulkan/mesh.h"
#include "tests/exec/bench.h"

namespace intaglio::exec {
namespace {

// How far the displaced coordinates of the two lie apart, sorted, over the pixels that both cover.
std::vector<double> distances(const vulkan::Mesh& mesh, vulkan::Point target, float distance) {
    const measure::Textures textures(map_named("smooth"), measure::Filtering::Float);
    std::vector<vulkan::Picture> pictures;
    for (const char* per_vertex : {"0", "1"}) {
        const Variant variant = must(make_variant(
            templates::all_techniques(), request("parallax_occlusion,output=displaced", "glsl_450",
                                                 {{"ray_per_vertex", per_vertex}})));
        const vulkan::Point eye = {target[0] + 0.4f * distance, target[1] - 0.7f * distance,
                                   target[2] + 0.5f * distance};
        measure::MeshView view{
            mesh, must(vulkan::look_at(eye, target, {0, 0, 1}, vulkan::Perspective{})), {0, 0, 1}};
        vulkan::Program program = must(measure::prepare_mesh(device(), must(link_variant(variant)),
                                                             textures, test_scale, 64, 64, view));
        pictures.push_back(must(program.draw())[0]);
    }
    std::vector<double> result;
    for (std::size_t i = 0; i < pictures[0].pixels.size(); ++i) {
        const auto &a = pictures[0].pixels[i], &b = pictures[1].pixels[i];
        if (a[3] != 0) result.push_back(std::hypot(a[0] - b[0], a[1] - b[1]));
    }
    std::sort(result.begin(), result.end());
    return result;
}

TEST(RayPerVertex, IsExactOnAFlatPolygonInPerspective) {
    const std::vector<double> apart = distances(vulkan::quad(), {0.5f, 0.5f, 0}, 1.5f);
    ASSERT_GT(apart.size(), 500u);
    // Rounding alone: coordinates below 2, interpolated in perspective, and a ray within 7 times
    // the scale.  A tap that lies on the profile to the bit may go to either side of it.
    EXPECT_LT(apart[apart.size() * 99 / 100], 2e-5);
}

TEST(RayPerVertex, BendsOnARoundMesh) {
    const std::vector<double> apart = distances(vulkan::sphere(16, 4, 2), {0, 0, 0}, 3.0f);
    ASSERT_GT(apart.size(), 500u);
    EXPECT_GT(apart[apart.size() / 2], 1e-4);
}

}  // namespace
}  // namespace intaglio::exec

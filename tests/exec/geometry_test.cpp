// Displaced geometry, drawn by the rasteriser, against the exact reference: two ways to one surface
// that share no arithmetic.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>

#include <fmt/format.h>

#include "tests/exec/geometry.h"

#include "src/measure/shells.h"

namespace intaglio::exec {
namespace {

// Where the rasteriser puts a vertex, lavapipe with its 8 bits of subpixels: at most half of one
// off along each axis.  In texture units; a displaced coordinate is off by no more.
constexpr double snap = std::numbers::sqrt2 / 512 / side;

HeightField raised(HeightField field, double by) {
    for (double& height : field.heights) height += by;
    return field;
}

double corner(const HeightField& field, int x, int y) {
    return field
        .heights[static_cast<std::size_t>(y % field.height * field.width + x % field.width)];
}

// The greatest |h00 - h10 - h01 + h11| and slope per texture unit of a field's patches.
struct Shape {
    double twist = 0, slope = 0;
};
Shape shape_of(const HeightField& field) {
    Shape shape;
    for (int y = 0; y < field.height; ++y)
        for (int x = 0; x < field.width; ++x) {
            const double a = corner(field, x, y), b = corner(field, x + 1, y);
            const double c = corner(field, x, y + 1), d = corner(field, x + 1, y + 1);
            shape.twist = std::max(shape.twist, std::abs(a - b - c + d));
            const double along_u = std::max(std::abs(b - a), std::abs(d - c)) * field.width;
            const double along_v = std::max(std::abs(c - a), std::abs(d - b)) * field.height;
            shape.slope = std::max(shape.slope, std::hypot(along_u, along_v));
        }
    return shape;
}

vulkan::Picture draw_displaced(const measure::MapSet& set, Direction view, int subdivisions) {
    const vulkan::Mesh mesh = must(measure::displaced_map(
        field_of(set), scale, subdivisions, measure::reach_of(view, scale) + 1.0 / side));
    vulkan::Program program = must(measure::prepare_parallel(
        device(), compiled(displaced_request()), measure::Textures(set, measure::Filtering::Float),
        scale, side, side, mesh, view, light));
    return must(program.draw())[0];
}

// Along a ray from `start`: t at which a displaced coordinate lies.
double parameter(reference::Vec2 start, const std::array<float, 4>& pixel, reference::Vec3 view) {
    const double x = view.x / view.z * scale, y = view.y / view.z * scale;
    return ((start.x - pixel[0]) * x + (start.y - pixel[1]) * y) / (x * x + y * y);
}

// How many pixels have a t that is not between the first hits of the surface raised and lowered by
// what the triangles and the rasteriser may be off.  `ray` says where pixel (x, y)'s ray meets the
// polygon, and its direction.
template <typename RayOf>
int count_beyond_bound(const vulkan::Picture& picture, const HeightField& field, int subdivisions,
                       const RayOf& ray) {
    const Shape shape = shape_of(field);
    const double bound =
        shape.twist / (4.0 * subdivisions * subdivisions) + shape.slope * snap + 1e-5;
    const HeightField above = raised(field, bound), below = raised(field, -bound);
    int beyond = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const auto [start, view] = ray(x, y);
            if (!(start.x > 0 && start.x < 1 && start.y > 0 && start.y < 1)) continue;
            const double reach = std::hypot(view.x, view.y) / view.z * scale;
            const double slack = (snap + 1e-6) / reach;
            const double t = parameter(start, picture.at(x, y), view);
            const reference::Hit last = reference::first_hit(below, start, view, scale);
            beyond += t < reference::first_hit(above, start, view, scale).t - slack;
            beyond += t > (last.found ? last.t : 1) + slack;
        }
    return beyond;
}

TEST(DisplacedGeometry, IsWithinTheTessellationBoundOfTheExactHit) {
    for (const char* maker : {"smooth", "cobbles", "bricks", "fur"})
        for (const Direction view : {Direction{60, 20}, Direction{30, 200}, Direction{45, 45}})
            for (const int subdivisions : {1, 4}) {
                const measure::MapSet set = map_named(maker, side, side);
                const vulkan::Picture picture = draw_displaced(set, view, subdivisions);
                const reference::Vec3 v = measure::exact_vector(measure::vector_of(view));
                const auto ray = [&](int x, int y) {
                    return std::pair{reference::Vec2{(x + 0.5) / side, (y + 0.5) / side}, v};
                };
                EXPECT_EQ(count_beyond_bound(picture, field_of(set), subdivisions, ray), 0)
                    << maker << " at " << view.elevation << ", " << subdivisions;
            }
}

TEST(DisplacedGeometry, TheBoundTellsOneSurfaceFromAnother) {
    const measure::MapSet set = map_named("smooth", side, side);
    const Direction view = {45, 20};
    const reference::Vec3 v = measure::exact_vector(measure::vector_of(view));
    HeightField lower = field_of(set);
    for (double& height : lower.heights) height *= 0.95;
    const auto ray = [&](int x, int y) {
        return std::pair{reference::Vec2{(x + 0.5) / side, (y + 0.5) / side}, v};
    };
    EXPECT_GT(count_beyond_bound(draw_displaced(set, view, 4), lower, 4, ray), side * side / 2);
}

TEST(DisplacedGeometry, RefusesWhatItCannotDraw) {
    const auto code = [](const auto& result) {
        return result ? std::string("drawn") : result.error().code;
    };
    EXPECT_EQ(code(measure::texel_lines(0, 1, 64, 1, 0)), "grid-size");
    EXPECT_EQ(code(measure::texel_lines(0, 1, 16384, 1e6, 1)), "grid-size");
    EXPECT_EQ(code(measure::parallel_camera({0, 20}, scale)), "view-below");
    EXPECT_EQ(code(measure::parallel_camera({90, 0}, 0)), "drawn");
    EXPECT_EQ(code(measure::shells_of(vulkan::quad(), 0, scale)), "layers");
    vulkan::Mesh large;
    large.vertices.resize((std::size_t{1} << 23) + 1);
    EXPECT_EQ(code(measure::displace(large, field_of(map_named("flat0", 1, 1)), 1)), "mesh-size");
    EXPECT_EQ(code(measure::shells_of(large, 1, 1)), "mesh-size");
}

TEST(TexelLines, HaveEveryTexelCentreAndTheEnds) {
    for (const auto& [texels, repeat, subdivisions] :
         {std::tuple{8, 1.0, 1}, {8, 1.0, 2}, {5, 3.0, 3}, {7, 2.5, 4}, {1, 1.0, 1}}) {
        const std::vector<double> lines =
            must(measure::texel_lines(0, 1, texels, repeat, subdivisions));
        EXPECT_EQ(lines.front(), 0);
        EXPECT_EQ(lines.back(), 1);
        EXPECT_TRUE(std::is_sorted(lines.begin(), lines.end(), std::less_equal<>()));
        const double per_unit = texels * repeat;
        for (std::size_t i = 1; i < lines.size(); ++i)
            EXPECT_LE(lines[i] - lines[i - 1], 1 / (per_unit * subdivisions) + 1e-12);
        for (int i = 0; i + 0.5 < per_unit; ++i) {
            const double centre = (i + 0.5) / per_unit;
            EXPECT_TRUE(std::any_of(lines.begin(), lines.end(),
                                    [&](double line) { return std::abs(line - centre) < 1e-12; }))
                << texels << " texels, centre " << i;
        }
    }
}

// The ray of a pixel of a perspective camera, as clip space has it: two planes through the eye and
// the pixel, met with z = 0.
std::pair<reference::Vec2, reference::Vec3> pixel_ray(const vulkan::Camera& camera, int x, int y) {
    const double px = (x + 0.5) / side * 2 - 1, py = (y + 0.5) / side * 2 - 1;
    const auto& m = camera.view_projection;
    const double a = m[0] - px * m[12], b = m[1] - px * m[13], c = px * m[15] - m[3];
    const double d = m[4] - py * m[12], e = m[5] - py * m[13], f = py * m[15] - m[7];
    const double determinant = a * e - b * d;
    const reference::Vec2 start = {(c * e - b * f) / determinant, (a * f - c * d) / determinant};
    return {start, {camera.eye[0] - start.x, camera.eye[1] - start.y, camera.eye[2]}};
}

TEST(DisplacedGeometry, AgreesInPerspectiveToo) {
    constexpr int subdivisions = 2;
    const measure::MapSet set = map_named("cobbles", side, side);
    // Near enough for a pixel to span less of the map than the parallel pictures' do, so that the
    // same bound holds.
    const vulkan::Camera camera =
        must(vulkan::look_at({0.6f, -0.05f, 0.7f}, {0.5f, 0.45f, 0}, {0, 0, 1},
                             {.vertical_degrees = 45, .near_plane = 0.05f, .far_plane = 4}));
    const vulkan::Mesh mesh = must(measure::displaced_map(field_of(set), scale, subdivisions, 0.5));
    vulkan::Program program = must(measure::prepare_mesh(
        device(), compiled(displaced_request()), measure::Textures(set, measure::Filtering::Float),
        scale, side, side, {mesh, camera, measure::vector_of(light)}));
    const vulkan::Picture picture = must(program.draw())[0];
    int inside = 0;
    const auto ray = [&](int x, int y) {
        const auto found = pixel_ray(camera, x, y);
        inside += found.first.x > 0 && found.first.x < 1 && found.first.y > 0 && found.first.y < 1;
        return found;
    };
    EXPECT_EQ(count_beyond_bound(picture, field_of(set), subdivisions, ray), 0);
    EXPECT_GT(inside, side * side / 2) << "the camera looks at the map";
}

TEST(DisplacedGeometry, ConvergesWithTheSquareOfTheSubdivisions) {
    const measure::MapSet noise = map_named("noise", side, side);
    const Direction view = {60, 20};
    const double one = mean_error(noise, draw_displaced(noise, view, 1), view);
    const double two = mean_error(noise, draw_displaced(noise, view, 2), view);
    const double four = mean_error(noise, draw_displaced(noise, view, 4), view);
    fmt::print("displaced geometry, mean error in texels: {:.2g} {:.2g} {:.2g}\n", one, two, four);
    // 4 but for the rasteriser's own error, which does not fall.
    EXPECT_LT(two, one / 2.5);
    EXPECT_LT(four, two / 1.5);
}

TEST(DisplacedGeometry, ShadesAsTheExactSearchDoes) {
    const measure::MapSet set = map_named("cobbles", side, side);
    const Direction view = {50, 20};
    // Four pixels to a texel: a search reads colours and normals at the level of the undisplaced
    // coordinate, geometry at that of its own, and here both magnify.
    constexpr int size = 4 * side;
    const std::string looks = ",shadow=exact,shading=phong";
    const vulkan::Mesh mesh = must(measure::displaced_map(
        field_of(set), scale, 4, measure::reach_of(view, scale) + 1.0 / side));
    const measure::Textures textures(set, measure::Filtering::Float);
    vulkan::Program program = must(measure::prepare_parallel(
        device(), compiled(request("search=displaced" + looks, "glsl_450")), textures, scale, size,
        size, mesh, view, light));
    const vulkan::Picture triangles = must(program.draw())[0];
    const auto differing = [&](const std::string& search) {
        const vulkan::Picture searched =
            draw(request("search=" + search + looks, "glsl_450"), set, view, light, size)[0];
        int count = 0;
        for (std::size_t i = 0; i < searched.pixels.size(); ++i)
            count += std::abs(triangles.pixels[i][1] - searched.pixels[i][1]) > 0.02f;
        return count;
    };
    // Left are edges, where a pixel sees the one side or the other, and shadows' edges.
    fmt::print("displaced geometry shades otherwise than exact in {}, than none in {} of {}\n",
               differing("exact"), differing("none"), size * size);
    EXPECT_LT(differing("exact"), size * size / 100);
    EXPECT_GT(differing("none"), size * size / 4);
}

// The exact surface around a sphere, marched finely by the plain definition.
struct Bumpy {
    HeightField field;
    float repeat_u, repeat_v;
    double depth;

    // > 0 outside.
    double above(const std::array<double, 3>& p) const {
        const double r = std::hypot(p[0], p[1], p[2]);
        double turn = std::atan2(p[1], p[0]) / (2 * std::numbers::pi);
        if (turn < 0) turn += 1;
        const double polar = std::acos(std::clamp(p[2] / r, -1.0, 1.0)) / std::numbers::pi;
        const double height = reference::height_at(field, {turn * repeat_u, polar * repeat_v});
        return r - (1 - (1 - height) * depth);
    }
};

TEST(DisplacedGeometry, SilhouettesOfASphereAreWhereTheGeometryIs) {
    constexpr int subdivisions = 2;
    constexpr float repeat_u = 4, repeat_v = 2;
    const measure::MapSet set = map_named("cobbles", 32, 32);
    const Bumpy bumpy{field_of(set), repeat_u, repeat_v, 0.2};
    const vulkan::GridLines lines = {must(measure::texel_lines(0, 1, 32, repeat_u, subdivisions)),
                                     must(measure::texel_lines(0, 1, 32, repeat_v, subdivisions))};
    const vulkan::Mesh mesh = must(
        measure::displace(vulkan::sphere(lines, repeat_u, repeat_v), bumpy.field, bumpy.depth));
    const vulkan::Camera camera =
        must(vulkan::look_at({0, -4, 1}, {0, 0, 0}, {0, 0, 1}, {.vertical_degrees = 32}));
    vulkan::Program program = must(measure::prepare_mesh(
        device(), compiled(displaced_request()), measure::Textures(set, measure::Filtering::Float),
        scale, side, side, {mesh, camera, measure::vector_of(light)}));
    const vulkan::Picture picture = must(program.draw())[0];

    int wrong = 0, rim = 0, undecided = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto [start, to_eye] = pixel_ray(camera, x, y);
            const std::array<double, 3> eye = {camera.eye[0], camera.eye[1], camera.eye[2]};
            const double length = std::hypot(to_eye.x, to_eye.y, to_eye.z);
            double least = 1e9, radius = 1e9;
            for (int i = 0; i <= 2000; ++i) {  // distances 3 to 5.2 from the eye: all of the sphere
                const double away = (3 + i * 1.1e-3) / length * (to_eye.z > 0 ? 1 : -1);
                const std::array<double, 3> p = {eye[0] - to_eye.x * away, eye[1] - to_eye.y * away,
                                                 eye[2] - to_eye.z * away};
                least = std::min(least, bumpy.above(p));
                radius = std::min(radius, std::hypot(p[0], p[1], p[2]));
            }
            // Facets of a 1/128 turn lie up to 3e-4 inside, patches are cut within 1/16 of their
            // twist times the depth, and the march's own steps are 1e-3 long: a band of 0.006.
            if (std::abs(least) < 0.006) {
                ++undecided;
                continue;
            }
            const bool drawn = picture.at(x, y) != measure::mesh_background;
            wrong += drawn != (least < 0);
            rim += !drawn && radius < 0.99;
        }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(rim, side) << "rays that meet the smooth sphere pass the relief: true silhouettes";
    EXPECT_LT(undecided, side * side / 20);
}

}  // namespace
}  // namespace intaglio::exec

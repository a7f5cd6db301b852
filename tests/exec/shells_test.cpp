// Shells, drawn by the rasteriser, against the march and the exact reference.
#include <cmath>

#include <fmt/format.h>

#include "tests/exec/geometry.h"

#include "src/measure/shells.h"

namespace intaglio::exec {
namespace {

// Shells of a map, and their overdraw.
struct ShellsDrawn {
    vulkan::Picture picture;
    double overdraw = 0;  // mean fragments per pixel
};
ShellsDrawn draw_shells(const measure::MapSet& set, Direction view, int layers,
                        const std::string& target = "glsl_450") {
    const VariantRequest wanted = request("output=displaced", target);
    // A layer reaches as far beyond the picture's edges as rays travel.
    const double margin = measure::reach_of(view, scale) + 1.0 / side;
    const vulkan::Mesh mesh = must(measure::shells_of(
        vulkan::quad({{-margin, 1 + margin}, {-margin, 1 + margin}}), layers, scale));
    const auto prepared = [&](bool counting) {
        vulkan::Program program = must(measure::prepare_parallel(
            device(), compiled(measure::shells_request(wanted, layers, counting)),
            measure::Textures(set, measure::Filtering::Float), scale, side, side, mesh, view, light,
            measure::shells_link()));
        must(measure::set_shells(program));
        return program;
    };
    vulkan::Program counting = prepared(true);
    ShellsDrawn drawn{must(prepared(false).draw())[0]};
    for (const int fragments : must(measure::count_overdraw(counting, layers)))
        drawn.overdraw += static_cast<double>(fragments) / (side * side);
    return drawn;
}

// The march with as many equal steps, and the reads it takes.
struct Marched {
    vulkan::Picture picture;
    double reads = 0;  // mean per pixel
};
Marched march(const measure::MapSet& set, Direction view, int steps, const std::string& search,
              const Knobs& knobs) {
    VariantRequest wanted = request(search + ",output=displaced", "glsl_450", knobs);
    wanted.count_reads = true;
    const std::vector<vulkan::Picture> pictures =
        draw(wanted, set, view, light, side, measure::Filtering::Float);
    Marched marched{pictures[0]};
    for (const auto& pixel : pictures[1].pixels)
        marched.reads += static_cast<double>(pixel[0]) / (side * side);
    EXPECT_LE(marched.reads, steps + 1);
    return marched;
}
Marched march_steps(const measure::MapSet& set, Direction view, int steps) {
    const std::string count = std::to_string(steps);
    return march(set, view, steps, "steep_parallax", {{"min_steps", count}, {"max_steps", count}});
}

// Pixels that one picture of a mesh covers and the other does not.
int covered_only_by(const vulkan::Picture& one, const vulkan::Picture& other) {
    int count = 0;
    for (std::size_t i = 0; i < one.pixels.size(); ++i)
        count += one.pixels[i] != measure::mesh_background &&
                 other.pixels[i] == measure::mesh_background;
    return count;
}

TEST(Shells, FinsCloseTheirGapsAtSilhouettes) {
    constexpr int layers = 6, size = 4 * side;
    constexpr double depth = 0.2;
    constexpr float repeat_u = 4, repeat_v = 2;
    const measure::MapSet set = map_named("cobbles", 32, 32);
    const measure::Textures textures(set, measure::Filtering::Float);
    const vulkan::Camera camera =
        must(vulkan::look_at({0, -4, 1}, {0, 0, 0}, {0, 0, 1}, {.vertical_degrees = 32}));
    const auto drawn = [&](const VariantRequest& wanted, const vulkan::Mesh& mesh,
                           const measure::PassLink& link) {
        vulkan::Program program =
            must(measure::prepare_mesh(device(), compiled(wanted), textures, scale, size, size,
                                       {mesh, camera, measure::vector_of(light)}, {}, link));
        if (!link.uniforms.empty()) must(measure::set_shells(program));
        return must(program.draw())[0];
    };
    const vulkan::GridLines lines = {must(measure::texel_lines(0, 1, 32, repeat_u, 2)),
                                     must(measure::texel_lines(0, 1, 32, repeat_v, 2))};
    const vulkan::Picture truth = drawn(
        displaced_request(),
        must(measure::displace(vulkan::sphere(lines, repeat_u, repeat_v), field_of(set), depth)),
        {});
    const vulkan::Mesh sphere = vulkan::sphere(96, repeat_u, repeat_v);
    const vulkan::Mesh shells = must(measure::shells_of(sphere, layers, depth));
    const VariantRequest wanted =
        measure::shells_request(request("search=none,output=displaced", "glsl_450"), layers);
    const vulkan::Picture bare = drawn(wanted, shells, measure::shells_link());
    const vulkan::Picture finned =
        drawn(measure::with_fins(wanted), must(measure::add_fins(shells, sphere, depth)),
              measure::shells_link());
    const int gaps = covered_only_by(truth, bare), left = covered_only_by(truth, finned);
    fmt::print("{} shells of a sphere lack {} pixels of its silhouette, with fins {}\n", layers,
               gaps, left);
    EXPECT_GT(gaps, size);
    EXPECT_LT(left, gaps / 2);
    // Fins stand inside the relief: they cover nothing that it does not, but for single pixels of
    // facets that lie outside those of the finer mesh.
    EXPECT_LE(covered_only_by(finned, truth), size / 10);
    EXPECT_EQ(covered_only_by(bare, finned), 0);
}

// Direct3D 9 drops fragments too, by texkill: its layers are those of today's languages.
TEST(Shells, AreTheSameOnDirect3D9) {
    const measure::MapSet set = map_named("fur", side, side);
    const vulkan::Picture modern = draw_shells(set, {40, 20}, 8).picture;
    for (const char* target : {"ps_2_0", "ps_2_a", "ps_2_b", "ps_3_0"}) {
        const vulkan::Picture old = draw_shells(set, {40, 20}, 8, target).picture;
        int other = 0, kept = 0;
        for (std::size_t i = 0; i < old.pixels.size(); ++i) {
            kept += modern.pixels[i][2] > 0;
            for (std::size_t c = 0; c < 3; ++c)
                // Rounding: MojoShader's divisions and roots are not those of the surface's text.
                other += std::abs(modern.pixels[i][c] - old.pixels[i][c]) > 1e-5f;
        }
        EXPECT_GT(kept, side * side / 4);
        EXPECT_LE(other, side) << target
                               << ": a fragment whose height is its layer's may go either way";
    }
}

TEST(Shells, AreTheSamplesOfAMarchInEqualSteps) {
    for (const char* maker : {"fur", "cobbles"})
        for (const int layers : {8, 32}) {
            const measure::MapSet set = map_named(maker, side, side);
            const Direction view = {45, 20};
            const ShellsDrawn shells = draw_shells(set, view, layers);
            const Marched marched = march_steps(set, view, layers);
            int differing = 0;
            for (std::size_t i = 0; i < marched.picture.pixels.size(); ++i) {
                const auto& a = shells.picture.pixels[i];
                const auto& b = marched.picture.pixels[i];
                const float apart = std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1]));
                // Heights by the slope more than coordinates: up to 64 per texture unit.
                differing += apart > 1e-5f || std::abs(a[2] - b[2]) > 1e-3f;
            }
            // Where a sample lies within rounding of the relief either may see it.
            EXPECT_LE(differing, side * side / 500) << maker << ", " << layers;
            EXPECT_EQ(shells.overdraw, layers) << "every layer covers the picture";
        }
}

TEST(Shells, AreOffByAboutALayerWhereTheyAreDense) {
    const measure::MapSet set = map_named("smooth", side, side);
    const Direction view = {45, 20};
    double before = 1e9;
    for (const int layers : {8, 32, 128}) {
        const double error = mean_error(set, draw_shells(set, view, layers).picture, view);
        const double step = measure::reach_of(view, scale) / layers * side;  // texels
        fmt::print("{} shells: mean error {:.3g} texels, a layer's step {:.3g}\n", layers, error,
                   step);
        EXPECT_LT(error, step);
        EXPECT_LT(error, before * 0.4);
        before = error;
    }
}

TEST(Shells, FurByMarchCostsFewerReadsThanShellsFragmentsAtEqualError) {
    const measure::MapSet fur = map_named("fur", side, side);
    for (const double elevation : {60.0, 30.0}) {
        const Direction view = {elevation, 20};
        constexpr int layers = 32;
        const ShellsDrawn shells = draw_shells(fur, view, layers);
        const Marched marched = march_steps(fur, view, layers);
        const double shell_error = mean_error(fur, shells.picture, view);
        const double march_error = mean_error(fur, marched.picture, view);
        fmt::print(
            "fur at {}: {} shells, error {:.3g}, overdraw {:.3g}; march, error {:.3g}, reads "
            "{:.3g}\n",
            elevation, layers, shell_error, shells.overdraw, march_error, marched.reads);
        EXPECT_LE(march_error, shell_error * 1.01);
        EXPECT_LT(marched.reads, shells.overdraw * 0.9) << "the march ends where it hits";
        // And a march may look between its samples, which no layer can.
        const Marched refined = march(fur, view, layers, "relief_secant", {{"linear_steps", "12"}});
        const double refined_error = mean_error(fur, refined.picture, view);
        fmt::print("  12 steps and a secant: error {:.3g}, reads {:.3g}\n", refined_error,
                   refined.reads);
        EXPECT_LT(refined_error, shell_error);
        EXPECT_LT(refined.reads, shells.overdraw * 0.5);
    }
}

}  // namespace
}  // namespace intaglio::exec

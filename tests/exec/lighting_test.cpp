// Shadows, normals, shadings and outputs on the device: the same pixels from every target, no NaN
// in the hard cases, the exact shadow against the exact reference, and pixels that are dropped or
// hidden.
#include "tests/exec/bench.h"

#include <cmath>

#include "generator/target/target.h"
#include "src/measure/hits.h"
#include "src/vulkan/camera.h"
#include "src/vulkan/mesh.h"

namespace intaglio::exec {
namespace {

// Every shadow, normal source and shading that needs no baked map, at least once.
const std::vector<std::string> surfaces = {
    "search=none,shadow=soft,normal=blinn,shading=lambert",
    "parallax_occlusion_chapter,normal=smoothed,shading=phong",
    "steep_parallax,shadow=exact,normal=from_hit,shading=emboss",
    "search=none,shadow=march,normal=from_hit,shading=lambert",
    "search=none,shading=ambient_only,output=depth"};
constexpr measure::Direction light{35, 130};

// Pixels that differ by more than `tolerance` in any component.
int count_apart(const vulkan::Picture& a, const vulkan::Picture& b, float tolerance) {
    int count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        bool apart = false;
        for (std::size_t c = 0; c < 4; ++c)
            apart = apart || !(std::abs(a.pixels[i][c] - b.pixels[i][c]) <= tolerance);
        count += apart;
    }
    return count;
}

TEST(Lighting, EveryTargetDrawsWhatGlsl450Draws) {
    const measure::MapSet bricks = map_named("bricks");
    for (const std::string& surface : surfaces) {
        const vulkan::Picture expected =
            draw(request(surface, "glsl_450"), bricks, {40, 25}, light)[0];
        for (const char* target : {"hlsl_5_0", "hlsl_3_0", "spirv"}) {
            SCOPED_TRACE(surface + " on " + target);
            EXPECT_TRUE(
                same_bits(expected, draw(request(surface, target), bricks, {40, 25}, light)[0]));
        }
        // Without `precise` lavapipe reorders sums of products by a few ulps, which a hard shadow
        // may answer with another pixel.
        for (const char* target : {"glsl_330", "essl_300"}) {
            const vulkan::Picture actual =
                draw(request(surface, target), bricks, {40, 25}, light)[0];
            EXPECT_LE(count_apart(expected, actual, 1e-5f), 8) << surface << " on " << target;
        }
    }
}

TEST(Lighting, SeveralLightsAreTheSameOnEveryTarget) {
    const measure::MapSet bricks = map_named("bricks");
    const std::string surface = "parallax_occlusion,shadow=march";
    vulkan::Picture before = draw(request(surface, "glsl_450"), bricks, {40, 25}, light)[0];
    for (const Knobs& knobs :
         {Knobs{{"lights", "2"}}, Knobs{{"lights", "4"}, {"shadowed_lights", "1"}},
          Knobs{{"lights", "0"}}}) {
        const vulkan::Picture expected =
            draw(request(surface, "glsl_450", knobs), bricks, {40, 25}, light)[0];
        EXPECT_GT(count_apart(expected, before, 1e-3f), 1000) << "another light changes it";
        for (const char* target : {"glsl_330", "hlsl_5_0", "hlsl_3_0", "spirv"}) {
            SCOPED_TRACE(knobs[0].second + " lights on " + target);
            EXPECT_TRUE(same_bits(
                expected, draw(request(surface, target, knobs), bricks, {40, 25}, light)[0]));
        }
        before = expected;
    }
}

TEST(Lighting, NoPixelIsNanOrInfinite) {
    for (const char* maker : {"spikes", "flat0", "flat1"}) {
        const measure::MapSet set = map_named(maker, 32, 32);
        for (const std::string& surface : surfaces) {
            Drawing drawing(request(surface, "glsl_450"), set, 16);
            for (measure::Direction view :
                 {measure::Direction{90, 0}, {45, 45}, {0.1, 33}, {0, 0}, {-20, 10}})
                for (measure::Direction l : {light, measure::Direction{90, 0}, {0, 0}, {-30, 50}})
                    EXPECT_EQ(count_invalid(drawing.at(view, l)[0]), 0)
                        << surface << " on " << maker << ", view " << view.elevation << ", light "
                        << l.elevation;
        }
    }
}

TEST(Lighting, TheExactShadowIsTheReferences) {
    constexpr int size = 128;
    const float scale = static_cast<float>(test_scale);
    // Half a step of a 16-bit map: what the map can hold is seen, what rounding makes is not.
    const Knobs fine = {{"exact_bias", "0.00001"}, {"shadow_cells", "2048"}};
    for (const char* maker : {"bricks", "spikes", "fur"}) {
        const measure::MapSet set = map_named(maker);
        const reference::HeightField field = set.height_field(reference::FilterWeights::Exact);
        for (double elevation : {60.0, 20.0, 5.0}) {
            const measure::Direction view{60, 20}, l{elevation, 130};
            const measure::ExactPicture exact =
                measure::trace_exact(field, view, l, scale, size, size);
            const auto wrong = [&](const char* shadow, const Knobs& knobs) {
                const vulkan::Picture picture =
                    draw(request("search=exact,output=displaced,shadow=" + std::string(shadow),
                                 "glsl_450", knobs),
                         set, view, l, size)[0];
                return measure::summarize(measure::compare_hits(picture, exact, field, view, scale),
                                          size)
                    .shadow_wrong;
            };
            // Grazing rays, which rounding may judge either way: at most one pixel in five hundred.
            EXPECT_LE(wrong("exact", fine), size * size / 500) << maker << " at " << elevation;
            EXPECT_GT(wrong("none", {}), size * size / 20) << "the scene has shadows";
        }
    }
}

TEST(Lighting, WhatLeavesTheTileIsDropped) {
    const measure::MapSet bricks = map_named("bricks");
    const measure::Direction view{25, 30};
    const std::string surface = "parallax_occlusion,output=displaced";
    const vulkan::Picture whole = draw(request(surface, "glsl_450"), bricks, view, light)[0];
    for (const char* target : {"glsl_450", "glsl_330", "hlsl_5_0", "hlsl_3_0", "spirv"}) {
        const vulkan::Picture clipped =
            draw(request(surface, target, {{"clip_tile", "1"}}), bricks, view, light)[0];
        int dropped = 0;
        for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
            const std::array<float, 4>& pixel = whole.pixels[i];
            const bool inside =
                std::min(pixel[0], pixel[1]) >= 0 && std::max(pixel[0], pixel[1]) <= 1;
            const std::array<float, 4> nothing{};
            EXPECT_EQ(clipped.pixels[i], inside ? pixel : nothing) << target << ", pixel " << i;
            dropped += !inside;
        }
        EXPECT_GT(dropped, 100) << target;
        EXPECT_LT(dropped, 2000) << target;
    }
}

// Two squares under each other: the upper one wears the deep half of a map, the lower one, half as
// far down as that is deep, its high half.
vulkan::Mesh two_squares() {
    vulkan::Mesh mesh;
    for (const auto& [z, u] : {std::pair{0.0f, 0.0f}, {-0.04f, 0.5f}}) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}})
            mesh.vertices.push_back(
                {{x, y, z}, {0, 0, 1}, {1, 0, 0, 1}, {u + 0.15f + 0.2f * x, 0.2f * y}});
        for (std::uint32_t i : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(first + i);
    }
    return mesh;
}

TEST(Lighting, DepthIsThatOfTheReliefWhereItIsAskedFor) {
    measure::MapSet set = map_named("flat0", 16, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const bool high = x >= 8;
            set.heights.at(x, y) = high ? 1.0f : 0.0f;
            for (int c = 0; c < 3; ++c) set.colour.at(x, y, c) = high ? 1.0f : 0.0f;
        }
    const measure::Textures textures(set, measure::Filtering::Float);
    const auto brightness = [&](const std::string& output, const char* target) {
        const Variant variant = must(
            make_variant(templates::all_techniques(),
                         request("steep_parallax,shading=ambient_only,output=" + output, target)));
        const measure::MeshView view{two_squares(),
                                     must(vulkan::look_at({0.5f, 0.4f, 2}, {0.5f, 0.5f, 0},
                                                          {0, 1, 0}, vulkan::Perspective{})),
                                     {0, 0, 1}};
        vulkan::Program program = must(measure::prepare_mesh(device(), must(link_variant(variant)),
                                                             textures, test_scale, 32, 32, view));
        return must(program.draw())[0].at(16, 16)[0];
    };
    for (const char* target : {"glsl_450", "glsl_330", "hlsl_5_0", "hlsl_3_0"}) {
        EXPECT_EQ(brightness("colour", target), 0)
            << "the upper square hides the lower: " << target;
        EXPECT_GT(brightness("depth", target), 0.1) << "seen through its depth: " << target;
    }
}

}  // namespace
}  // namespace intaglio::exec

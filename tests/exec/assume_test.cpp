// Variants pruned by what is known draw the pixels of those that are not, to the bit, wherever what
// is known holds; the guards that it makes needless are gone; and where it does not hold they were
// not needless.
#include "tests/exec/bench.h"

#include <algorithm>
#include <cmath>

#include "generator/passes/rewrite.h"
#include "src/measure/guards.h"
#include "src/measure/interpreted.h"
#include "src/measure/relief_facts.h"

namespace intaglio::exec {
namespace {

using measure::Direction;
using measure::Directions;

constexpr Directions views{20, 90, 0, 360}, lights{25, 60, 100, 170};

// Everything that a scene with these maps, views and lights knows: uniforms that never change, the
// directions of rays, what the textures hold.
passes::Known known_of(const measure::MapSet& set) {
    passes::Known known;
    known.uniforms =
        measure::uniforms_of({}, {}, test_scale, set.heights.width, set.heights.height);
    for (const char* changing : {"eye", "light", "world", "view_projection"})
        known.uniforms.erase(changing);
    const auto add = [&](const std::string& name, const std::array<passes::Interval, 3>& ranges) {
        for (std::size_t i = 0; i < 3; ++i) known.ranges[name + "." + "xyz"[i]] = ranges[i];
    };
    // Both come from infinity and arrive as they are.
    for (const char* name : {"view", "to_eye"}) add(name, measure::vector_ranges(views));
    for (const char* name : {"light", "to_light"}) add(name, measure::vector_ranges(lights));
    const vulkan::Texture normals = measure::normal_texture(set, measure::Filtering::Float);
    for (int i = 0; i < 4; ++i)
        known.ranges[std::string("normal_map.") + "xyzw"[i]] = measure::channel_range(normals, i);
    // The quad's own, and what its edges' neighbours are given.
    for (const char* component : {"uv.x", "uv.y"}) known.ranges[component] = {-1, 2};
    known.ranges["height_map.x"] =
        measure::channel_range(measure::height_texture(set, measure::Filtering::Float), 0);
    return known;
}

// The part of it that the surface has names for.
VariantRequest pruned(VariantRequest wanted, const passes::Known& known) {
    const Recorded recorded = must(record_variant(templates::all_techniques(), wanted));
    wanted.known = passes::part_of(known, recorded.program);
    return wanted;
}

struct Case {
    std::string surface, target;
    Knobs knobs = {};
};

const std::vector<Case> cases = {
    {"parallax_occlusion", "glsl_450"},
    {"parallax_occlusion", "hlsl_5_0"},
    {"steep_parallax,shadow=march", "glsl_450"},
    {"steep_parallax,shadow=march", "hlsl_5_0"},
    {"relief_secant,shadow=occlusion_profile", "glsl_450"},
    {"cone,shadow=horizon,normal=from_hit", "glsl_450"},
    {"exact,shadow=exact,normal=blinn", "glsl_450", {{"max_leaps", "0"}}}};
// Where the shaders are the smallest of several attempts, which reassociate sums and products
// (docs/targets/ps_2_0.md).
const std::vector<Case> direct3d9_cases = {
    {"parallax_occlusion", "ps_2_0"},
    {"steep_parallax", "ps_2_b", {{"min_steps", "3"}, {"max_steps", "5"}}},
    {"relief_secant", "ps_3_0"},
    {"cone,shadow=horizon", "ps_3_0"}};

constexpr std::array corner_views = {Direction{20, 200}, Direction{60, 70}, Direction{90, 0}};
constexpr std::array corner_lights = {Direction{25, 100}, Direction{45, 150}, Direction{60, 170}};

// The pictures of one case with everything and of what is left of it, from each corner.
std::vector<std::array<vulkan::Picture, 2>> whole_and_pruned(const Case& c) {
    const measure::MapSet bricks = map_named("bricks", 64, 64);
    const VariantRequest whole = request(c.surface, c.target, c.knobs);
    Drawing with(whole, bricks, 24), without(pruned(whole, known_of(bricks)), bricks, 24);
    std::vector<std::array<vulkan::Picture, 2>> pairs;
    for (std::size_t i = 0; i < corner_views.size(); ++i)
        pairs.push_back({with.at(corner_views[i], corner_lights[i])[0],
                         without.at(corner_views[i], corner_lights[i])[0]});
    return pairs;
}

TEST(Assume, PrunedVariantsDrawTheSamePixels) {
    for (const Case& c : cases)
        for (const auto& [whole, left] : whole_and_pruned(c))
            EXPECT_TRUE(same_bits(whole, left)) << c.surface << " on " << c.target;
}

TEST(Assume, PrunedDirect3D9VariantsDrawTheSamePixelsButForRounding) {
    for (const Case& c : direct3d9_cases) {
        int far = 0;
        for (const auto& [whole, left] : whole_and_pruned(c))
            for (std::size_t p = 0; p < whole.pixels.size(); ++p)
                for (std::size_t k = 0; k < 4; ++k)
                    far += std::abs(whole.pixels[p][k] - left.pixels[p][k]) <= 1e-5f ? 0 : 1;
        EXPECT_LE(far, 8) << c.surface << " on " << c.target
                          << ": of 6912 numbers; where rounding decides which step hits first";
    }
}

int guards_in(const VariantRequest& wanted, measure::Guard guard) {
    ir::Program program = must(record_variant(templates::all_techniques(), wanted)).program;
    return measure::remove_guard(program.pixel, guard);
}

TEST(Assume, GuardsThatRangesMakeNeedlessAreGone) {
    const passes::Known known = known_of(map_named("bricks", 64, 64));
    struct Needless {
        std::string surface;
        measure::Guard guard;
        int left = 0;
    };
    const std::vector<Needless> all = {
        {"parallax", measure::Guard::FlattestRay},
        {"parallax_occlusion", measure::Guard::FlattestRay},
        {"search=none,shadow=march", measure::Guard::FlattestRay},
        {"parallax_occlusion", measure::Guard::ZeroVector},
        {"search=none,normal=from_hit", measure::Guard::ZeroVector},
        // The sum of its weights is bounded by no interval of one of them.
        {"search=none,shadow=horizon", measure::Guard::ZeroDivisor, 1},
        {"search=none,shadow=march", measure::Guard::DarkLight},
        {"search=none,shadow=occlusion_profile", measure::Guard::DarkLight}};
    for (const Needless& one : all) {
        SCOPED_TRACE(one.surface + ": " + std::string(measure::name_of(one.guard)));
        const VariantRequest whole = request(one.surface, "glsl_450");
        EXPECT_GT(guards_in(whole, one.guard), one.left);
        EXPECT_EQ(guards_in(pruned(whole, known), one.guard), one.left);
    }
}

TEST(Assume, WhereTheRangeIsLeftTheGuardWasNeeded) {
    const measure::MapSet bricks = map_named("bricks", 64, 64);
    const passes::Known known = known_of(bricks);
    const auto differ = [&](const std::string& surface, Direction view, Direction light) {
        const VariantRequest whole = request(surface, "glsl_450");
        return !same_bits(draw(whole, bricks, view, light, 32)[0],
                          draw(pruned(whole, known), bricks, view, light, 32)[0]);
    };
    EXPECT_TRUE(differ("parallax", {0.01, 200}, {45, 150})) << "flatter than the flattest ray";
    EXPECT_TRUE(differ("search=none,shadow=march", {50, 70}, {-10, 150})) << "below the horizon";
    EXPECT_FALSE(differ("parallax", {15, 200}, {45, 150})) << "outside, and no guard needed";
}

int longest(const VariantRequest& wanted) {
    return longest_loop(must(record_variant(templates::all_techniques(), wanted)).program);
}

TEST(Assume, StepsThatTheViewsCannotUseAreGone) {
    const measure::MapSet bricks = map_named("bricks", 64, 64);
    const VariantRequest steep = request("steep_parallax", "glsl_450");
    EXPECT_EQ(longest(steep), 60);
    // 60 steps at the horizon, 10 straight down: 43 at 20 degrees; and none below the lowest point.
    const double deepest =
        measure::relief_facts(bricks.height_field(reference::FilterWeights::Exact)).least;
    const int needed = longest(pruned(steep, known_of(bricks)));
    EXPECT_NEAR(needed, 43 * (1 - deepest), 1.5);
}

// A floor with one pillar: rays that miss it cross all cells that there are.
measure::MapSet pillar() {
    maps::Image heights = maps::blank_image(64, 64, 1, 8);
    heights.at(32, 32) = 1;
    return must(measure::map_set_from_heights("pillar", heights, test_scale));
}

TEST(Assume, CellsBeyondTheReachAreNeverNeeded) {
    const measure::MapSet map = pillar();
    const auto facts = measure::relief_facts(map.height_field(reference::FilterWeights::Exact));
    for (const Direction view : {Direction{8, 30}, {20, 90}}) {
        const int cells =
            measure::view_reach(facts, test_scale, {view.elevation, 90, view.azimuth, view.azimuth})
                .cells();
        const auto picture = [&](int max_cells) {
            return draw(request("exact,output=displaced", "glsl_450",
                                {{"max_leaps", "0"}, {"max_cells", std::to_string(max_cells)}}),
                        map, view, {45, 150}, 24)[0];
        };
        const vulkan::Picture enough = picture(cells);
        EXPECT_TRUE(same_bits(picture(4 * cells), enough));
        EXPECT_FALSE(same_bits(picture(cells - 8), enough)) << "the bound is no wider";
    }
}

// Guards were decided for binary32; R300's arithmetic agrees on them.
TEST(Assume, TheSameInTwentyFourBits) {
    const measure::MapSet bricks = map_named("bricks", 64, 64);
    passes::Known known = known_of(bricks);
    known.uniforms.clear();  // other constants are other registers, and another attempt's sums
    const measure::Textures textures(bricks, measure::Filtering::Float);
    const auto picture = [&](const VariantRequest& wanted) {
        const Variant variant = must(make_variant(templates::all_techniques(), wanted));
        const auto quad =
            must(measure::InterpretedQuad::prepare(variant, textures, test_scale, 16, 16));
        return must(quad.draw({25, 200}, {45, 150}, d3d9::Arithmetic::Fp24)).picture;
    };
    for (const Case& c : {Case{"parallax,output=displaced", "ps_2_0"},
                          Case{"parallax_occlusion,output=displaced", "ps_2_0", {{"taps", "4"}}}}) {
        const VariantRequest whole = request(c.surface, c.target, c.knobs);
        EXPECT_TRUE(same_bits(picture(whole), picture(pruned(whole, known)))) << c.surface;
    }
}

}  // namespace
}  // namespace intaglio::exec

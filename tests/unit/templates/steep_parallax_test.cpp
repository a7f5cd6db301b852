// What the knobs of steep parallax and of parallax occlusion promise.
#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/unit/templates/bench.h"

namespace intaglio::templates {
namespace {

double path_in_texels(const Map& map, const Ray& ray) {
    return std::max(std::abs(ray.view.x) * map.field.width,
                    std::abs(ray.view.y) * map.field.height) /
           ray.view.z * ray.scale;
}

// Texels as columns, by the sorted places where the ray crosses a texel's edge: between two of them
// the middle says which texel it is.
double first_column(const Map& map, const Ray& ray) {
    std::vector<double> edges = {0, 1};
    const auto cross = [&](double start, double travel) {
        const double low = std::min(start, start + travel), high = std::max(start, start + travel);
        for (double line = std::ceil(low); line <= high; ++line)
            if (travel != 0) edges.push_back((line - start) / travel);
    };
    const int w = map.field.width, h = map.field.height;
    const reference::Vec2 end = on_ray(ray, 1);
    cross(ray.uv.x * w, (end.x - ray.uv.x) * w);
    cross(ray.uv.y * h, (end.y - ray.uv.y) * h);
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const reference::Vec2 middle = on_ray(ray, (edges[i] + edges[i + 1]) / 2);
        const auto texel = [](double coordinate, int size) {
            const double wrapped = coordinate - std::floor(coordinate);
            return std::min(static_cast<int>(wrapped * size), size - 1);
        };
        const double height =
            map.field
                .heights[static_cast<std::size_t>(texel(middle.y, h) * w + texel(middle.x, w))];
        const double t = std::max(edges[i], 1 - height);
        if (t <= edges[i + 1]) return t;
    }
    return 1;
}

TEST(SteepParallax, OverColumnsItMeetsTheFirst) {
    const Asked search("steep_parallax", {{"stride", "3"}, {"max_steps", "512"}});
    unsigned state = 71;
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 16}, {3, 5}, {64, 64}};
    for (const auto& [width, height] : sizes) {
        const Map map = noise_map(width, height, state);
        for (double elevation : {3.0, 20.0, 60.0, 90.0})
            for (int i = 0; i < 40; ++i) {
                const Ray ray = random_ray(state, elevation);
                const Answer answer = search(map, ray);
                EXPECT_EQ(answer.found, 1);
                EXPECT_LT(texels_apart(map, answer.uv, on_ray(ray, first_column(map, ray))), 1e-3)
                    << width << " x " << height << " at " << elevation << " degrees";
            }
    }
}

// A map enlarged with hard edges is what texels as columns mean: all but the slopes, one texel of
// the large map wide, are the same.
TEST(SteepParallax, OverColumnsItIsTheExactSearchOnTheEnlargedMap) {
    const Map map = map_named("bricks", 32, 32);
    const Map enlarged = map_of(512, 512, [&](int x, int y) {
        return map.field.heights[static_cast<std::size_t>(y / 16 * 32 + x / 16)];
    });
    const Asked columns("steep_parallax", {{"stride", "3"}});
    const Asked exact("exact");
    unsigned state = 73;
    int near = 0;
    for (int i = 0; i < 300; ++i) {
        const Ray ray = random_ray(state, 40);
        near += texels_apart(map, columns(map, ray).uv, exact(enlarged, ray).uv) < 0.07;
    }
    EXPECT_GT(near, 290);
}

TEST(SteepParallax, StepsOfEqualLengthCrossAsManyTexelsAsTheKnobSays) {
    const Map floor = map_named("flat0");
    unsigned state = 79;
    for (const char* texels : {"0.5", "1", "4"}) {
        const Asked search("steep_parallax", {{"stride", "1"},
                                              {"texels_per_step", texels},
                                              {"min_steps", "1"},
                                              {"max_steps", "512"}});
        for (double elevation : {5.0, 30.0, 80.0}) {
            const Ray ray = random_ray(state, elevation);
            const double steps =
                std::max(1.0, std::ceil(path_in_texels(floor, ray) / std::stod(texels)));
            // The entry is read too.  A path within rounding of a whole number may take one more.
            EXPECT_NEAR(static_cast<double>(search(floor, ray).reads), steps + 1, 1e-9) << texels;
            EXPECT_NEAR(parameter_of(ray, search(floor, ray).uv), 1, 1e-5);
        }
    }
    const Asked few("steep_parallax", {{"stride", "1"}, {"min_steps", "3"}, {"max_steps", "7"}});
    EXPECT_EQ(few(floor, {{0.2, 0.3}, direction(3, 40)}).reads, 8) << "max_steps bounds them";
    EXPECT_EQ(few(floor, {{0.2, 0.3}, {0, 0, 1}}).reads, 4) << "and so does min_steps";
}

TEST(SteepParallax, BothStridesOfEqualStepsAgreeAtEqualCounts) {
    const Map map = map_named("cobbles");
    const Asked in_height("steep_parallax", {{"min_steps", "24"}, {"max_steps", "24"}});
    const Asked on_map(
        "steep_parallax",
        {{"stride", "1"}, {"min_steps", "23"}, {"max_steps", "24"}, {"texels_per_step", "0.25"}});
    unsigned state = 83;
    for (int i = 0; i < 50; ++i) {
        const Ray ray = random_ray(state, 20);
        EXPECT_LT(texels_apart(map, in_height(map, ray).uv, on_map(map, ray).uv), 1e-4);
    }
}

TEST(SteepParallax, TexelByTexelEndsWhereItsStepsEndUnlessTheLevelIsChosen) {
    const Map floor = map_named("flat0");
    const Ray ray{{0.3, 0.6}, direction(6, 30)};
    ASSERT_GT(path_in_texels(floor, ray), 20);
    for (const char* stride : {"2", "3"}) {
        const Knobs knobs = {{"stride", stride}, {"min_steps", "1"}, {"max_steps", "16"}};
        const Answer ended = Asked("steep_parallax", knobs)(floor, ray);
        EXPECT_EQ(ended.found, 0);
        EXPECT_LE(ended.reads, 17);
        Knobs coarse = knobs;
        coarse.emplace_back("nyquist", "1");
        const Asked reaching("steep_parallax", coarse);
        for (double elevation : {1.0, 6.0, 30.0, 90.0})
            for (double azimuth : {0.0, 30.0, 45.0, 260.0}) {
                const Answer whole = reaching(floor, {ray.uv, direction(elevation, azimuth)});
                EXPECT_EQ(whole.found, 1) << stride << " at " << elevation;
                EXPECT_LE(whole.reads, 17) << stride << " at " << elevation;
            }
    }
}

// One read a line: what is lost lies between two lines, where the filtered relief bends but little.
TEST(SteepParallax, FromLineToLineItLosesLessThanInSteps) {
    const Asked lines("steep_parallax", {{"stride", "2"}, {"max_steps", "512"}}), exact("exact", {{"max_leaps", "0"}}),
        steps("steep_parallax", {{"stride", "1"}, {"min_steps", "1"}, {"max_steps", "512"}});
    for (const char* maker : {"spikes", "cobbles", "text", "smooth"}) {
        const Map map = map_named(maker);
        unsigned state = 97;
        int lost_by_lines = 0, lost_by_steps = 0;
        for (int i = 0; i < 1000; ++i) {
            const Ray ray = random_ray(state, 20);
            const double first = parameter_of(ray, exact(map, ray).uv);
            const auto loses = [&](const Asked& search) {
                const double t = std::min(parameter_of(ray, search(map, ray).uv), 1.0);
                return reference::leaves_relief(map.field, ray.uv, ray.view, ray.scale, first, t);
            };
            const bool lost = loses(lines);
            lost_by_lines += lost;
            lost_by_steps += loses(steps);
            const Answer answer = lines(map, ray);
            EXPECT_GE(parameter_of(ray, answer.uv), first - 1e-5) << maker;
            // The next line lies within a texel on either axis.  One read more is the entry's, and
            // one where the relief dips again by less than counts as lost.
            if (!lost) {
                EXPECT_LT(texels_apart(map, answer.uv, on_ray(ray, first)), 1.42) << maker;
                EXPECT_LE(answer.reads, exact(map, ray).reads / 4 + 2) << maker;
            }
        }
        EXPECT_LE(lost_by_lines, lost_by_steps / 2) << maker;
        if (std::string(maker) == "spikes") {
            EXPECT_GT(lost_by_steps, 30);
        }
    }
}

// On a level relief the hit is at t = 1 - height of whatever ray is marched.
TEST(ParallaxOcclusion, ItsKnobsShortenTheRayAsTheChapterSays) {
    unsigned state = 89;
    const Map map = flat_map(0.4);
    for (double elevation : {4.0, 25.0, 50.0, 90.0})
        for (double bias : {1.0, 0.75, 0.5, 0.0})
            for (double power : {0.0, 0.5, 2.0}) {
                const Ray ray = random_ray(state, elevation);
                const Asked search("parallax_occlusion",
                                   {{"perspective_bias", std::to_string(bias)},
                                    {"attenuation", std::to_string(power)}});
                // fPerspectiveBias + (1 - fPerspectiveBias) * (2 * vViewTS.z - 1), not below 0; and
                // the dot product of normal and view to the power of n.
                const double share = std::max(bias + (1 - bias) * (2 * ray.view.z - 1), 0.0) *
                                     std::pow(ray.view.z, power);
                const reference::Vec2 expected = on_ray(ray, 0.6 * share);
                const Answer answer = search(map, ray);
                // lavapipe's pow: 4e-6 of up to a texture unit of reach.
                EXPECT_NEAR(answer.uv.x, expected.x, 1e-5);
                EXPECT_NEAR(answer.uv.y, expected.y, 1e-5);
            }
}

TEST(ParallaxOcclusion, FadesToBumpMappingOverOneMipLevel) {
    const Map map = map_of(64, 64, [](int, int) { return 0.4; });
    const Asked search("parallax_occlusion", {{"fade_level", "3"}});
    Ray ray{{0.3, 0.6}, direction(40, 200)};
    const double whole = 0.6;
    for (const auto& [level, share] : {std::pair{-5.0, 1.0},
                                       {1.0, 1.0},
                                       {2.0, 1.0},
                                       {2.25, 0.75},
                                       {2.5, 0.5},
                                       {3.0, 0.0},
                                       {7.0, 0.0}}) {
        ray.pixel = {std::exp2(level) / 64, std::exp2(level) / 64 * 0.9};
        EXPECT_NEAR(parameter_of(ray, search(map, ray).uv), whole * share, 1e-4) << level;
    }
    // Faded away it does not march on.
    EXPECT_EQ(search(map, ray).reads, 1);
}

TEST(ParallaxOcclusion, KnobsThatAreOffCostNothing) {
    const Asked plain("parallax_occlusion");
    for (ir::Op op : {ir::Op::Pow, ir::Op::Log2, ir::Op::Ddx, ir::Op::Ddy})
        EXPECT_FALSE(plain.has(op)) << ir::info(op).name;
    EXPECT_TRUE(Asked("parallax_occlusion", {{"attenuation", "1"}}).has(ir::Op::Pow));
    EXPECT_TRUE(Asked("parallax_occlusion", {{"fade_level", "1"}}).has(ir::Op::Ddx));
    const Map map = map_named("bricks");
    const Ray ray{{0.3, 0.6}, direction(40, 200)};
    const long whole = plain(map, ray).instructions;
    EXPECT_GT(Asked("parallax_occlusion", {{"perspective_bias", "0.9"}})(map, ray).instructions,
              whole);
    const Asked steep("steep_parallax");
    for (ir::Op op : {ir::Op::Log2, ir::Op::Exp2, ir::Op::Frac})
        EXPECT_FALSE(steep.has(op)) << ir::info(op).name;
}

// A section begins where the true ray leaves the one above it.
TEST(ParallaxOcclusion, OnAShortenedRayItDoesNotSayWhatItFindsInSections) {
    const Map map = flat_map(0.3);
    const Ray ray{{0.3, 0.6}, direction(40, 200)};
    EXPECT_GE(Asked("parallax_occlusion", {}, 0, 2)(map, ray).found, 0);
    for (const auto& knob :
         Knobs{{"perspective_bias", "0.9"}, {"attenuation", "1"}, {"fade_level", "2"}}) {
        EXPECT_EQ(Asked("parallax_occlusion", {knob}, 0, 2)(map, ray).found, -1) << knob.first;
        EXPECT_GE(Asked("parallax_occlusion", {knob})(map, ray).found, 0) << knob.first;
    }
}

}  // namespace
}  // namespace intaglio::templates

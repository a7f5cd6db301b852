// Every bound against what random maps and rays do, found by the reference or by counting; and that
// the bounds are no wider than they need to be, so that a bound of infinity would fail here.
#include "src/measure/relief_facts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "generator/ir/texture.h"
#include "src/measure/view.h"
#include "src/reference/trace.h"
#include "tests/unit/ir/random.h"

namespace intaglio::measure {
namespace {

using ir::testing::Random;
using reference::HeightField;
using reference::Vec2;
using reference::Vec3;

double between(Random& random, double least, double most) {
    return least + (most - least) * static_cast<double>(random.unit());
}

HeightField random_field(Random& random) {
    HeightField field;
    field.width = random.between(1, 12);
    field.height = random.between(1, 12);
    const double base = between(random, 0, 0.5), range = between(random, 0.01, 1 - base);
    for (int i = 0; i < field.width * field.height; ++i)
        field.heights.push_back(base + range * static_cast<double>(random.unit()));
    return field;
}

Directions random_directions(Random& random, double lowest) {
    Directions directions;
    directions.least_elevation = between(random, lowest, 85);
    directions.most_elevation = between(random, directions.least_elevation, 90);
    directions.least_azimuth = between(random, -180, 180);
    directions.most_azimuth =
        directions.least_azimuth + (random.chance(30) ? 360 : between(random, 0, 200));
    return directions;
}

Direction within(Random& random, const Directions& all) {
    // The ends, where bounds are met, as often as not.
    const double elevation = random.chance(50)
                                 ? all.least_elevation
                                 : between(random, all.least_elevation, all.most_elevation);
    return {elevation, between(random, all.least_azimuth, all.most_azimuth)};
}

Vec3 exact(Direction direction) {
    const double e = direction.elevation * std::numbers::pi / 180,
                 a = direction.azimuth * std::numbers::pi / 180;
    return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

Vec2 random_place(Random& random) { return {between(random, -2, 2), between(random, -2, 2)}; }

TEST(ReliefFacts, VectorsLieInTheirRanges) {
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const Directions directions = random_directions(random, -60);
        const auto ranges = vector_ranges(directions);
        double widest = 0;
        for (int k = 0; k < 10; ++k) {
            const auto vector = vector_of(within(random, directions));
            for (std::size_t c = 0; c < 3; ++c) {
                ASSERT_GE(vector[c], ranges[c].least);
                ASSERT_LE(vector[c], ranges[c].most);
                widest = std::max(widest, static_cast<double>(ranges[c].most - ranges[c].least));
            }
        }
        ASSERT_LT(widest, 2.001);
    }
    const auto one = vector_ranges({30, 30, 90, 90});
    EXPECT_NEAR(one[0].most, 0, 1e-4);
    EXPECT_NEAR(one[1].least, std::sqrt(0.75), 1e-4);
    EXPECT_NEAR(one[2].least, 0.5, 1e-4);
    EXPECT_LT(one[2].least, 0.5f);
}

TEST(ReliefFacts, NothingReadLiesOutsideAChannelsRange) {
    Random random(2);
    for (int i = 0; i < 50; ++i) {
        vulkan::Texture stored;
        stored.width = stored.height = 4;
        for (int side : {4, 2, 1}) {
            auto& level = stored.levels.emplace_back();
            for (int k = 0; k < 4 * side * side; ++k) level.push_back(0.2f + 0.6f * random.unit());
        }
        stored.format = random.chance(50) ? vulkan::Texture::Format::Rgba8Unorm
                                          : vulkan::Texture::Format::Rgba32Float;
        ir::Texture texture;
        texture.width = texture.height = 4;
        for (const auto& level : stored.levels)
            texture.levels.push_back(
                vulkan::decode(vulkan::encode(level, stored.format), stored.format));
        for (int k = 0; k < 50; ++k) {
            const std::array<float, 3> at = {random.unit() * 4, random.unit() * 4, 0};
            const auto texel = ir::sample_level(texture, at, random.unit() * 3);
            for (int c = 0; c < 4; ++c) {
                const passes::Interval range = channel_range(stored, c);
                ASSERT_GE(texel[static_cast<std::size_t>(c)], range.least);
                ASSERT_LE(texel[static_cast<std::size_t>(c)], range.most);
                ASSERT_GT(range.least, 0.19f);
                ASSERT_LT(range.most, 0.81f);
            }
        }
    }
}

TEST(ReliefFacts, NoHeightLiesOutside) {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const HeightField field = random_field(random);
        const ReliefFacts facts = relief_facts(field);
        for (int k = 0; k < 50; ++k) {
            const double height = reference::height_at(field, random_place(random));
            ASSERT_GE(height, facts.least - 1e-15);
            ASSERT_LE(height, facts.most + 1e-15);
        }
    }
}

// A point that the light does not reach, among many.
bool finds_shadow(Random& random, const HeightField& field, double scale, const Directions& lights,
                  int points) {
    for (int k = 0; k < points; ++k) {
        const Vec2 uv = random_place(random);
        if (!reference::lit(field, uv, reference::height_at(field, uv),
                            exact(within(random, lights)), scale))
            return true;
    }
    return false;
}

TEST(ReliefFacts, ALightAsSteepAsTheSteepestSlopeThrowsNoShadow) {
    Random random(4);
    int tight = 0, maps = 0;
    for (int i = 0; i < 150; ++i) {
        const HeightField field = random_field(random);
        const double scale = between(random, 0.01, 0.3);
        Directions lights = random_directions(random, 10);
        const double slope = steepest_slope(field, scale, lights);
        if (slope < 1e-3) continue;
        ++maps;
        const double degrees = std::atan(slope) * 180 / std::numbers::pi;
        lights.least_elevation = std::min(degrees * (1 + 1e-9) + 1e-9, 90.0);
        lights.most_elevation = 90;
        ASSERT_TRUE(casts_no_shadow(field, scale, lights));
        ASSERT_FALSE(finds_shadow(random, field, scale, lights, 300)) << "map " << i;
        lights.least_elevation = lights.most_elevation =
            std::atan(slope * 0.6) * 180 / std::numbers::pi;
        ASSERT_FALSE(casts_no_shadow(field, scale, lights));
        tight += finds_shadow(random, field, scale, lights, 3000) ? 1 : 0;
    }
    EXPECT_GT(tight * 10, maps * 6) << "lights a little lower throw shadows: the bound is no wider";
}

// Whole numbers that a path from a to b goes over.
int lines(double a, double b) { return static_cast<int>(std::fabs(std::floor(b) - std::floor(a))); }

TEST(ReliefFacts, NoRayGoesFurther) {
    Random random(5);
    double nearest = 0, most_cells = 0;
    for (int i = 0; i < 400; ++i) {
        HeightField field = random_field(random);
        if (random.chance(30)) std::fill(field.heights.begin(), field.heights.end(), 0.25);
        const double scale = between(random, 0.01, 1);
        const Directions views = random_directions(random, 2);
        const ReliefFacts facts = relief_facts(field);
        const RayReach reach = view_reach(facts, scale, views);
        const RayReach below = view_reach_below_top(facts, scale, views);
        for (int k = 0; k < 20; ++k) {
            const Vec2 uv = random_place(random);
            const Vec3 view = exact(within(random, views));
            const reference::Hit hit = reference::first_hit(field, uv, view, scale);
            ASSERT_TRUE(hit.found);
            const double u = std::fabs(hit.uv.x - uv.x) * field.width,
                         v = std::fabs(hit.uv.y - uv.y) * field.height;
            constexpr double rounding = 1e-9;
            ASSERT_LE(u, reach.along_u + rounding);
            ASSERT_LE(v, reach.along_v + rounding);
            ASSERT_LE(std::max(u, v), reach.longer + rounding);
            ASSERT_LE(u + v, reach.added + rounding);
            const int cells = 1 + lines(uv.x * field.width - 0.5, hit.uv.x * field.width - 0.5) +
                              lines(uv.y * field.height - 0.5, hit.uv.y * field.height - 0.5);
            ASSERT_LE(cells, reach.cells());
            // Below the top: the share of the ray from where it is as low as that.
            const double share = (hit.t - (1 - facts.most)) / std::max(hit.t, 1e-300);
            ASSERT_LE((u + v) * share, below.added + rounding);
            nearest = std::max(nearest, (u + v) / std::max(reach.added, 1e-9));
            most_cells = std::max(most_cells, static_cast<double>(cells) / reach.cells());
        }
    }
    EXPECT_GT(nearest, 0.97) << "no ray comes near the bound";
    EXPECT_GT(most_cells, 0.8);
}

TEST(ReliefFacts, StepsLeaveNoTexelOut) {
    Random random(6);
    for (int i = 0; i < 500; ++i) {
        const HeightField field = random_field(random);
        const double scale = between(random, 0.01, 1);
        const Directions views = random_directions(random, 2);
        const RayReach reach = view_reach({field.width, field.height, 0, 1}, scale, views);
        const Vec3 view = exact(within(random, views));
        const double u = view.x / view.z * scale * field.width,
                     v = view.y / view.z * scale * field.height;
        const int steps = reach.steps();
        ASSERT_LE(std::max(std::fabs(u), std::fabs(v)) / steps, 1 + 1e-9);
        ASSERT_TRUE(steps == 1 || reach.longer / (steps - 1) > 1) << "one less would do";
        const int halvings = useful_halvings(reach, steps, 1.0 / 16);
        ASSERT_LE(reach.longer / steps / std::exp2(halvings), 1.0 / 16);
        ASSERT_TRUE(halvings == 0 || reach.longer / steps / std::exp2(halvings - 1) > 1.0 / 16);
    }
}

TEST(ReliefFacts, LightRaysAreBoundedByTheHeightsThatAreThere) {
    const Directions low = {10, 90, 0, 0};
    const RayReach reach = light_reach({64, 32, 0.25, 0.75}, 0.1, low);
    EXPECT_NEAR(reach.along_u, 64 * 0.1 * 0.5 / std::tan(10 * std::numbers::pi / 180), 1e-9);
    EXPECT_NEAR(reach.along_v, 0, 1e-9);
    EXPECT_EQ(light_reach({64, 32, 0.5, 0.5}, 0.1, low).cells(), 5);
}

}  // namespace
}  // namespace intaglio::measure

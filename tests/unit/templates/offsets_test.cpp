// The searches that look the offset up and march nothing: closed forms, and each other.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/unit/templates/bench.h"

namespace intaglio::templates {
namespace {

// Rounding of a coordinate in the tile and of what is added to it.
constexpr double rounding = 1e-6;

void expect_same_place(const Answer& actual, reference::Vec2 expected,
                       double tolerance = rounding) {
    EXPECT_NEAR(actual.uv.x, expected.x, tolerance);
    EXPECT_NEAR(actual.uv.y, expected.y, tolerance);
}

double rounded(double value) { return static_cast<double>(static_cast<float>(value)); }

TEST(Parallax, OnALevelReliefIsTheHit) {
    unsigned state = 3;
    const Asked parallax("parallax");
    for (double elevation : {3.0, 20.0, 60.0, 90.0})
        for (double height : {0.0, 0.25, 0.7, 1.0}) {
            const Ray ray = random_ray(state, elevation);
            const Map map = flat_map(height);
            const reference::Hit hit = reference::first_hit(map.field, ray.uv, ray.view, ray.scale);
            expect_same_place(parallax(map, ray), hit.uv);
        }
}

// t = s + B[s] E.xy / E.z: the abstract of steep parallax, whose E is the source's, heights above
// the polygon by scale and bias.
TEST(Parallax, IsTheFormulaOfItsSource) {
    unsigned state = 5;
    const Map map = noise_map(16, 16, state);
    for (int i = 0; i < 50; ++i) {
        const Ray ray = random_ray(state, 10 + 80 * random_share(state));
        const double scale = 0.5 + random_share(state), bias = -random_share(state);
        const double rise =
            (reference::height_at(map.field, ray.uv) + rounded(bias)) * rounded(scale) * ray.scale;
        const Answer parallax =
            Asked("parallax", {{"parallax_scale", std::to_string(scale)},
                               {"parallax_bias", std::to_string(bias)}})(map, ray);
        expect_same_place(
            parallax,
            {ray.uv.x + rise * ray.view.x / ray.view.z, ray.uv.y + rise * ray.view.y / ray.view.z},
            3e-6);
        // Welsh 2004: the same without the division.
        const Answer limited =
            Asked("parallax_limited", {{"limited_scale", std::to_string(scale)},
                                       {"limited_bias", std::to_string(bias)}})(map, ray);
        expect_same_place(limited, {ray.uv.x + rise * ray.view.x, ray.uv.y + rise * ray.view.y},
                          3e-6);
    }
}

TEST(Parallax, WithScaleZeroIsNone) {
    unsigned state = 9;
    const Map map = noise_map(16, 16, state);
    const Asked none("none"), parallax("parallax", {{"parallax_scale", "0"}}),
        limited("parallax_limited", {{"limited_scale", "0"}});
    for (double elevation : {-20.0, 0.0, 0.5, 30.0, 90.0}) {
        const Ray ray = random_ray(state, elevation);
        for (const Asked* search : {&parallax, &limited}) {
            EXPECT_EQ((*search)(map, ray).uv.x, none(map, ray).uv.x);
            EXPECT_EQ((*search)(map, ray).uv.y, none(map, ray).uv.y);
        }
    }
}

TEST(ParallaxLimited, NeverMovesFurtherThanTheReliefIsDeep) {
    unsigned state = 21;
    const Map map = noise_map(16, 16, state);
    const Asked limited("parallax_limited");
    for (int i = 0; i < 200; ++i) {
        const Ray ray = random_ray(state, 90 * random_share(state));
        const Answer answer = limited(map, ray);
        EXPECT_LE(std::hypot(answer.uv.x - ray.uv.x, answer.uv.y - ray.uv.y), ray.scale + rounding);
    }
}

// Mean way of the answer on the map, in texels, while the camera sinks by a tenth of a degree.
double swim(const Asked& search, const Map& map, double elevation) {
    unsigned state = 31;
    double sum = 0;
    constexpr int rays = 400;
    for (int i = 0; i < rays; ++i) {
        Ray ray = random_ray(state, elevation);
        const double azimuth = 360 * random_share(state);
        ray.view = direction(elevation, azimuth);
        const reference::Vec2 before = search(map, ray).uv;
        ray.view = direction(elevation - 0.1, azimuth);
        sum += texels_apart(map, before, search(map, ray).uv);
    }
    return sum / rays;
}

// Mean offset, as a share of the true one.
double share_of_offset(const Asked& search, const Map& map, double elevation) {
    unsigned state = 33;
    double sum = 0, exact = 0;
    for (int i = 0; i < 400; ++i) {
        const Ray ray = random_ray(state, elevation);
        const reference::Hit hit = reference::first_hit(map.field, ray.uv, ray.view, ray.scale);
        sum += texels_apart(map, search(map, ray).uv, ray.uv);
        exact += texels_apart(map, hit.uv, ray.uv);
    }
    return sum / exact;
}

// Of parallax's offset h cot e it keeps h cos e: it swims by the cube of sin e as much, and is of
// the relief's depth what sin e is of 1.
TEST(ParallaxLimited, SwimsLessAndFlattens) {
    const Asked limited("parallax_limited"), parallax("parallax"),
        weighted("parallax_limited", {{"normal_weight", "1"}});
    for (const char* maker : {"smooth", "cobbles", "spikes"}) {
        const Map map = map_named(maker);
        for (double elevation : {60.0, 30.0, 10.0}) {
            SCOPED_TRACE(testing::Message() << maker << " at " << elevation << " degrees");
            const double sine = std::sin(elevation * std::numbers::pi / 180);
            const double swims = swim(parallax, map, elevation);
            // Measured 0.999 to 1.02 of it: a tenth of a degree is no differential.
            EXPECT_NEAR(swim(limited, map, elevation) / swims / std::pow(sine, 3), 1, 0.05);
            EXPECT_NEAR(share_of_offset(limited, map, elevation) /
                            share_of_offset(parallax, map, elevation),
                        sine, 1e-5);
        }
        // Measured 0.87 at 60 degrees, 0.18 to 0.28 at 10.
        EXPECT_GT(share_of_offset(limited, map, 60), 0.8);
        EXPECT_LT(share_of_offset(limited, map, 10), 0.35);
        // Times N.V, here sin e, measured 0.58 of the limited form at 60 degrees; at 10 more than
        // it (5.4 times), and 0.028 of parallax.
        EXPECT_LT(swim(weighted, map, 60), 0.7 * swim(limited, map, 60)) << maker;
        EXPECT_LT(swim(weighted, map, 10), 0.05 * swim(parallax, map, 10)) << maker;
    }
}

TEST(ParallaxLimited, TheMapsNormalScalesTheOffset) {
    const reference::Vec3 normal = {0.6, 0, 0.8};
    unsigned state = 23;
    const Map map = map_of(
        8, 8, [](int, int) { return 0.25; }, [&](int, int) { return normal; });
    const Asked plain("parallax_limited"), weighted("parallax_limited", {{"normal_weight", "1"}});
    for (int i = 0; i < 50; ++i) {
        const Ray ray = random_ray(state, 5 + 80 * random_share(state));
        const double facing =
            std::max(0.0, normal.x * ray.view.x + normal.y * ray.view.y + normal.z * ray.view.z);
        const Answer without = plain(map, ray);
        expect_same_place(weighted(map, ray), {ray.uv.x + (without.uv.x - ray.uv.x) * facing,
                                               ray.uv.y + (without.uv.y - ray.uv.y) * facing});
    }
}

TEST(ParallaxIterative, OnceWithoutSlopeIsTheLimitedForm) {
    unsigned state = 25;
    const Map map = noise_map(16, 16, state);
    const Asked once("parallax_iterative", {{"iterations", "1"}, {"slope", "0"}});
    const Asked limited("parallax_limited");
    for (double elevation : {2.0, 15.0, 50.0, 90.0}) {
        const Ray ray = random_ray(state, elevation);
        expect_same_place(once(map, ray), limited(map, ray).uv);
    }
}

// p += n_z (h(p) - p_z) V, with p a point of space as in the source.
TEST(ParallaxIterative, IsTheFormulaOfItsSource) {
    unsigned state = 27;
    const Map flat_normals = noise_map(16, 16, state);
    const Map map = map_of(
        16, 16,
        [&](int x, int y) {
            return flat_normals.field.heights[static_cast<std::size_t>(y * 16 + x)];
        },
        [](int, int) {
            return reference::Vec3{0.8, 0, 0.6};
        });
    for (int iterations : {1, 2, 3, 5})
        for (int slope : {0, 1}) {
            const Asked search("parallax_iterative", {{"iterations", std::to_string(iterations)},
                                                      {"slope", std::to_string(slope)}});
            for (int ray_number = 0; ray_number < 20; ++ray_number) {
                const Ray ray = random_ray(state, 10 + 80 * random_share(state));
                reference::Vec3 p = {ray.uv.x, ray.uv.y, 0};
                for (int i = 0; i < iterations; ++i) {
                    const double height =
                        (reference::height_at(map.field, {p.x, p.y}) - 1) * ray.scale;
                    const double step = (slope == 1 ? 0.6 : 1) * (height - p.z);
                    p = {p.x + step * ray.view.x, p.y + step * ray.view.y, p.z + step * ray.view.z};
                }
                // Each read scales the rounding before it by the steepest slope, 16 texels x 0.08.
                expect_same_place(search(map, ray), {p.x, p.y}, 2e-5);
            }
        }
}

TEST(ParallaxIterative, ComesToTheHitOnALevelRelief) {
    const Ray ray{{0.3, 0.4}, direction(30, 70)};
    const Map map = flat_map(0.2);
    const reference::Hit hit = reference::first_hit(map.field, ray.uv, ray.view, ray.scale);
    double before = 1;
    for (int iterations : {1, 2, 4, 8, 16, 32}) {
        const Answer answer =
            Asked("parallax_iterative", {{"iterations", std::to_string(iterations)}})(map, ray);
        const double error = std::hypot(answer.uv.x - hit.uv.x, answer.uv.y - hit.uv.y);
        EXPECT_LT(error, before) << iterations;
        before = error + rounding;
    }
    EXPECT_LT(before, 2 * rounding);
}

TEST(ParallaxIterative, StaysOnTheRayWhateverTheNormalsAre) {
    unsigned state = 29;
    const Map map = map_of(
        16, 16, [&](int, int) { return random_share(state); },
        [&](int, int) {
            return reference::Vec3{3 * random_share(state) - 1, 0, 4 * random_share(state) - 2};
        });
    const Asked search("parallax_iterative", {{"iterations", "9"}});
    for (int i = 0; i < 200; ++i) {
        const Ray ray = random_ray(state, 1 + 88 * random_share(state));
        const double t = parameter_of(ray, search(map, ray).uv);
        EXPECT_GE(t, -rounding);
        EXPECT_LE(t, 1 + rounding);
    }
}

}  // namespace
}  // namespace intaglio::templates

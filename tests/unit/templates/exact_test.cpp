// The exact search against the exact reference: nothing missed, errors of float's size.
#include <algorithm>
#include <cmath>

#include "src/maps/makers.h"
#include "tests/unit/templates/bench.h"

namespace intaglio::templates {
namespace {

// Over squares of patches by the baked maps, and patch by patch.
const Knobs ways[] = {{{"max_cells", "4096"}}, {{"max_cells", "4096"}, {"max_leaps", "0"}}};

struct Errors {
    int missed = 0, lost = 0;
    std::vector<double> texels;
    double share(double part) {
        std::sort(texels.begin(), texels.end());
        return texels[static_cast<std::size_t>(part * static_cast<double>(texels.size() - 1))];
    }
};

// Missed: went through a feature of more than half a step of an 8-bit map.  Lost: did not say that
// it found something.
void compare(const Asked& exact, const Map& map, const Ray& ray, Errors& errors) {
    const Answer answer = exact(map, ray);
    const reference::Hit hit = reference::first_hit(map.field, ray.uv, ray.view, ray.scale);
    ASSERT_TRUE(hit.found);
    const double t = std::min(parameter_of(ray, answer.uv), 1.0);
    errors.missed += reference::leaves_relief(map.field, ray.uv, ray.view, ray.scale, hit.t, t);
    errors.lost += answer.found != 1;
    errors.texels.push_back(texels_apart(map, answer.uv, hit.uv));
}

// Four roundings or so of coordinates as large as the map and the path together, in texels.
double float_bound(const Map& map, const Ray& ray) {
    const double path = std::hypot(ray.view.x * map.field.width, ray.view.y * map.field.height) /
                        ray.view.z * ray.scale;
    return std::ldexp(std::max(map.field.width, map.field.height) + path, -22);
}

class Exact : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Ways, Exact, testing::Values(0, 1), [](const auto& test) {
    return test.param == 0 ? std::string("Leaping") : std::string("Walking");
});

TEST_P(Exact, MissesNothingOnAnyMakerAtAnyAngle) {
    const Asked exact("exact", ways[GetParam()]);
    unsigned state = 7;
    for (const maps::Maker& maker : maps::makers()) {
        const Map map = map_named(std::string(maker.name));
        for (double elevation : {1.0, 5.0, 20.0, 45.0, 90.0}) {
            SCOPED_TRACE(testing::Message() << maker.name << " at " << elevation << " degrees");
            Errors errors;
            Ray ray;
            for (int i = 0; i < 60; ++i) {
                ray = random_ray(state, elevation);
                compare(exact, map, ray, errors);
            }
            EXPECT_EQ(errors.missed, 0);
            EXPECT_EQ(errors.lost, 0);
            EXPECT_LT(errors.share(0.99), float_bound(map, ray));
        }
    }
}

TEST_P(Exact, MissesNothingOnNoiseOfAnySizeAtAnyScale) {
    const Asked exact("exact", ways[GetParam()]);
    unsigned state = 11;
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 64}, {64, 1}, {2, 2}, {3, 5}, {37, 64}};
    for (const auto& [width, height] : sizes) {
        const Map map = noise_map(width, height, state);
        for (double scale : {0.01, 0.1, 0.5})
            for (double elevation : {1.5, 10.0, 30.0, 60.0, 89.0}) {
                SCOPED_TRACE(testing::Message() << width << " x " << height << ", scale " << scale
                                                << ", " << elevation << " degrees");
                Errors errors;
                Ray ray;
                for (int i = 0; i < 20; ++i) {
                    ray = random_ray(state, elevation, scale);
                    compare(exact, map, ray, errors);
                }
                EXPECT_EQ(errors.missed, 0);
                EXPECT_EQ(errors.lost, 0);
                EXPECT_LT(errors.share(0.8), float_bound(map, ray));
            }
    }
}

// Along texel rows and columns, along diagonals, from texel centres, edges and corners: where lines
// are met at the same t, or never.
TEST_P(Exact, MissesNothingOnRaysThroughCornersAndAlongLines) {
    const Asked exact("exact", ways[GetParam()]);
    unsigned state = 13;
    const Map map = noise_map(16, 16, state);
    for (double azimuth = 0; azimuth < 360; azimuth += 45)
        for (double elevation : {3.0, 30.0, 90.0})
            for (int start = 0; start < 64; ++start) {
                const double sine[] = {0, 1, 0, -1, 0};
                const int quarter = static_cast<int>(azimuth / 90);
                Ray ray{{start % 8 / 32.0, start / 8 / 32.0}, direction(elevation, azimuth)};
                if (azimuth == 90 * quarter) {  // exactly on the axis
                    ray.view.x = sine[quarter + 1] * std::hypot(ray.view.x, ray.view.y);
                    ray.view.y = ray.view.x != 0 ? 0 : sine[quarter] * std::cos(elevation / 57.3);
                }
                Errors errors;
                compare(exact, map, ray, errors);
                EXPECT_EQ(errors.missed + errors.lost, 0)
                    << "from " << ray.uv.x << ", " << ray.uv.y << " to " << azimuth << " at "
                    << elevation << " degrees";
            }
}

// On a map whose size is no power of two coordinates far from 0 would round to another place in
// their texel; the height does not suffer from the rounding of the answer's own coordinate.
TEST_P(Exact, TilesRepeat) {
    const Asked exact("exact", ways[GetParam()]);
    unsigned state = 17;
    const Map map = noise_map(37, 37, state);
    for (int i = 0; i < 200; ++i) {
        Ray ray = random_ray(state, 15);
        // A multiple of 2^-10 keeps its bits in every tile.
        ray.uv = {std::floor(ray.uv.x * 1024) / 1024, std::floor(ray.uv.y * 1024) / 1024};
        Ray there = ray;
        there.uv = {ray.uv.x - 64, ray.uv.y + 1000};
        EXPECT_NEAR(exact(map, there).height, exact(map, ray).height, 1e-5);
    }
}

TEST(ExactSearch, ARayThatStartsInsideEndsThere) {
    const Map top = map_named("flat1");
    const Asked lower("exact", {}, 1, 2);
    const Ray ray{{0.3, 0.6}, direction(30, 200)};
    const Answer answer = lower(top, ray);
    EXPECT_EQ(answer.found, 1);
    EXPECT_EQ(answer.uv.x, 0.3f);
    EXPECT_EQ(answer.uv.y, 0.6f);
}

TEST(ExactSearch, SaysWhereItsReachEnds) {
    const Map floor = map_named("flat0");
    const Ray ray{{0.3, 0.6}, direction(20, 30)};
    const double path_x = ray.view.x / ray.view.z * ray.scale * 64,
                 path_y = ray.view.y / ray.view.z * ray.scale * 64;
    const int least = static_cast<int>(path_x) + static_cast<int>(path_y) - 1;
    const int enough = least + 4;
    const Answer near = Asked("exact", {{"max_cells", std::to_string(least)}, {"max_leaps", "0"}})(floor, ray);
    EXPECT_EQ(near.found, 0) << "the ray crosses more cells";
    EXPECT_EQ(near.reads, 4 * least);
    EXPECT_LT(parameter_of(ray, near.uv), 1);
    const Answer far = Asked("exact", {{"max_cells", std::to_string(enough)}, {"max_leaps", "0"}})(floor, ray);
    EXPECT_EQ(far.found, 1);
    EXPECT_NEAR(parameter_of(ray, far.uv), 1, 1e-6);
}

TEST_P(Exact, SearchesInSectionsAsInOne) {
    const Asked whole("exact", ways[GetParam()]), upper("exact", ways[GetParam()], 0, 2),
        lower("exact", ways[GetParam()], 1, 2);
    const Map map = map_named("cobbles");
    unsigned state = 19;
    int in_each[2] = {0, 0};
    for (int i = 0; i < 200; ++i) {
        const Ray ray = random_ray(state, 30);
        const double expected = parameter_of(ray, whole(map, ray).uv);
        Ray slab = ray;
        slab.scale = ray.scale / 2;
        Answer answer = upper(map, slab);
        const bool first = answer.found == 1;
        if (!first) {
            slab.uv = on_ray(ray, 0.5);
            answer = lower(map, slab);
        }
        ++in_each[first ? 0 : 1];
        EXPECT_EQ(answer.found, 1);
        EXPECT_NEAR(parameter_of(ray, answer.uv), expected, 1e-5);
    }
    EXPECT_GT(in_each[0], 10);
    EXPECT_GT(in_each[1], 10);
}

}  // namespace
}  // namespace intaglio::templates

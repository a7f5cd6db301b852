// Cones against the surface itself: nothing of it is inside an empty cone, and no ray leaves it
// again inside a relaxed one; and neither is much narrower than it must be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/maps/bake_cone.h"
#include "tests/unit/maps/relief_maps.h"

namespace intaglio::maps {
namespace {

constexpr unsigned seed = 41;

Image cones_of(const Image& heights, ConeKind kind) {
    Result<Image> cones = bake_cone(heights, kind);
    EXPECT_TRUE(cones.ok()) << to_string(cones.error());
    return std::move(*cones);
}

// The ratio of a read root, as the shader squares it.
double squared(double root) { return root * root; }

TEST(BakeCone, KeepsTheHeights) {
    std::mt19937 random(seed);
    for (const ReliefMap& map : relief_maps(random)) {
        const Image cones = cones_of(map.heights, ConeKind::Empty);
        ASSERT_EQ(cones.channels, 2);
        ASSERT_EQ(cones.bits, map.heights.bits);
        for (int y = 0; y < cones.height; ++y)
            for (int x = 0; x < cones.width; ++x)
                ASSERT_EQ(cones.at(x, y), map.heights.at(x, y)) << map.name;
    }
}

TEST(BakeCone, NothingIsInsideAnEmptyCone) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1), either(-1, 1);
    for (const ReliefMap& map : relief_maps(random)) {
        const Image cones = cones_of(map.heights, ConeKind::Empty);
        for (int i = 0; i < 20000; ++i) {
            const double u = unit(random), v = unit(random);
            const double apex = linear_read(map.heights, 0, u, v);
            const double ratio = squared(linear_read(cones, 1, u, v));
            // Half of the others near by, where slopes are steepest.
            const double reach = i % 2 ? 1.2 : 2.5 / cones.width;
            const double du = either(random) * reach,
                         dv = either(random) * (i % 2 ? 1.2 : 2.5 / cones.height);
            const double distance = std::hypot(du, dv);
            const double other = linear_read(map.heights, 0, u + du, v + dv);
            ASSERT_LE((other - apex) * ratio, distance + 1e-9)
                << map.name << " at " << u << ", " << v << " towards " << du << ", " << dv
                << " seed " << seed;
        }
    }
}

TEST(BakeCone, NoRayLeavesTheReliefInsideARelaxedCone) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    int entered = 0;
    std::vector<ReliefMap> maps = relief_maps(random);
    for (const char* maker : {"bricks", "text", "noise", "cobbles"})
        if (const Result<Image> made = make_height_map(maker, 48, 48, 3); made.ok())
            maps.push_back({maker, *made});
    for (const ReliefMap& map : maps) {
        const Image cones = cones_of(map.heights, ConeKind::Relaxed);
        const reference::HeightField field = field_of(map.heights);
        for (int i = 0; i < 2000; ++i) {
            const double u = unit(random), v = unit(random);
            const double apex = linear_read(map.heights, 0, u, v);
            const double ratio = squared(linear_read(cones, 1, u, v));
            const double start = apex + (1 - apex) * unit(random);
            const double angle = 6.2831853 * unit(random);
            // Flatter than the cone's own side: such a ray goes far before it leaves the cone.
            const double reach = ratio * std::exp(4 * unit(random));
            const double t0 = 1 - start, step = ratio * (start - apex) / (reach + ratio);
            const reference::Vec3 view = {std::cos(angle), std::sin(angle), 1};
            const auto inside = [&](double t) {
                return linear_read(map.heights, 0, u - view.x * reach * (t - t0),
                                   v - view.y * reach * (t - t0)) >= 1 - t;
            };
            constexpr int samples = 200;
            for (int k = 1; k < samples; ++k) {
                const double t = t0 + step * k / samples;
                if (!inside(t)) continue;
                ++entered;
                ASSERT_FALSE(reference::leaves_relief(
                    field, {u + view.x * reach * t0, v + view.y * reach * t0}, view, reach, t,
                    t0 + step, 1e-6))
                    << map.name << " at " << u << ", " << v << " from height " << start << " angle "
                    << angle << " reach " << reach << " seed " << seed;
                break;
            }
        }
    }
    EXPECT_GT(entered, 400) << "the cones must let rays in";
}

// What an unhurried bake over texel centres gives, the narrowest of a texel and its neighbours.
double centre_ratio(const Image& heights, int x, int y) {
    double best = widest_cone;
    for (int dy = -heights.height / 2; dy <= heights.height / 2; ++dy)
        for (int dx = -heights.width / 2; dx <= heights.width / 2; ++dx) {
            const int i = (x + dx + heights.width) % heights.width,
                      j = (y + dy + heights.height) % heights.height;
            const double rise = static_cast<double>(heights.at(i, j) - heights.at(x, y));
            if (rise <= 0) continue;
            const double distance = std::hypot(static_cast<double>(dx) / heights.width,
                                               static_cast<double>(dy) / heights.height);
            best = std::min(best, distance / rise);
        }
    return best;
}

TEST(BakeCone, IsNotMuchNarrowerThanItMustBe) {
    for (const char* maker : {"smooth", "bricks", "spikes"}) {
        const Result<Image> heights = make_height_map(maker, 32, 32, 1);
        ASSERT_TRUE(heights.ok());
        const Image empty = cones_of(*heights, ConeKind::Empty),
                    relaxed = cones_of(*heights, ConeKind::Relaxed);
        double sum = 0, bound = 0, wide = 0;
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) {
                double narrowest = widest_cone;
                for (int dy : {31, 0, 1})
                    for (int dx : {31, 0, 1})
                        narrowest = std::min(narrowest,
                                             centre_ratio(*heights, (x + dx) % 32, (y + dy) % 32));
                sum += static_cast<double>(empty.at(x, y, 1));
                wide += static_cast<double>(relaxed.at(x, y, 1));
                bound += std::sqrt(narrowest);
                ASSERT_GE(relaxed.at(x, y, 1), empty.at(x, y, 1)) << maker << x << ", " << y;
            }
        // Never wider than the texel centres allow; the rest is what filtering and bounding cost.
        EXPECT_LE(sum, bound * 1.0001) << maker;
        EXPECT_GE(sum, bound * 0.75) << maker;
        // Where slopes are long there is much that rises without falling again.
        EXPECT_GE(wide, sum * (std::string(maker) == "smooth" ? 1.1 : 1.0)) << maker;
    }
}

TEST(BakeCone, IsTheExactConeOfAPlateau) {
    Image heights = blank_image(64, 64, 1, 16);
    for (int y = 0; y < 64; ++y) heights.at(0, y) = 1;  // a wall
    const Image cones = cones_of(heights, ConeKind::Empty);
    // From 20 texels away the nearest point of the footprint is 19 texels from the summit, and 18
    // from the wall's foot: the slope to the summit is the steepest.
    EXPECT_NEAR(squared(static_cast<double>(cones.at(20, 5, 1))), 19.0 / 64, 0.5 / 64);
    EXPECT_NEAR(squared(static_cast<double>(cones.at(0, 5, 1))), 1.0 / 64, 0.1 / 64);
    const Image flat = cones_of(blank_image(5, 3, 1, 8), ConeKind::Empty);
    EXPECT_EQ(flat.at(2, 2, 1), 1) << "as wide as can be stored";
}

TEST(BakeCone, RefusesWhatIsNoImage) {
    EXPECT_EQ(bake_cone(Image{}, ConeKind::Empty).error().code, "image-malformed");
}

}  // namespace
}  // namespace intaglio::maps

// The bakes with levels, directions and slices, each against its brute-force definition.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/maps/bake_distance.h"
#include "src/maps/bake_horizon.h"
#include "src/maps/bake_max_mip.h"
#include "src/maps/bake_phong.h"
#include "src/maps/bake_summit.h"
#include "src/maps/bake_view_dependent.h"
#include "tests/unit/maps/relief_maps.h"

namespace intaglio::maps {
namespace {

constexpr unsigned seed = 42;

int node_of(double shifted, int size) {
    const double fraction = shifted - std::floor(shifted);
    return std::min(static_cast<int>(fraction * size), size - 1);
}

TEST(BakeMaxMip, EveryNodeHoldsTheSurfaceAboveIt) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const ReliefMap& map : relief_maps(random)) {
        const Result<std::vector<Image>> levels = bake_max_mip(map.heights);
        ASSERT_TRUE(levels.ok());
        ASSERT_EQ(levels->back().width, 1);
        ASSERT_EQ(levels->back().height, 1);
        for (int i = 0; i < 3000; ++i) {
            const double u = unit(random), v = unit(random);
            const double height = linear_read(map.heights, 0, u, v);
            for (const Image& level : *levels) {
                const int x = node_of(u - 0.5 / map.heights.width, level.width),
                          y = node_of(v - 0.5 / map.heights.height, level.height);
                ASSERT_LE(height, static_cast<double>(level.at(x, y, 0)) + 1e-12) << map.name;
                ASSERT_GE(height, static_cast<double>(level.at(x, y, 1)) - 1e-12) << map.name;
            }
        }
        const auto [low, high] =
            std::minmax_element(map.heights.texels.begin(), map.heights.texels.end());
        EXPECT_EQ(levels->back().at(0, 0, 0), *high) << "the top is the highest texel, exactly";
        EXPECT_EQ(levels->back().at(0, 0, 1), *low);
    }
}

TEST(BakeMaxMip, IsExactWhereSizesHalve) {
    std::mt19937 random(seed);
    const Image heights = random_heights(16, 8, 8, false, random);
    const Result<std::vector<Image>> levels = bake_max_mip(heights);
    ASSERT_TRUE(levels.ok());
    ASSERT_EQ(levels->size(), 5u);
    const Image& third = (*levels)[2];
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x) {
            float highest = 0;
            for (int j = 4 * y; j <= 4 * y + 4; ++j)
                for (int i = 4 * x; i <= 4 * x + 4; ++i)
                    highest = std::max(highest, heights.at(i % 16, j % 8));
            EXPECT_EQ(third.at(x, y, 0), highest);
        }
    const Result<Image> file = stacked(*levels);
    ASSERT_TRUE(file.ok());
    EXPECT_EQ(file->height, 8 + 4 + 2 + 1 + 1);
    EXPECT_EQ(file->at(3, 8 + 4 + 1, 0), third.at(3, 1, 0));
}

TEST(BakeSummit, IsTheHighestTexelOfEachSquare) {
    std::mt19937 random(seed);
    for (const ReliefMap& map : relief_maps(random)) {
        const Image& heights = map.heights;
        const Result<std::vector<Image>> levels = bake_summit(heights);
        ASSERT_TRUE(levels.ok());
        std::uniform_int_distribution<int> column(0, heights.width - 1), row(0, heights.height - 1);
        const auto texel = [&](int x, int y) {
            const int w = heights.width, h = heights.height;
            return heights.at((x % w + w) % w, (y % h + h) % h);
        };
        for (int i = 0; i < 40; ++i) {
            const int x = column(random), y = row(random);
            for (int c = 0; c < 4; ++c) {
                const int reach = summit_reach[static_cast<std::size_t>(c)];
                float highest = 0;
                for (int b = y - reach; b <= y + reach + 1; ++b)
                    for (int a = x - reach; a <= x + reach + 1; ++a)
                        highest = std::max(highest, texel(a, b));
                ASSERT_EQ(levels->front().at(x, y, c), highest)
                    << map.name << ", patch " << x << ", " << y << ", reach " << reach;
            }
        }
        const float top = *std::max_element(heights.texels.begin(), heights.texels.end());
        ASSERT_EQ(levels->back().texels, std::vector<float>(4, top)) << map.name;
    }
}

TEST(BakePatch, HoldsTheCornersOfEachPatch) {
    std::mt19937 random(seed);
    for (const ReliefMap& map : relief_maps(random)) {
        const Image& heights = map.heights;
        const Result<Image> patches = bake_patch(heights);
        ASSERT_TRUE(patches.ok());
        for (int y = 0; y < heights.height; ++y)
            for (int x = 0; x < heights.width; ++x)
                for (int c = 0; c < 4; ++c)
                    ASSERT_EQ(patches->at(x, y, c), heights.at((x + c % 2) % heights.width,
                                                               (y + c / 2) % heights.height))
                        << map.name;
    }
}

TEST(BakeHorizon, AgreesWithAWalk) {
    std::mt19937 random(seed);
    for (const ReliefMap& map : relief_maps(random)) {
        const Result<std::vector<Image>> images = bake_horizon(map.heights, 8);
        ASSERT_TRUE(images.ok());
        ASSERT_EQ(images->size(), 2u);
        std::uniform_int_distribution<int> column(0, map.heights.width - 1),
            row(0, map.heights.height - 1), azimuth(0, 7);
        const double steps = map.heights.bits == 8 ? 255 : 65535;
        for (int i = 0; i < 40; ++i) {
            const int x = column(random), y = row(random), k = azimuth(random);
            const double u = (x + 0.5) / map.heights.width, v = (y + 0.5) / map.heights.height;
            const double angle = k * std::acos(-1.0) / 4;
            const double eye = static_cast<double>(map.heights.at(x, y));
            double steepest = 0;
            constexpr int samples = 30000;
            for (int s = 1; s <= samples; ++s) {
                const double r = 1.5 * s / samples;
                const double height =
                    linear_read(map.heights, 0, u + std::cos(angle) * r, v + std::sin(angle) * r);
                steepest = std::max(steepest, (height - eye) / r);
            }
            const double expected = steepest / (steepest + horizon_middle);
            const double value =
                static_cast<double>((*images)[static_cast<std::size_t>(k % 2)].at(x, y, k / 2));
            // The walk's samples lie up to 5e-5 from the steepest point: one part in a hundred of
            // the slope on the first texel of the finest map.
            ASSERT_NEAR(value, expected, 0.5 / steps + 2.5e-3)
                << map.name << " " << x << ", " << y << " azimuth " << k << " seed " << seed;
        }
    }
}

TEST(BakeHorizon, OrdersItsChannelsByQuarterTurns) {
    Image heights = blank_image(16, 16, 1, 16);
    heights.at(10, 8) = 1;
    const Result<std::vector<Image>> images = bake_horizon(heights, 8);
    ASSERT_TRUE(images.ok());
    const double slope = 1 / (2.0 / 16);
    EXPECT_NEAR((*images)[0].at(8, 8, 0), slope / (slope + horizon_middle), 1e-4) << "+u";
    EXPECT_NEAR((*images)[0].at(10, 6, 1), slope / (slope + horizon_middle), 1e-4) << "+v";
    EXPECT_NEAR((*images)[0].at(12, 8, 2), slope / (slope + horizon_middle), 1e-4) << "-u";
    EXPECT_EQ((*images)[0].at(8, 7, 0), 0) << "beside the spike's row";
    const double diagonal = slope / std::sqrt(2.0);
    EXPECT_NEAR((*images)[1].at(8, 6, 0), diagonal / (diagonal + horizon_middle), 1e-4) << "+u +v";
    EXPECT_EQ(bake_horizon(heights, 6).error().code, "azimuths-range");
}

TEST(BakeDistance, BallsAreEmpty) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1), either(-1, 1);
    for (const ReliefMap& map : relief_maps(random)) {
        const Result<Volume> volume = bake_distance(map.heights, 16, 256, 9);
        ASSERT_TRUE(volume.ok()) << to_string(volume.error());
        const int columns = volume->slices.width, rows = volume->height();
        for (int i = 0; i < 20000; ++i) {
            const double u = unit(random), v = unit(random), height = unit(random);
            const int slice = static_cast<int>(height * 8 + 0.5);
            const double radius =
                static_cast<double>(volume->at(node_of(u, columns), node_of(v, rows), slice)) *
                distance_depth;
            if (linear_read(map.heights, 0, u, v) > height) {
                ASSERT_EQ(radius, 0) << "inside the relief";
                continue;
            }
            double du = either(random), dv = either(random), dz = either(random);
            const double shrink = radius / std::max(std::hypot(du, dv, dz), 1e-6);
            du *= shrink;
            dv *= shrink;
            dz *= shrink / distance_depth;
            ASSERT_LE(linear_read(map.heights, 0, u + du, v + dv), height + dz + 1e-9)
                << map.name << " at " << u << ", " << v << ", " << height << " seed " << seed;
        }
    }
}

TEST(BakeDistance, IsTheDistance) {
    const Result<Volume> flat = bake_distance(blank_image(8, 8, 1, 16), 256, 256, 5);
    ASSERT_TRUE(flat.ok());
    for (int slice = 0; slice < 5; ++slice)
        EXPECT_NEAR(flat->at(3, 3, slice), std::max(0.0, (slice - 0.5) / 4), 1e-4);
    Image wall = blank_image(64, 64, 1, 16);
    for (int y = 0; y < 64; ++y) wall.at(0, y) = 1;
    const Result<Volume> beside = bake_distance(wall, 256, 256, 17);
    ASSERT_TRUE(beside.ok());
    // Voxel 5 begins 5 texels from the wall's voxel 0 edge, whose patch reaches to 1 texel past it:
    // the columns up to voxel 1 are as high as the wall's slope.
    EXPECT_NEAR(beside->at(5, 9, 15) * static_cast<float>(distance_depth), 3.0f / 64, 1e-3f);
    EXPECT_EQ(bake_distance(wall, 256, 256, 1).error().code, "slices-range");
}

TEST(BakeViewDependent, IsTheReferencesFirstHit) {
    std::mt19937 random(seed);
    constexpr int views = 5, cells = views - 1;
    for (const ReliefMap& map : relief_maps(random)) {
        const Result<Volume> volume = bake_view_dependent(map.heights, 8, 256, views);
        ASSERT_TRUE(volume.ok()) << to_string(volume.error());
        const reference::HeightField field = field_of(map.heights);
        const int columns = volume->slices.width, rows = volume->height();
        std::uniform_int_distribution<int> column(0, columns - 1), row(0, rows - 1),
            cell(0, cells - 1), corner(0, 3);
        const double steps = map.heights.bits == 8 ? 255 : 65535;
        for (int i = 0; i < 400; ++i) {
            const int x = column(random), y = row(random), a = cell(random), b = cell(random),
                      c = corner(random);
            const double dx = 2.0 * (a + (c & 1)) / cells - 1,
                         dy = 2.0 * (b + (c >> 1)) / cells - 1;
            const double length = std::hypot(dx, dy), kept = std::min(length, widest_view);
            const double reach = view_middle * kept / (1 - kept);
            const reference::Vec3 view = {length > 0 ? dx / length : 0,
                                          length > 0 ? dy / length : 0, 1};
            const reference::Hit hit =
                reference::first_hit(field, {(x + 0.5) / columns, (y + 0.5) / rows}, view, reach);
            ASSERT_TRUE(hit.found);
            // A ray that touches a summit within rounding may pass it: such rays are none here.
            ASSERT_NEAR(static_cast<double>(volume->at(x, y, b * cells + a, c)), hit.t,
                        0.5 / steps + 1e-7)
                << map.name << " texel " << x << ", " << y << " direction " << dx << ", " << dy
                << " seed " << seed;
        }
    }
}

TEST(BakePhong, IsAHemisphere) {
    const Result<Image> map = bake_phong(16, 64);
    ASSERT_TRUE(map.ok());
    EXPECT_GT(map->at(32, 32, 0), 0.99f);
    for (int i = 0; i < 64; ++i)
        for (int c : {0, 1}) {
            EXPECT_EQ(map->at(i, 0, c), 0);
            EXPECT_EQ(map->at(63, i, c), 0);
            EXPECT_EQ(map->at(i, 20, c), map->at(63 - i, 20, c));
            EXPECT_EQ(map->at(i, 20, c), map->at(20, i, c));
        }
    const double offset = (40.5 / 32 - 1) * phong_edge, cosine = std::sqrt(1 - offset * offset);
    const double across = (32.5 / 32 - 1) * phong_edge;
    EXPECT_NEAR(map->at(40, 32, 0), std::sqrt(1 - offset * offset - across * across), 0.5 / 255);
    EXPECT_NEAR(map->at(40, 32, 1), std::pow(cosine, 16), 0.02);
    EXPECT_EQ(bake_phong(0, 64).error().code, "shininess-range");
    EXPECT_EQ(bake_phong(16, 8).error().code, "image-size");
}

}  // namespace
}  // namespace intaglio::maps

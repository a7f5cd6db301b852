// What is measured, without a device: directions, maps as textures, and how a reported hit is
// judged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "src/measure/hits.h"
#include "src/measure/map_set.h"
#include "src/measure/view.h"

namespace intaglio::measure {
namespace {

TEST(Direction, IsAUnitVector) {
    EXPECT_THAT(vector_of({90, 77}), testing::ElementsAre(0, 0, 1))
        << "straight down exactly, whatever the azimuth";
    EXPECT_THAT(vector_of({0, 0}), testing::ElementsAre(1, 0, 0));
    EXPECT_THAT(vector_of({0, 90}), testing::ElementsAre(0, 1, 0)) << "no 6e-17 along u";
    EXPECT_LT(vector_of({-10, 0})[2], 0);
    for (double elevation : {1.0, 30.0, 60.0, 89.9}) {
        const auto v = vector_of({elevation, 123});
        EXPECT_NEAR(std::hypot(v[0], v[1], v[2]), 1, 1e-6);
    }
}

TEST(MapSet, TexturesHoldWhatTheMapHolds) {
    const Result<MapSet> set = make_map_set("bricks", 32, 16, 0.1);
    ASSERT_TRUE(set.ok());
    const vulkan::Texture height = height_texture(*set, Filtering::Float);
    EXPECT_EQ(height.levels.size(), 6u) << "32 x 16 down to 1 x 1";
    EXPECT_EQ(height.levels[0][4 * (3 * 32 + 5)], set->heights.at(5, 3));
    EXPECT_EQ(normal_texture(*set, Filtering::Float).levels[0][4 * (3 * 32 + 5) + 3],
              set->heights.at(5, 3))
        << "height in alpha";
    EXPECT_EQ(height_texture(*set, Filtering::Native).format, vulkan::Texture::Format::Rgba16Unorm)
        << "procedural maps have 16 bits";
    EXPECT_EQ(set->height_field(reference::FilterWeights::Exact).heights.size(), 32u * 16u);
    EXPECT_EQ(make_map_set("brcks", 8, 8, 0.1).error().code, "unknown-map");
}

// A picture that reports, for every pixel, the exact hit moved along the ray by `shift` of the
// ray's length.
struct Reported {
    reference::HeightField field;
    ExactPicture exact;
    vulkan::Picture picture;
};

constexpr Direction view{35, 25}, light{40, 130};
constexpr float scale = 0.15f;
constexpr int size = 32;

Reported report(const std::string& maker, double shift) {
    Reported made;
    made.field = make_map_set(maker, 64, 64, scale)->height_field(reference::FilterWeights::Exact);
    made.exact = trace_exact(made.field, view, light, scale, size, size);
    const reference::Vec3 v = exact_vector(vector_of(view));
    made.picture.width = made.picture.height = size;
    for (std::size_t i = 0; i < made.exact.hits.size(); ++i) {
        const reference::Hit& hit = made.exact.hits[i];
        const double extra = std::clamp(hit.t + shift, 0.0, 1.0) - hit.t;
        made.picture.pixels.push_back({static_cast<float>(hit.uv.x - v.x / v.z * scale * extra),
                                       static_cast<float>(hit.uv.y - v.y / v.z * scale * extra),
                                       static_cast<float>(hit.height - extra),
                                       made.exact.lit[i] ? 1.0f : 0.0f});
    }
    return made;
}

HitStatistics judge(const Reported& reported) {
    return summarize(compare_hits(reported.picture, reported.exact, reported.field, view, scale),
                     size);
}

TEST(Hits, TheExactPictureHasNoError) {
    const HitStatistics hits = judge(report("cobbles", 0));
    EXPECT_LT(hits.max, 1e-4) << "rounding of the coordinate to float";
    EXPECT_EQ(hits.missed, 0);
    EXPECT_EQ(hits.invalid, 0);
    EXPECT_EQ(hits.shadow_wrong, 0);
    EXPECT_EQ(hits.pixels, size * size);
}

TEST(Hits, AShiftAlongTheRayIsSeenAtItsLength) {
    const reference::Vec3 v = exact_vector(vector_of(view));
    const double texels_per_t = std::hypot(v.x, v.y) / v.z * scale * 64;
    const HitStatistics hits = judge(report("flat0", -0.01));
    EXPECT_NEAR(hits.median, 0.01 * texels_per_t, 1e-3);
    EXPECT_NEAR(hits.height_median, 0.01, 1e-5);
}

TEST(Hits, OnlyGoingThroughAFeatureIsAMiss) {
    EXPECT_EQ(judge(report("spikes", -0.2)).missed, 0) << "too early is imprecise, not a miss";
    EXPECT_GT(judge(report("spikes", 0.4)).missed, 10) << "behind a spike";
    EXPECT_EQ(judge(report("flat0", 0.4)).missed, 0) << "inside the floor the ray leaves nothing";
}

TEST(Hits, NaNIsCountedApart) {
    Reported reported = report("cobbles", 0);
    reported.picture.pixels[3][2] = std::numeric_limits<float>::quiet_NaN();
    reported.picture.pixels[7][3] = std::numeric_limits<float>::infinity();
    const HitStatistics hits = judge(reported);
    EXPECT_EQ(hits.invalid, 2);
    EXPECT_LT(hits.max, 1e-4) << "the others are judged without them";
}

TEST(Hits, AWrongShadowIsCountedWhereTheHitIsRight) {
    Reported reported = report("bricks", 0);
    for (auto& pixel : reported.picture.pixels) pixel[3] = 1 - pixel[3];
    EXPECT_EQ(judge(reported).shadow_wrong, size * size);
    for (auto& pixel : reported.picture.pixels) pixel[0] += 2.0f / 64;
    EXPECT_EQ(judge(reported).shadow_wrong, 0) << "two texels off: another point's shadow";
}

TEST(Hits, TheWorstPixelIsNamed) {
    Reported reported = report("cobbles", 0);
    reported.picture.pixels[5 * size + 9][0] += 0.25f;
    const HitStatistics hits = judge(reported);
    EXPECT_EQ(hits.worst_x, 9);
    EXPECT_EQ(hits.worst_y, 5);
    EXPECT_NEAR(hits.max, 0.25 * 64, 1e-3);
    EXPECT_LT(hits.p99, 1e-3) << "one pixel of 1024";
}

}  // namespace
}  // namespace intaglio::measure

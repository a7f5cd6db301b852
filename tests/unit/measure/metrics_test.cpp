// Swim and the split of errors, on hits made up so that the answer is known.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "src/measure/metrics.h"

namespace intaglio::measure {
namespace {

constexpr int size = 16, texels = 64;

// Exact hits at each pixel's own place, moved.
ExactPicture exact_at(double du, double dv) {
    ExactPicture exact{size, size, {}, std::vector<bool>(size * size)};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            exact.hits.push_back({true, 0.5, {(x + 0.5) / size + du, (y + 0.5) / size + dv}, 0.5});
    return exact;
}

vulkan::Picture reported(const ExactPicture& exact, double du, double dv) {
    vulkan::Picture picture{size, size, {}};
    for (const reference::Hit& hit : exact.hits)
        picture.pixels.push_back(
            {static_cast<float>(hit.uv.x + du), static_cast<float>(hit.uv.y + dv), 0.5f, 1.0f});
    return picture;
}

TEST(MovedView, StaysAboveTheHorizon) {
    EXPECT_EQ(moved_view({90, 20}).elevation, 89.9);
    EXPECT_GT(moved_view({0.1, 20}).elevation, 0.1);
    EXPECT_GT(moved_view({0.05, 20}).elevation, 0);
    EXPECT_EQ(moved_view({30, 20}).azimuth, 20);
}

TEST(Swim, OfAConstantErrorIsNothing) {
    const ExactPicture before = exact_at(0, 0), after = exact_at(0.01, 0.02);
    const Swim swim =
        swim_of(reported(before, 0.1, 0), reported(after, 0.1, 0), before, after, texels, texels);
    EXPECT_NEAR(swim.max, 0, 1e-4);
    EXPECT_EQ(swim.pixels, size * size);
}

TEST(Swim, IsHowMuchTheErrorChanges) {
    const ExactPicture before = exact_at(0, 0), after = exact_at(0.01, 0);
    vulkan::Picture moved = reported(after, 3.0 / texels, 4.0 / texels);
    moved.pixels[40][0] += 0.5f;
    moved.pixels[41][0] = std::numeric_limits<float>::infinity();
    const Swim swim = swim_of(reported(before, 0, 0), moved, before, after, texels, texels);
    EXPECT_NEAR(swim.median, 5, 1e-3);
    EXPECT_NEAR(swim.p95, 5, 1e-3);
    EXPECT_NEAR(swim.max, std::hypot(3 + 0.5 * texels, 4), 1e-3);
    EXPECT_EQ(swim.worst_y * size + swim.worst_x, 40);
    EXPECT_EQ(swim.pixels, size * size - 1);
}

Hits moved(const Hits& hits, double du, double dv) {
    Hits result = hits;
    for (auto& hit : result) {
        hit[0] += du / texels;
        hit[1] += dv / texels;
    }
    return result;
}

Hits hits_of(const ExactPicture& exact) {
    Hits hits;
    for (const reference::Hit& hit : exact.hits) hits.push_back({hit.uv.x, hit.uv.y, 0.5, 1});
    return hits;
}

TEST(ErrorSplit, PartsAlongOneLineAreWhatTheyAre) {
    const ExactPicture exact = exact_at(0, 0);
    const Hits right = hits_of(exact), technique = moved(right, 2, 0);
    // The filter works against the technique, and with the arithmetic it does half a texel more: a
    // quarter for each.
    const ErrorSplit split =
        split_error({technique, moved(technique, -0.5, 0), moved(technique, 0.25, 0),
                     moved(technique, -0.25 + 0.5, 0)},
                    exact, texels, texels);
    EXPECT_NEAR(split.total, 2.25, 1e-9);
    EXPECT_NEAR(split.technique, 2, 1e-9);
    EXPECT_NEAR(split.filter, -0.5 + 0.25, 1e-9);
    EXPECT_NEAR(split.arithmetic, 0.25 + 0.25, 1e-9);
    EXPECT_NEAR(split.interaction, 0.5, 1e-9);
    EXPECT_NEAR(split.filter_alone, 0.5, 1e-9);
    EXPECT_EQ(split.rays, size * size);
}

TEST(ErrorSplit, APartAcrossTheErrorAddsNothingToItsLength) {
    const ExactPicture exact = exact_at(0, 0);
    const Hits technique = moved(hits_of(exact), 3, 0), filter = moved(technique, 0, 4);
    const ErrorSplit split =
        split_error({technique, filter, technique, filter}, exact, texels, texels);
    EXPECT_NEAR(split.total, 5, 1e-9);
    EXPECT_NEAR(split.technique, 3 * 3.0 / 5, 1e-9) << "the part of it along the whole";
    EXPECT_NEAR(split.filter, 4 * 4.0 / 5, 1e-9);
    EXPECT_NEAR(split.interaction, 0, 1e-9);
}

TEST(ErrorSplit, AddsUpWhateverTheHits) {
    std::mt19937 dice(7);
    std::normal_distribution<double> number;
    const ExactPicture exact = exact_at(0, 0);
    SplitHits hits;
    for (Hits* each : {&hits.technique, &hits.filter, &hits.arithmetic, &hits.total}) {
        *each = hits_of(exact);
        for (auto& hit : *each) {
            hit[0] += 0.01 * number(dice);
            hit[1] += 0.01 * number(dice);
        }
    }
    hits.filter[3][0] = std::numeric_limits<double>::quiet_NaN();
    const ErrorSplit split = split_error(hits, exact, texels, texels);
    EXPECT_EQ(split.invalid, 1);
    EXPECT_EQ(split.rays, size * size - 1);
    EXPECT_NEAR(split.total, split.technique + split.filter + split.arithmetic, 1e-12);
    EXPECT_GT(split.total, 0);
}

}  // namespace
}  // namespace intaglio::measure

// Whether a ray that has reached the relief rises out of it again: against dense sampling, and on a
// wall.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "src/reference/trace.h"

namespace intaglio::reference {
namespace {

TEST(LeavesRelief, OnlyBehindAWall) {
    // One wall of height 1 and one texel wide on a floor at 0: the ray enters it, and leaves it on
    // the other side.
    HeightField field{64, 1, std::vector<double>(64, 0.0)};
    field.heights[20] = 1;
    const Vec3 view{-1, 0, 1};  // the ray travels towards +u
    const double scale = 0.5;   // 32 texels from top to bottom
    const Vec2 uv{12.5 / 64, 0.5};
    const Hit hit = first_hit(field, uv, view, scale);
    ASSERT_TRUE(hit.found);
    EXPECT_NEAR(hit.uv.x * 64, 20, 1);
    EXPECT_TRUE(leaves_relief(field, uv, view, scale, hit.t, 1)) << "the floor behind the wall";
    EXPECT_FALSE(leaves_relief(field, uv, view, scale, hit.t, hit.t + 0.01))
        << "still inside the wall";
    EXPECT_FALSE(leaves_relief(field, uv, view, scale, hit.t, hit.t)) << "nothing in between";
    EXPECT_FALSE(leaves_relief(field, uv, {-1, 0, -1}, scale, 0, 1)) << "no answer from below";
}

TEST(LeavesRelief, AgreesWithDenseSampling) {
    constexpr unsigned seed = 20251122;
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    int left = 0, stayed = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const int width = 1 + static_cast<int>(random() % 12),
                  height = 1 + static_cast<int>(random() % 12);
        HeightField field{width, height,
                          std::vector<double>(static_cast<std::size_t>(width * height))};
        for (double& texel : field.heights) texel = unit(random);
        const Vec2 uv{unit(random) * 3, unit(random) * 3};
        const Vec3 view{unit(random) * 2 - 1, unit(random) * 2 - 1, unit(random) + 0.05};
        const double scale = unit(random) * 0.4;
        const Hit hit = first_hit(field, uv, view, scale);
        ASSERT_TRUE(hit.found);
        const double end = hit.t + (1 - hit.t) * unit(random);
        const double tolerance = 0.5 / 255;
        // The least gap that sampling sees is above the true least by no more than a sample's step
        // times the slope.
        double least = 1;
        for (int i = 0; i <= 4000; ++i) {
            const double t = hit.t + (end - hit.t) * i / 4000;
            const Vec2 at{uv.x - view.x / view.z * scale * t, uv.y - view.y / view.z * scale * t};
            least = std::min(least, height_at(field, at) - (1 - t));
        }
        const bool leaves = leaves_relief(field, uv, view, scale, hit.t, end, tolerance);
        if (least < -tolerance) {
            EXPECT_TRUE(leaves) << "trial " << trial << " least gap " << least;
        }
        if (least > -tolerance + 0.01) {
            EXPECT_FALSE(leaves) << "trial " << trial << " least gap " << least;
        }
        (leaves ? left : stayed)++;
    }
    EXPECT_GT(left, 300);
    EXPECT_GT(stayed, 300);
}

}  // namespace
}  // namespace intaglio::reference

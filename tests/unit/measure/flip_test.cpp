// FLIP against what its definition gives for plain pictures, and its properties; PSNR against its
// formula.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "src/measure/flip.h"

namespace intaglio::measure {
namespace {

using Pixel = std::array<float, 4>;
constexpr int size = 48;

vulkan::Picture plain(Pixel colour) {
    return {size, size, std::vector<Pixel>(size * size, colour)};
}

double mean(const std::vector<float>& map) {
    return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

double flip(const vulkan::Picture& a, const vulkan::Picture& b) { return mean(flip_map(a, b)); }

constexpr Pixel black{0, 0, 0, 1}, white{1, 1, 1, 1}, green{0, 1, 0, 1}, blue{0, 0, 1, 1};

TEST(Flip, PlainPicturesAreTheDistanceOfTheirColours) {
    EXPECT_NEAR(flip(plain(green), plain(blue)), 1, 1e-6) << "the largest distance there is";
    // Black and white are 100 apart in HyAB; green and blue, by the paper's appendix' formulas,
    // 203.38 after the Hunt effect.
    const double largest = std::pow(203.38, 0.7), distance = std::pow(100.0, 0.7);
    const double expected = 0.95 + (distance - 0.4 * largest) / (0.6 * largest) * 0.05;
    EXPECT_NEAR(flip(plain(black), plain(white)), expected, 1e-3);
    for (const float value : flip_map(plain(black), plain(white)))
        EXPECT_NEAR(value, expected, 1e-3) << "the same everywhere, edges included";
}

vulkan::Picture noise(unsigned seed) {
    std::mt19937 dice(seed);
    std::uniform_real_distribution<float> number(0, 1);
    vulkan::Picture picture = plain(black);
    for (Pixel& pixel : picture.pixels) pixel = {number(dice), number(dice), number(dice), 1};
    return picture;
}

TEST(Flip, IsADifference) {
    const vulkan::Picture a = noise(1), b = noise(2);
    EXPECT_EQ(mean(flip_map(a, a)), 0);
    EXPECT_EQ(flip_map(a, b), flip_map(b, a));
    for (const float value : flip_map(a, b)) {
        EXPECT_GE(value, 0);
        EXPECT_LE(value, 1);
    }
}

TEST(Flip, GrowsWithAShiftOfColour) {
    const vulkan::Picture base = plain({0.3f, 0.3f, 0.3f, 1});
    double before = 0;
    for (float shift : {0.01f, 0.05f, 0.1f, 0.2f, 0.4f, 0.7f}) {
        const double now = flip(base, plain({0.3f + shift, 0.3f, 0.3f, 1}));
        EXPECT_GT(now, before) << shift;
        before = now;
    }
}

TEST(Flip, AnEdgeIsSeenMoreThanASlowChange) {
    // The same greatest change of brightness, once as an edge and once as a ramp.
    vulkan::Picture base = plain({0.5f, 0.5f, 0.5f, 1}), edge = base, ramp = base;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const auto i = static_cast<std::size_t>(y * size + x);
            const float step = x >= size / 2 ? 0.6f : 0.5f;
            const float slow = 0.5f + 0.1f * static_cast<float>(x) / (size - 1);
            edge.pixels[i] = {step, step, step, 1};
            ramp.pixels[i] = {slow, slow, slow, 1};
        }
    const std::vector<float> edges = flip_map(base, edge), ramps = flip_map(base, ramp);
    EXPECT_GT(*std::max_element(edges.begin(), edges.end()),
              1.2f * *std::max_element(ramps.begin(), ramps.end()));
}

TEST(Flip, FineNoiseIsSeenLessFromFarAway) {
    const vulkan::Picture grey = plain({0.5f, 0.5f, 0.5f, 1}), fine = noise(3);
    EXPECT_LT(mean(flip_map(grey, fine, 200)), mean(flip_map(grey, fine, 20)));
}

TEST(Flip, ClampsAsAScreenDoesAndCountsNaN) {
    EXPECT_EQ(flip(plain(white), plain({7, 1.5f, 1, 0})), 0) << "brighter than white is white";
    vulkan::Picture broken = plain(white);
    broken.pixels[100][1] = std::numeric_limits<float>::quiet_NaN();
    const PictureError error = compare_pictures(plain(white), broken);
    EXPECT_EQ(error.invalid, 1);
    EXPECT_EQ(error.flip_worst_y * size + error.flip_worst_x, 100);
    EXPECT_TRUE(std::isfinite(error.flip_mean));
    EXPECT_TRUE(std::isfinite(error.psnr));
}

TEST(Psnr, IsThatOfTheDefinition) {
    // Black against the linear value whose sRGB code is 0.5, at one pixel of all.
    vulkan::Picture other = plain(black);
    const float half = static_cast<float>(std::pow((0.5 + 0.055) / 1.055, 2.4));
    other.pixels[7] = {half, half, half, 1};
    EXPECT_NEAR(compare_pictures(plain(black), other).psnr, -10 * std::log10(0.25 / (size * size)),
                1e-4);
    EXPECT_TRUE(std::isinf(compare_pictures(plain(black), plain(black)).psnr));
}

}  // namespace
}  // namespace intaglio::measure

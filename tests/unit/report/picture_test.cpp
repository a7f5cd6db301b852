// Renders and error maps as colours.
#include "src/report/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace intaglio::report {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Rgb pixel_of(const maps::Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// Rec. 709 luminance of a display-ready colour.
double brightness(Rgb colour) {
    const auto linear = [](float x) {
        return x <= 0.04045f ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
}

TEST(Picture, HasTheCurveOfSrgb) {
    const vulkan::Picture picture{
        2, 2, {{0, 1, 0.5f, 1}, {-3, 7, 0.001f, 0}, {0.0031308f, 0.2158605f, 1, 1}, {0, 0, 0, 0}}};
    const maps::Image image = to_image(picture);
    ASSERT_TRUE(maps::check_image(image).ok());
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(image.bits, 8);
    EXPECT_EQ(pixel_of(image, 0, 0)[0], 0);
    EXPECT_FLOAT_EQ(pixel_of(image, 0, 0)[1], 1);
    EXPECT_NEAR(pixel_of(image, 0, 0)[2], 0.735357f,
                1e-6f);                      // IEC 61966-2-1, to float's rounding of the power
    EXPECT_EQ(pixel_of(image, 1, 0)[0], 0);  // clamped below
    EXPECT_FLOAT_EQ(pixel_of(image, 1, 0)[1], 1);  // and above
    EXPECT_FLOAT_EQ(pixel_of(image, 1, 0)[2], 0.01292f);
    EXPECT_NEAR(pixel_of(image, 0, 1)[1], 128 / 255.0f,
                1e-3f);  // the grey that is half the stored range
}

TEST(Picture, NanAndInfinityAreMagentaInWhateverChannelTheyAre) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
        for (float bad : {nan, infinity, -infinity}) {
            vulkan::Picture picture{2, 1, {{0.5f, 0.5f, 0.5f, 1}, {0.5f, 0.5f, 0.5f, 1}}};
            picture.pixels[1][channel] = bad;
            const maps::Image image = to_image(picture);
            EXPECT_EQ(pixel_of(image, 1, 0), invalid_colour);
            EXPECT_NE(pixel_of(image, 0, 0), invalid_colour);
        }
    }
}

TEST(ErrorMap, GrowsInBrightnessWithTheError) {
    double before = -1;
    for (int step = 0; step <= 1000; ++step) {
        const float error =
            least_error * std::pow(most_error / least_error, static_cast<float>(step) / 1000);
        const double now = brightness(error_colour(error));
        EXPECT_GT(now, before) << error;
        before = now;
    }
}

// A step of one decade is as visible everywhere: the scale is logarithmic, not linear.
TEST(ErrorMap, IsLogarithmic) {
    const float middle = std::sqrt(least_error * most_error);
    const Rgb colour = error_colour(middle);
    EXPECT_NEAR(colour[0], 0.736f, 1e-3f);  // the middle stop of the map
    EXPECT_NEAR(colour[1], 0.216f, 1e-3f);
}

TEST(ErrorMap, EndsHoldBeyondTheScale) {
    EXPECT_EQ(error_colour(0), error_colour(least_error));
    EXPECT_EQ(error_colour(1e9f), error_colour(most_error));
    EXPECT_EQ(error_colour(infinity), error_colour(most_error));
    EXPECT_EQ(error_colour(nan), error_colour(least_error));
}

// No error looks like a miss or a NaN, in colour or, for those who see none, by more than chance.
TEST(ErrorMap, MissesAndNanAreOutsideTheColours) {
    for (int step = 0; step <= 1000; ++step) {
        const Rgb colour = error_colour(
            least_error * std::pow(most_error / least_error, static_cast<float>(step) / 1000));
        for (const Rgb& mark : {missed_colour, invalid_colour}) {
            double distance = 0;
            for (std::size_t c = 0; c < 3; ++c) distance += std::pow(mark[c] - colour[c], 2);
            EXPECT_GT(std::sqrt(distance), 0.4);
        }
    }
    EXPECT_GT(brightness(missed_colour), 2 * brightness(invalid_colour));
}

TEST(ErrorMap, ShowsEveryPixelAndAStrip) {
    std::vector<measure::HitError> errors(6);
    errors[1].texels = 1;
    errors[2].texels = 5;
    errors[2].missed = true;
    errors[3].texels = infinity;
    errors[3].invalid = true;
    errors[5].texels = 32;
    const maps::Image image = error_map(errors, 3);
    ASSERT_TRUE(maps::check_image(image).ok());
    EXPECT_EQ(image.width, 3 + error_strip_width);
    EXPECT_EQ(image.height, least_map_height);
    EXPECT_EQ(pixel_of(image, 0, 0), error_colour(0));
    EXPECT_EQ(pixel_of(image, 1, 0), error_colour(1));
    EXPECT_EQ(pixel_of(image, 2, 0), missed_colour);
    EXPECT_EQ(pixel_of(image, 0, 1), invalid_colour);
    EXPECT_EQ(pixel_of(image, 2, 1), error_colour(32));
}

// Down the middle of the strip the brightness falls from the most to the least.
TEST(ErrorMap, TheStripRunsFromMostToLeast) {
    const maps::Image image = error_map(std::vector<measure::HitError>(256 * 256), 256);
    EXPECT_EQ(image.height, 256);
    const int x = 256 + 12;
    int top = 0;
    while (top < image.height && pixel_of(image, x, top) != error_colour(most_error)) ++top;
    ASSERT_LT(top, image.height);
    int y = top + 1;
    for (; y < image.height && pixel_of(image, x, y) != pixel_of(image, 256 + 2, 0); ++y)
        EXPECT_LT(brightness(pixel_of(image, x, y)), brightness(pixel_of(image, x, y - 1))) << y;
    EXPECT_GT(y - top, 150);
    const Rgb last = pixel_of(image, x, y - 1);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(last[c], error_colour(least_error)[c], 1e-4f);  // two roundings of log
}

}  // namespace
}  // namespace intaglio::report

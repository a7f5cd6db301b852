// Height channels, combination with normals, mip levels.
#include "src/maps/image.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace intaglio::maps {
namespace {

constexpr unsigned seed = 7;

Image random_image(int width, int height, int channels, std::mt19937& random) {
    Image image = blank_image(width, height, channels, 8);
    for (float& texel : image.texels) texel = static_cast<float>(random() & 255) / 255.0f;
    return image;
}

double mean(const Image& image, int channel) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) sum += image.at(x, y, channel);
    }
    return sum / image.width / image.height;
}

TEST(HeightsOf, AutomaticTakesAlphaWhereItSaysSomething) {
    std::mt19937 random(seed);
    for (const int channels : {2, 4}) {
        Image image = random_image(4, 3, channels, random);
        Result<Image> heights = heights_of(image, HeightSource::Automatic);
        ASSERT_TRUE(heights.ok());
        EXPECT_EQ(heights->channels, 1);
        EXPECT_EQ(heights->bits, image.bits);
        EXPECT_EQ(heights->at(2, 1), image.at(2, 1, channels - 1));
        EXPECT_EQ(*heights, *heights_of(image, HeightSource::Alpha));

        for (int i = 0; i < 12; ++i) image.at(i % 4, i / 4, channels - 1) = 0.25f;
        EXPECT_EQ(*heights_of(image, HeightSource::Automatic),
                  *heights_of(image, HeightSource::Red));
        EXPECT_EQ(heights_of(image, HeightSource::Red)->at(2, 1), image.at(2, 1, 0));
    }
}

TEST(HeightsOf, AutomaticTakesTheFirstChannelWhereThereIsNoAlpha) {
    std::mt19937 random(seed);
    for (const int channels : {1, 3}) {
        const Image image = random_image(4, 3, channels, random);
        EXPECT_EQ(heights_of(image, HeightSource::Automatic)->at(3, 2), image.at(3, 2, 0));
    }
}

TEST(HeightsOf, LuminanceOfGrayIsTheGray) {
    std::mt19937 random(seed);
    const Image gray = random_image(5, 5, 1, random);
    EXPECT_EQ(*heights_of(gray, HeightSource::Luminance), gray);
    Image rgb = blank_image(5, 5, 3, 8);
    for (int i = 0; i < 25; ++i) {
        for (int c = 0; c < 3; ++c) rgb.at(i % 5, i / 5, c) = gray.at(i % 5, i / 5);
    }
    const Image heights = *heights_of(rgb, HeightSource::Luminance);
    for (std::size_t i = 0; i < 25; ++i) {
        EXPECT_FLOAT_EQ(heights.texels[i],
                        gray.texels[i]);  // the weights sum to 1 but for rounding
    }
    // Green is the brightest primary, blue the darkest.
    Image primaries = blank_image(3, 1, 3, 8);
    for (int c = 0; c < 3; ++c) primaries.at(c, 0, c) = 1.0f;
    const Image weights = *heights_of(primaries, HeightSource::Luminance);
    EXPECT_GT(weights.at(1, 0), weights.at(0, 0));
    EXPECT_GT(weights.at(0, 0), weights.at(2, 0));
}

TEST(HeightsOf, AlphaThatIsNotThereIsRefused) {
    for (const int channels : {1, 3}) {
        const Result<Image> heights =
            heights_of(blank_image(2, 2, channels, 8), HeightSource::Alpha);
        ASSERT_FALSE(heights.ok());
        EXPECT_EQ(heights.error().code, "no-alpha");
    }
}

TEST(WithHeightInAlpha, KeepsBothAndTheFinerPrecision) {
    std::mt19937 random(seed);
    const Image normals = random_image(6, 2, 3, random);
    Image heights = random_image(6, 2, 1, random);
    heights.bits = 16;
    const Result<Image> both = with_height_in_alpha(normals, heights);
    ASSERT_TRUE(both.ok());
    EXPECT_EQ(both->bits, 16);
    EXPECT_EQ(*heights_of(*both, HeightSource::Alpha), heights);
    EXPECT_EQ(both->at(5, 1, 1), normals.at(5, 1, 1));
    // Replacing the alpha of what already has one changes only that.
    EXPECT_EQ(*with_height_in_alpha(*both, heights), *both);
}

TEST(WithHeightInAlpha, RefusesWhatDoesNotFit) {
    for (const auto& [normals, heights] :
         {std::pair{blank_image(2, 2, 3, 8), blank_image(2, 3, 1, 8)},
          std::pair{blank_image(2, 2, 2, 8), blank_image(2, 2, 1, 8)}}) {
        const Result<Image> both = with_height_in_alpha(normals, heights);
        ASSERT_FALSE(both.ok());
        EXPECT_EQ(both.error().code, "image-mismatch");
    }
}

TEST(MipChain, HasVulkansSizes) {
    const std::pair<int, int> sizes[] = {{1, 1}, {8, 8}, {7, 5}, {1, 64}, {100, 3}, {17, 16}};
    for (const auto& [width, height] : sizes) {
        const std::vector<Image> levels = mip_chain(blank_image(width, height, 2, 8));
        int w = width;
        int h = height;
        for (const Image& level : levels) {
            EXPECT_EQ(level.width, w);
            EXPECT_EQ(level.height, h);
            EXPECT_TRUE(check_image(level).ok());
            w = std::max(1, w / 2);
            h = std::max(1, h / 2);
        }
        EXPECT_EQ(levels.back().width, 1);
        EXPECT_EQ(levels.back().height, 1);
        std::size_t count = 1;  // floor(log2(longest side)) + 1
        for (int side = std::max(width, height); side > 1; side /= 2) ++count;
        EXPECT_EQ(levels.size(), count);
    }
}

TEST(MipChain, KeepsTheAverageAtEverySize) {
    std::mt19937 random(seed);
    const std::pair<int, int> sizes[] = {{16, 8}, {7, 5}, {1, 33}, {31, 2}, {12, 10}};
    for (const auto& [width, height] : sizes) {
        const Image image = random_image(width, height, 3, random);
        for (const Image& level : mip_chain(image)) {
            for (int c = 0; c < 3; ++c) {
                // Each level rounds its texels to float once: 2^-25 of at most 1, over at most six
                // levels.
                EXPECT_NEAR(mean(level, c), mean(image, c), 6 * 0x1p-25)
                    << level.width << " x " << level.height << ", seed " << seed;
            }
        }
    }
}

TEST(MipChain, AveragesFourTexelsAtEvenSizes) {
    std::mt19937 random(seed);
    const Image image = random_image(8, 6, 1, random);
    const Image half = mip_chain(image)[1];
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 4; ++x) {
            const float sum = image.at(2 * x, 2 * y) + image.at(2 * x + 1, 2 * y) +
                              image.at(2 * x, 2 * y + 1) + image.at(2 * x + 1, 2 * y + 1);
            EXPECT_FLOAT_EQ(half.at(x, y), sum / 4);
        }
    }
}

TEST(MipChain, WeighsThreeTexelsAtOddSizes) {
    Image image = blank_image(5, 1, 1, 8);
    image.texels = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f};
    const Image half = mip_chain(image)[1];  // each covers 2.5 texels, half of the middle one
    ASSERT_EQ(half.width, 2);
    EXPECT_FLOAT_EQ(half.at(0, 0), 0.2f);
    EXPECT_FLOAT_EQ(half.at(1, 0), 0.2f);
}

TEST(MipChain, OfAMalformedImageIsEmpty) { EXPECT_TRUE(mip_chain(Image{}).empty()); }

}  // namespace
}  // namespace intaglio::maps

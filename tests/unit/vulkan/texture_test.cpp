// Sizes of levels and the encoding of texels.
#include "src/vulkan/texture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace intaglio::vulkan {
namespace {

Texture sized(int width, int height, const std::vector<std::size_t>& texels) {
    Texture texture;
    texture.width = width;
    texture.height = height;
    for (const std::size_t count : texels) texture.levels.emplace_back(4 * count);
    return texture;
}

TEST(Texture, LevelsHalveAndStopAtOne) {
    EXPECT_TRUE(validate(sized(4, 1, {4, 2, 1}), "t").ok());
    EXPECT_TRUE(validate(sized(5, 3, {15, 2, 1}), "t").ok());
    EXPECT_TRUE(validate(sized(5, 3, {15}), "t").ok());
}

TEST(Texture, WrongSizesAreSentences) {
    EXPECT_EQ(to_string(validate(sized(0, 4, {4}), "height_map").error()),
              "error: texture 'height_map' is 0 by 4 texels with 1 levels, and needs at least one "
              "texel and one level "
              "[bad-texture]");
    EXPECT_EQ(to_string(validate(sized(4, 4, {16, 3}), "height_map").error()),
              "error: level 1 of texture 'height_map' is 2 by 2 texels and needs 16 floats, not 12 "
              "[bad-texture]");
    EXPECT_EQ(to_string(validate(sized(2, 2, {4, 1, 1}), "height_map").error()),
              "error: texture 'height_map' has 3 levels, but level 1 is a single texel and the "
              "last [bad-texture]");
    EXPECT_FALSE(validate(sized(1, 1, std::vector<std::size_t>(40, 1)), "t").ok());
}

TEST(Texture, EncodesToTheNearestStep) {
    const std::vector<float> level = {
        0, 1, 0.5f, -3, 7, std::nanf(""), 1 / 255.0f, 0.4999f / 255.0f};
    const auto bytes = encode(level, Texture::Format::Rgba8Unorm);
    ASSERT_EQ(bytes.size(), 8u);
    const int expected[] = {0, 255, 128, 0, 255, 0, 1, 0};
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << i;

    const auto wide = encode({1 / 65535.0f, 0.5f, 1, 0}, Texture::Format::Rgba16Unorm);
    std::uint16_t values[4];
    ASSERT_EQ(wide.size(), sizeof values);
    std::memcpy(values, wide.data(), sizeof values);
    EXPECT_THAT(values, testing::ElementsAre(1, 32768, 65535, 0));
}

}  // namespace
}  // namespace intaglio::vulkan

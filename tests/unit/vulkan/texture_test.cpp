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

TEST(Texture, EncodesHalvesToTheNearestEven) {
    const float least = std::ldexp(1.0f, -24);  // the least denormal
    const std::vector<std::pair<float, std::uint16_t>> cases = {
        {0.0f, 0x0000},
        {-0.0f, 0x8000},
        {1.0f, 0x3c00},
        {-2.0f, 0xc000},
        {0.333251953125f, 0x3555},
        {1 + std::ldexp(1.0f, -11), 0x3c00},  // a tie goes to the even one below
        {1 + 3 * std::ldexp(1.0f, -11), 0x3c02},
        {65504.0f, 0x7bff},
        {65519.0f, 0x7bff},
        {65520.0f, 0x7c00},  // infinity
        {least, 0x0001},
        {least / 2, 0x0000},
        {least * 0.75f, 0x0001},
        {least * 1023.5f, 0x0400},  // a tie carries into the least normal number
        {-INFINITY, 0xfc00},
    };
    for (const auto& [value, half] : cases) {
        const auto bytes = encode({value, 0, 0, 0}, Texture::Format::Rgba16Float);
        std::uint16_t got = 0;
        std::memcpy(&got, bytes.data(), sizeof got);
        EXPECT_EQ(got, half) << value;
    }
    const auto nan = encode({std::nanf(""), 0, 0, 0}, Texture::Format::Rgba16Float);
    EXPECT_TRUE(std::isnan(decode(nan, Texture::Format::Rgba16Float)[0]));
}

// Every step of every format of 16 bits or fewer survives decoding and encoding.
TEST(Texture, DecodingIsUndoneByEncoding) {
    for (const Texture::Format format : {Texture::Format::Rgba8Unorm, Texture::Format::Rgba16Unorm,
                                         Texture::Format::Rgba16Float}) {
        const std::size_t width = bytes_per_texel(format) / 4;
        std::vector<std::byte> bytes;
        for (std::uint32_t step = 0; step < (width == 1 ? 256u : 65536u); ++step) {
            // NaNs lose their payload.
            if (format == Texture::Format::Rgba16Float && (step & 0x7fff) > 0x7c00) continue;
            for (std::size_t byte = 0; byte < width; ++byte)
                bytes.push_back(static_cast<std::byte>(step >> (8 * byte)));
        }
        EXPECT_EQ(encode(decode(bytes, format), format), bytes) << name_of(format);
    }
}

}  // namespace
}  // namespace intaglio::vulkan

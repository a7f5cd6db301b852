// What the bytes of a PNG mean: every colour type, depth, transparency and interlacing, against
// libpng as witness, and what damaged bytes give.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "src/maps/png.h"
#include "tests/unit/maps/png_witness.h"

namespace intaglio::maps {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

constexpr unsigned seed = 20240611;

struct Kind {
    std::string name;
    int colour_type;
    int depth;
    bool transparent;
};

std::vector<Kind> all_kinds() {
    std::vector<Kind> kinds;
    for (const bool transparent : {false, true}) {
        for (const int depth : {1, 2, 4, 8, 16}) kinds.push_back({"Gray", 0, depth, transparent});
        for (const int depth : {8, 16}) kinds.push_back({"Rgb", 2, depth, transparent});
        for (const int depth : {1, 2, 4, 8}) kinds.push_back({"Palette", 3, depth, transparent});
    }
    for (const int depth : {8, 16}) {
        kinds.push_back({"GrayAlpha", 4, depth, false});
        kinds.push_back({"Rgba", 6, depth, false});
    }
    for (Kind& kind : kinds) {
        kind.name += std::to_string(kind.depth) + (kind.transparent ? "Transparent" : "");
    }
    return kinds;
}

// Mt19937's own numbers, because distributions differ between libraries.
witness::Png random_png(const Kind& kind, int width, int height, bool interlaced,
                        std::mt19937& random) {
    witness::Png png{width, height, kind.colour_type, kind.depth, interlaced, {}, {}, {}, {}};
    const auto largest = (1u << kind.depth) - 1;
    const auto count = static_cast<std::size_t>(width * height * png.channels());
    for (std::size_t i = 0; i < count; ++i) {
        png.samples.push_back(static_cast<std::uint16_t>(random() & largest));
    }
    if (kind.colour_type == 3) {
        for (unsigned i = 0; i < 3 * (largest + 1); ++i) {
            png.palette.push_back(static_cast<std::uint8_t>(random()));
        }
        // Shorter than the palette: the other entries are opaque.
        for (unsigned i = 0; kind.transparent && i < (largest + 1) / 2; ++i) {
            png.palette_alpha.push_back(static_cast<std::uint8_t>(random()));
        }
    } else if (kind.transparent) {  // the colour of the first texel, so that at least one is
                                    // transparent
        png.transparent.assign(png.samples.begin(), png.samples.begin() + png.channels());
    }
    return png;
}

// The image that the PNG specification prescribes, from the samples that went into the file.
Image expected_image(const witness::Png& png) {
    const auto step = static_cast<std::size_t>(png.channels());
    const bool alpha = !png.palette_alpha.empty() || !png.transparent.empty();
    const float largest = static_cast<float>((1u << png.depth) - 1);
    const int channels = (png.colour_type == 3 ? 3 : png.channels()) + (alpha ? 1 : 0);
    Image image{png.width, png.height, channels, png.depth == 16 ? 16 : 8, {}};
    for (std::size_t i = 0; i < png.samples.size(); i += step) {
        if (png.colour_type == 3) {
            const std::size_t entry = png.samples[i];
            for (std::size_t c = 0; c < 3; ++c) {
                image.texels.push_back(png.palette[3 * entry + c] / 255.0f);
            }
            if (alpha) {
                image.texels.push_back(
                    entry < png.palette_alpha.size() ? png.palette_alpha[entry] / 255.0f : 1.0f);
            }
            continue;
        }
        bool transparent = !png.transparent.empty();
        for (std::size_t c = 0; c < step; ++c) {
            image.texels.push_back(png.samples[i + c] / largest);
            transparent = transparent && png.samples[i + c] == png.transparent[c];
        }
        if (alpha) image.texels.push_back(transparent ? 0.0f : 1.0f);
    }
    return image;
}

class PngOfKind : public testing::TestWithParam<Kind> {};

TEST_P(PngOfKind, IsReadAsLibpngWroteIt) {
    std::mt19937 random(seed);
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 9}, {9, 1}, {2, 2}, {13, 7}, {64, 33}};
    for (const auto& [width, height] : sizes) {
        for (const bool interlaced : {false, true}) {
            SCOPED_TRACE(testing::Message() << width << " x " << height << ", interlaced "
                                            << interlaced << ", seed " << seed);
            const witness::Png png = random_png(GetParam(), width, height, interlaced, random);
            const Result<Image> image = decode_png(witness::written(png));
            ASSERT_TRUE(image.ok()) << to_string(image.error());
            const Image expected = expected_image(png);
            EXPECT_EQ(image->width, expected.width);
            EXPECT_EQ(image->height, expected.height);
            EXPECT_EQ(image->channels, expected.channels);
            EXPECT_EQ(image->bits, expected.bits);
            ASSERT_EQ(image->texels.size(), expected.texels.size());
            for (std::size_t i = 0; i < expected.texels.size(); ++i) {
                // Bit for bit, but for the depths below 8, whose samples are spread over 0..255
                // first: v * 255 / m over 255 and v / m are the same number, each rounded once.
                ASSERT_EQ(image->texels[i], expected.texels[i]) << "value " << i;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Every, PngOfKind, testing::ValuesIn(all_kinds()),
                         [](const auto& kind) { return kind.param.name; });

Image random_image(int width, int height, int channels, int bits, std::mt19937& random) {
    Image image = blank_image(width, height, channels, bits);
    const unsigned largest = (1u << bits) - 1;
    for (float& texel : image.texels) {
        texel = static_cast<float>(random() & largest) / static_cast<float>(largest);
    }
    return image;
}

TEST(Png, RoundTripsExactlyAndLibpngReadsTheSame) {
    std::mt19937 random(seed);
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 64}, {64, 1}, {17, 5}};
    for (const auto& [width, height] : sizes) {
        for (int channels = 1; channels <= 4; ++channels) {
            for (const int bits : {8, 16}) {
                SCOPED_TRACE(testing::Message() << width << " x " << height << " x " << channels
                                                << ", bits " << bits << ", seed " << seed);
                const Image image = random_image(width, height, channels, bits, random);
                const auto bytes = encode_png(image);
                ASSERT_TRUE(bytes.ok()) << to_string(bytes.error());
                const Result<Image> again = decode_png(*bytes);
                ASSERT_TRUE(again.ok()) << to_string(again.error());
                EXPECT_EQ(*again, image);

                const witness::Png png = witness::read(*bytes);
                EXPECT_EQ(png.depth, bits);
                EXPECT_EQ(png.channels(), channels);
                ASSERT_EQ(png.samples.size(), image.texels.size());
                for (std::size_t i = 0; i < png.samples.size(); ++i) {
                    const float largest = static_cast<float>((1u << bits) - 1);
                    ASSERT_EQ(static_cast<float>(png.samples[i]) / largest, image.texels[i]) << i;
                }
            }
        }
    }
}

TEST(Png, RoundsToTheNearestStepAndClampsWhatLiesOutside) {
    const float infinity = std::numeric_limits<float>::infinity();
    Image image = blank_image(8, 1, 1, 8);
    image.texels = {-1.0f,     2.0f,          std::nanf(""), infinity,
                    -infinity, 0.4f / 255.0f, 0.6f / 255.0f, 254.6f / 255.0f};
    const auto bytes = encode_png(image);
    ASSERT_TRUE(bytes.ok());
    EXPECT_THAT(witness::read(*bytes).samples, testing::ElementsAre(0, 255, 0, 255, 0, 0, 1, 255));
}

TEST(Png, TheSameImageGivesTheSameBytes) {
    std::mt19937 random(seed);
    const Image image = random_image(40, 30, 4, 16, random);
    EXPECT_EQ(*encode_png(image), *encode_png(image));
}

TEST(Png, RefusesAnImageThatContradictsItself) {
    Image good = blank_image(3, 2, 2, 8);
    for (const auto& spoil : std::vector<void (*)(Image&)>{
             [](Image& i) { i.width = 0; }, [](Image& i) { i.height = -1; },
             [](Image& i) { i.width = largest_side + 1; }, [](Image& i) { i.channels = 5; },
             [](Image& i) { i.channels = 0; }, [](Image& i) { i.bits = 12; },
             [](Image& i) { i.texels.pop_back(); }}) {
        Image bad = good;
        spoil(bad);
        const auto bytes = encode_png(bad);
        ASSERT_FALSE(bytes.ok());
        EXPECT_EQ(bytes.error().code, "image-malformed");
    }
    EXPECT_TRUE(encode_png(good).ok());
}

// A small file with every chunk that changes values: header, palette, transparency, data.
std::vector<unsigned char> small_png() {
    std::mt19937 random(seed);
    return witness::written(random_png({"Palette4", 3, 4, true}, 6, 5, false, random));
}

TEST(Png, EveryTruncationIsRefused) {
    const std::vector<unsigned char> whole = small_png();
    ASSERT_TRUE(decode_png(whole).ok());
    for (std::size_t size = 1; size < whole.size(); ++size) {
        const Result<Image> image = decode_png(std::span(whole).first(size));
        ASSERT_FALSE(image.ok()) << "cut off after " << size << " of " << whole.size();
        EXPECT_EQ(image.error().code, "png-truncated") << size << ": " << to_string(image.error());
    }
}

TEST(Png, EveryDamagedByteIsRefused) {
    const std::vector<unsigned char> whole = small_png();
    std::set<std::string> codes;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const unsigned char flip : {0x01, 0x20, 0x80}) {
            std::vector<unsigned char> damaged = whole;
            damaged[i] = static_cast<unsigned char>(damaged[i] ^ flip);
            const Result<Image> image = decode_png(damaged);
            ASSERT_FALSE(image.ok()) << "byte " << i << " of " << whole.size();
            codes.insert(image.error().code);
        }
    }
    EXPECT_TRUE(codes.count("png-corrupt"));
    EXPECT_TRUE(codes.count("not-a-png"));
}

TEST(Png, ADamagedChecksumIsNamed) {
    std::vector<unsigned char> damaged = small_png();
    const unsigned char type[] = {'t', 'R', 'N', 'S'};
    const auto chunk =
        std::search(damaged.begin(), damaged.end(), std::begin(type), std::end(type));
    ASSERT_NE(chunk, damaged.end());
    *(chunk + 4) ^= 1;  // transparency that was silently dropped would be a relief without height
    const Result<Image> image = decode_png(damaged);
    ASSERT_FALSE(image.ok());
    EXPECT_EQ(image.error().code, "png-corrupt");
    EXPECT_THAT(image.error().message, HasSubstr("checksum"));
}

TEST(Png, SizesBeyondTheLimitsAreRefusedBeforeAnyMemoryIsTaken) {
    const std::pair<int, int> sizes[] = {{largest_side + 1, 1},
                                         {1, largest_side + 1},
                                         {largest_side, largest_side},
                                         {2000000000, 2000000000}};
    for (const auto& [width, height] : sizes) {
        const Result<Image> image = decode_png(witness::header_only(width, height));
        ASSERT_FALSE(image.ok());
        EXPECT_EQ(image.error().code, "image-size") << to_string(image.error());
        EXPECT_THAT(image.error().message, AnyOf(HasSubstr("16384"), HasSubstr("67108864")));
        EXPECT_THAT(image.error().message, HasSubstr(std::to_string(width)));
    }
    const Result<Image> within = decode_png(witness::header_only(largest_side, 1));
    ASSERT_FALSE(within.ok());
    EXPECT_EQ(within.error().code, "png-truncated");
}

TEST(Png, WhatIsNotAPngIsNamedWhereItCanBe) {
    const std::pair<std::string, std::string> starts[] = {
        {"\xff\xd8\xff\xe0", "a JPEG"},
        {"GIF89a", "a GIF"},
        {"BM\x01\x02", "a BMP"},
        {"BMW is a car", "a text file"},
        {"hello, world\n", "a text file"},
        {"caf\xc3\xa9\r\n", "a text file"},
        {std::string("MM\0*", 4), "a TIFF"},
        {std::string("\1\2\0\3", 4), "not those of any known image"},
    };
    for (const auto& [start, name] : starts) {
        const Result<Image> image = decode_png(
            std::span(reinterpret_cast<const unsigned char*>(start.data()), start.size()));
        ASSERT_FALSE(image.ok());
        EXPECT_EQ(image.error().code, "not-a-png");
        EXPECT_THAT(image.error().message, HasSubstr(name));
    }
}

}  // namespace
}  // namespace intaglio::maps

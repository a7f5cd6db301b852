// The procedural maps: what holds for all of them, and what each promises in its sentence.
#include "src/maps/makers.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>

#include "src/maps/png.h"

namespace intaglio::maps {
namespace {

using testing::HasSubstr;

Image made(std::string_view name, int width, int height, std::uint32_t seed = 1) {
    Result<Image> image = make_height_map(name, width, height, seed);
    EXPECT_TRUE(image.ok()) << name;
    return *std::move(image);
}

class EveryMaker : public testing::TestWithParam<Maker> {};

INSTANTIATE_TEST_SUITE_P(Maps, EveryMaker, testing::ValuesIn(makers().begin(), makers().end()),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST_P(EveryMaker, MakesAnySizeWithHeightsFromZeroToOne) {
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 64}, {64, 1},  {2, 2},
                                         {3, 5}, {7, 2},  {33, 17}, {128, 64}};
    for (const auto& [width, height] : sizes) {
        const Image image = made(GetParam().name, width, height);
        ASSERT_TRUE(check_image(image).ok());
        EXPECT_EQ(image.width, width);
        EXPECT_EQ(image.height, height);
        EXPECT_EQ(image.channels, 1);
        for (const float h : image.texels) ASSERT_TRUE(h >= 0.0f && h <= 1.0f) << h;
    }
}

TEST_P(EveryMaker, PassesUnchangedThroughAPng) {
    const Image image = made(GetParam().name, 31, 20);
    const auto bytes = encode_png(image);
    ASSERT_TRUE(bytes.ok());
    EXPECT_EQ(*decode_png(*bytes), image);
}

TEST_P(EveryMaker, RefusesEmptyAndHugeSizes) {
    for (const auto& [width, height] :
         {std::pair{0, 4}, std::pair{4, -1}, std::pair{largest_side + 1, 1}}) {
        const Result<Image> image = make_height_map(GetParam().name, width, height, 1);
        ASSERT_FALSE(image.ok());
        EXPECT_EQ(image.error().code, "image-size");
    }
}

TEST_P(EveryMaker, DependsOnTheSeedAloneAndOnlyWhereItIsRandom) {
    const Image image = made(GetParam().name, 48, 48, 5);
    EXPECT_EQ(made(GetParam().name, 48, 48, 5), image);
    const std::set<std::string_view> plain = {"pyramids", "steps", "flat0", "flat1", "ramp"};
    EXPECT_EQ(made(GetParam().name, 48, 48, 6) == image, plain.count(GetParam().name) == 1);
}

TEST_P(EveryMaker, HasColoursToMatch) {
    const Image heights = made(GetParam().name, 20, 30);
    const Result<Image> colours = make_colour_map(GetParam().name, heights);
    ASSERT_TRUE(colours.ok());
    EXPECT_TRUE(check_image(*colours).ok());
    EXPECT_EQ(colours->channels, 3);
    EXPECT_EQ(colours->width, 20);
    EXPECT_EQ(colours->height, 30);
    for (const float c : colours->texels) ASSERT_TRUE(c >= 0.0f && c <= 1.0f);
    const auto& stops = GetParam().colours;
    EXPECT_EQ(stops.front().height, 0.0f);
    EXPECT_EQ(stops.back().height, 1.0f);
    for (std::size_t i = 1; i < stops.size(); ++i) EXPECT_LT(stops[i - 1].height, stops[i].height);
}

// A map that tiles continues over its seam no more steeply than it runs elsewhere.
TEST(Makers, ContinuousMapsTile) {
    for (const char* name : {"bricks", "cobbles", "text", "pyramids", "noise", "smooth"}) {
        for (std::uint32_t seed = 1; seed <= 4; ++seed) {
            const Image image = made(name, 192, 160, seed);
            double inside_u = 0, inside_v = 0, seam_u = 0, seam_v = 0;
            for (int y = 0; y < image.height; ++y) {
                for (int x = 0; x < image.width; ++x) {
                    const int right = (x + 1) % image.width;
                    const int below = (y + 1) % image.height;
                    const double du = std::abs(image.at(right, y) - image.at(x, y));
                    const double dv = std::abs(image.at(x, below) - image.at(x, y));
                    (right == 0 ? seam_u : inside_u) = std::max(right == 0 ? seam_u : inside_u, du);
                    (below == 0 ? seam_v : inside_v) = std::max(below == 0 ? seam_v : inside_v, dv);
                }
            }
            EXPECT_LE(seam_u, inside_u) << name << ", seed " << seed;
            EXPECT_LE(seam_v, inside_v) << name << ", seed " << seed;
        }
    }
}

TEST(Makers, SmoothIsSmooth) {
    const Image image = made("smooth", 256, 256, 3);
    const auto [low, high] = std::minmax_element(image.texels.begin(), image.texels.end());
    EXPECT_GT(*high - *low, 0.4f);
    // Slope along either axis at most 2 pi * (0.16 + 2 * 0.1 + 2 * 0.07) per texture unit; half a
    // step of rounding each.
    const double steepest = 2 * 3.14159265358979 * (0.16 + 0.2 + 0.14) / 256 + 1.0 / 65535;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            ASSERT_LE(std::abs(image.at((x + 1) % 256, y) - image.at(x, y)), steepest);
            ASSERT_LE(std::abs(image.at(x, (y + 1) % 256) - image.at(x, y)), steepest);
        }
    }
}

TEST(Makers, SpikesAreSingleTexelsOfFullHeight) {
    for (const auto& [width, height] :
         {std::pair{64, 32}, std::pair{61, 43}, std::pair{3, 2}, std::pair{1, 1}}) {
        const Image image = made("spikes", width, height);
        const auto spikes = std::count(image.texels.begin(), image.texels.end(), 1.0f);
        const auto floor = std::count(image.texels.begin(), image.texels.end(), 0.0f);
        EXPECT_EQ(spikes, std::max(1, width / 8) * std::max(1, height / 8));
        EXPECT_EQ(spikes + floor, width * height);
    }
}

TEST(Makers, FlatRampAndStepsAreWhatTheySay) {
    for (const float h : made("flat0", 5, 3).texels) EXPECT_EQ(h, 0.0f);
    for (const float h : made("flat1", 5, 3).texels) EXPECT_EQ(h, 1.0f);
    const Image ramp = made("ramp", 50, 3);
    for (int x = 0; x < 50; ++x) EXPECT_NEAR(ramp.at(x, 2), (x + 0.5) / 50, 0.5 / 65535 + 1e-7);
    const Image steps = made("steps", 64, 2);
    for (int x = 0; x < 64; ++x) EXPECT_NEAR(steps.at(x, 1), (x / 8) / 7.0, 0.5 / 65535 + 1e-7);
}

TEST(Makers, PyramidsArePlanesUpToAPeak) {
    const Image image = made("pyramids", 64, 64);
    EXPECT_GT(*std::max_element(image.texels.begin(), image.texels.end()), 0.9f);
    EXPECT_LT(*std::min_element(image.texels.begin(), image.texels.end()), 0.1f);
    // On one face the second difference vanishes but for rounding: a peak is at texel 8, a face
    // runs from 0 to 7.
    for (int x = 1; x < 6; ++x) {
        EXPECT_NEAR(image.at(x - 1, 8) - 2 * image.at(x, 8) + image.at(x + 1, 8), 0.0, 2.1 / 65535);
    }
}

TEST(Makers, FurIsDenseThinAndUneven) {
    const Image image = made("fur", 128, 128);
    std::set<float> tips;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            const float h = image.at(x, y);
            if (h > 0.3f && h >= image.at((x + 1) % 128, y) && h >= image.at((x + 127) % 128, y) &&
                h >= image.at(x, (y + 1) % 128) && h >= image.at(x, (y + 127) % 128)) {
                tips.insert(h);
            }
        }
    }
    EXPECT_GT(tips.size(), 400u);  // of 1024 hairs: some hide behind longer ones
    EXPECT_GT(*tips.rbegin() - *tips.begin(), 0.4f);
}

TEST(Makers, BricksAreRedOverPaleMortar) {
    const Image heights = made("bricks", 128, 128);
    const Image colours = *make_colour_map("bricks", heights);
    double red_high = 0, red_low = 0;
    int high = 0, low = 0;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            const double redness = colours.at(x, y, 0) - colours.at(x, y, 2);
            if (heights.at(x, y) > 0.6f) {
                red_high += redness;
                ++high;
            } else if (heights.at(x, y) < 0.3f) {
                red_low += redness;
                ++low;
            }
        }
    }
    ASSERT_GT(high, low);
    ASSERT_GT(low, 500);
    EXPECT_GT(red_high / high, red_low / low + 0.2);
}

// One number for all maps, from one compiler: another compiler or C library must give the same.
TEST(Makers, AreTheSameOnEveryMachine) {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (const Maker& maker : makers()) {
        for (const float h : made(maker.name, 40, 24, 2024).texels) {
            hash = (hash ^ static_cast<std::uint64_t>(std::lround(h * 65535.0f))) * 1099511628211u;
        }
    }
    EXPECT_EQ(hash, 1709143612795982719u);
}

TEST(Makers, AnUnknownNameGetsTheNearestOne) {
    const std::pair<const char*, const char*> names[] = {
        {"brick", "bricks"},     {"Cobbles", "cobbles"}, {"flat", "flat0"},
        {"pyramid", "pyramids"}, {"nose", "noise"},      {"furr", "fur"}};
    for (const auto& [wrong, right] : names) {
        const Result<Image> image = make_height_map(wrong, 4, 4, 1);
        ASSERT_FALSE(image.ok());
        EXPECT_EQ(image.error().code, "unknown-map");
        EXPECT_THAT(image.error().message, HasSubstr(std::string("did you mean '") + right + "'?"));
        EXPECT_EQ(make_colour_map(wrong, blank_image(1, 1, 1, 8)).error().code, "unknown-map");
    }
    EXPECT_FALSE(make_height_map("", 4, 4, 1).ok());
    EXPECT_EQ(make_colour_map("bricks", Image{}).error().code, "image-malformed");
}

}  // namespace
}  // namespace intaglio::maps

// The artist's maps under examples/maps: they load, have relief, and follow the conventions that
// their README states.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "src/maps/bake.h"
#include "src/maps/png.h"

namespace intaglio::maps {
namespace {

namespace fs = std::filesystem;

class RealMap : public testing::TestWithParam<std::string> {
  protected:
    Image load(const std::string& file) const {
        Result<Image> image = read_png(fs::path(INTAGLIO_EXAMPLE_MAPS) / GetParam() / file);
        EXPECT_TRUE(image.ok()) << to_string(image.error());
        return *std::move(image);
    }
};

INSTANTIATE_TEST_SUITE_P(Examples, RealMap, testing::Values("stone_bricks", "door", "pipes"),
                         [](const auto& kind) { return kind.param; });

TEST_P(RealMap, LoadsWithMatchingSizes) {
    const Image colour = load("colour.png");
    const Image normal = load("normal_height.png");
    EXPECT_EQ(colour.channels, 3);
    EXPECT_EQ(normal.channels, 4);
    EXPECT_EQ(colour.width, normal.width);
    EXPECT_EQ(colour.height, normal.height);
    EXPECT_LE(std::max(colour.width, colour.height), 512);
}

TEST_P(RealMap, HasRealReliefInAlpha) {
    const Image normal = load("normal_height.png");
    const Result<Image> heights = heights_of(normal, HeightSource::Automatic);
    ASSERT_TRUE(heights.ok());
    EXPECT_EQ(*heights, *heights_of(normal, HeightSource::Alpha));
    const auto [low, high] = std::minmax_element(heights->texels.begin(), heights->texels.end());
    EXPECT_GT(*high - *low, 0.4f);
}

// The artist's y points towards larger v, as ours does: his normals lean the way that the slopes of
// his heights do.
TEST_P(RealMap, NormalsAgreeWithTheHeights) {
    const Image normal = load("normal_height.png");
    const Image heights = *heights_of(normal, HeightSource::Alpha);
    const Image baked = *bake_normal(heights, 0.05, NormalKernel::Sobel, Wrap::Repeat);
    for (int c = 0; c < 2; ++c) {
        double product = 0, square = 0, baked_square = 0;
        for (int y = 0; y < normal.height; ++y) {
            for (int x = 0; x < normal.width; ++x) {
                const double a = normal.at(x, y, c) - 0.5;
                const double b = baked.at(x, y, c) - 0.5;
                product += a * b;
                square += a * a;
                baked_square += b * b;
            }
        }
        // Measured 0.7 to 0.94: the pipes' normals come from a model, its heights have 8 bits.
        EXPECT_GT(product / std::sqrt(square * baked_square), 0.6) << "channel " << c;
    }
}

}  // namespace
}  // namespace intaglio::maps

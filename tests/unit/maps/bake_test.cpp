// Baked normals against closed forms, and against themselves on flipped, shifted and scaled maps.
#include "src/maps/bake.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

namespace intaglio::maps {
namespace {

constexpr unsigned seed = 99;
constexpr double pi = 3.14159265358979323846;

struct Vector {
    double x, y, z;
};

Vector normal_at(const Image& normals, int x, int y) {
    return {2.0 * normals.at(x, y, 0) - 1, 2.0 * normals.at(x, y, 1) - 1,
            2.0 * normals.at(x, y, 2) - 1};
}

double distance(const Vector& a, const Vector& b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

// From the slopes in texture units, by the definition.
Vector normal_of(double slope_u, double slope_v, double scale) {
    const double length = std::hypot(slope_u * scale, slope_v * scale, 1.0);
    return {-slope_u * scale / length, -slope_v * scale / length, 1 / length};
}

Image sampled(int width, int height, const std::function<double(double, double)>& surface) {
    Image image = blank_image(width, height, 1, 16);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y) = static_cast<float>(surface((x + 0.5) / width, (y + 0.5) / height));
        }
    }
    return image;
}

Image random_heights(int width, int height) {
    std::mt19937 random(seed);
    Image image = blank_image(width, height, 1, 16);
    // Multiples of 1/256, so that 1 - h is exact.
    for (float& texel : image.texels) texel = static_cast<float>(random() % 257) / 256.0f;
    return image;
}

struct Mode {
    NormalKernel kernel;
    Wrap wrap;
};

class Bake : public testing::TestWithParam<Mode> {
  protected:
    Image bake(const Image& heights, double scale) const {
        Result<Image> normals = bake_normal(heights, scale, GetParam().kernel, GetParam().wrap);
        EXPECT_TRUE(normals.ok());
        return *std::move(normals);
    }
};

INSTANTIATE_TEST_SUITE_P(Every, Bake,
                         testing::Values(Mode{NormalKernel::Central, Wrap::Repeat},
                                         Mode{NormalKernel::Central, Wrap::Clamp},
                                         Mode{NormalKernel::Sobel, Wrap::Repeat},
                                         Mode{NormalKernel::Sobel, Wrap::Clamp}),
                         [](const auto& kind) {
                             return std::string(kind.param.kernel == NormalKernel::Sobel
                                                    ? "Sobel"
                                                    : "Central") +
                                    (kind.param.wrap == Wrap::Clamp ? "Clamp" : "Repeat");
                         });

TEST_P(Bake, APlaneHasItsOwnNormal) {
    const Image heights =
        sampled(40, 24, [](double u, double v) { return 0.1 + 0.5 * u + 0.3 * v; });
    const Image normals = bake(heights, 0.7);
    EXPECT_EQ(normals.channels, 3);
    EXPECT_EQ(normals.bits, heights.bits);
    const Vector expected = normal_of(0.5, 0.3, 0.7);
    // Repeat sees the wall at the seam in the outermost texels; Clamp must be right up to the
    // border.
    const int margin = GetParam().wrap == Wrap::Repeat ? 1 : 0;
    for (int y = margin; y < heights.height - margin; ++y) {
        for (int x = margin; x < heights.width - margin; ++x) {
            // Heights are rounded to 2^-25; a slope divides two of them by as little as 1/40;
            // 8-fold for the encoding.
            ASSERT_LT(distance(normal_at(normals, x, y), expected), 2 * 40 * 0x1p-25 + 8 * 0x1p-25)
                << x << ", " << y;
        }
    }
}

TEST_P(Bake, RisingToTheRightLeansLeftAndRisingDownwardsLeansUp) {
    const Image right = bake(sampled(8, 8, [](double u, double) { return u; }), 1);
    EXPECT_LT(right.at(4, 4, 0), 0.5f);
    EXPECT_EQ(right.at(4, 4, 1), 0.5f);
    const Image down = bake(sampled(8, 8, [](double, double v) { return v; }), 1);
    EXPECT_EQ(down.at(4, 4, 0), 0.5f);
    EXPECT_LT(down.at(4, 4, 1), 0.5f);
}

TEST_P(Bake, ConvergesToASineWithOrderTwo) {
    const auto surface = [](double u, double v) {
        return 0.5 + 0.3 * std::sin(2 * pi * u) * std::cos(2 * pi * v);
    };
    const auto worst_error = [&](int size) {
        const Image normals = bake(sampled(size, size, surface), 0.4);
        const int margin =
            GetParam().wrap == Wrap::Clamp ? size / 8 : 0;  // one-sided there: order one
        double worst = 0;
        for (int y = margin; y < size - margin; ++y) {
            for (int x = margin; x < size - margin; ++x) {
                const double u = (x + 0.5) / size;
                const double v = (y + 0.5) / size;
                const Vector exact =
                    normal_of(0.6 * pi * std::cos(2 * pi * u) * std::cos(2 * pi * v),
                              -0.6 * pi * std::sin(2 * pi * u) * std::sin(2 * pi * v), 0.4);
                worst = std::max(worst, distance(normal_at(normals, x, y), exact));
            }
        }
        return worst;
    };
    // Halving the texel quarters the error; heights in float leave room for 2 % at these sizes, the
    // next order for 5 %.
    const double ratio = worst_error(32) / worst_error(64);
    EXPECT_GT(ratio, 3.8);
    EXPECT_LT(ratio, 4.2);
}

TEST_P(Bake, FlippingTheMapFlipsTheNormal) {
    const Image heights = random_heights(9, 6);
    const Image normals = bake(heights, 0.3);
    Image flipped_x = heights;
    Image flipped_y = heights;
    Image transposed = blank_image(heights.height, heights.width, 1, 16);
    for (int y = 0; y < heights.height; ++y) {
        for (int x = 0; x < heights.width; ++x) {
            flipped_x.at(heights.width - 1 - x, y) = heights.at(x, y);
            flipped_y.at(x, heights.height - 1 - y) = heights.at(x, y);
            transposed.at(y, x) = heights.at(x, y);
        }
    }
    const Image by_x = bake(flipped_x, 0.3);
    const Image by_y = bake(flipped_y, 0.3);
    const Image by_both = bake(transposed, 0.3);
    for (int y = 0; y < heights.height; ++y) {
        for (int x = 0; x < heights.width; ++x) {
            const Vector n = normal_at(normals, x, y);
            const Vector nx = normal_at(by_x, heights.width - 1 - x, y);
            const Vector ny = normal_at(by_y, x, heights.height - 1 - y);
            const Vector nt = normal_at(by_both, y, x);
            // The arithmetic is symmetric; only the encoding's float differs, by 2^-25 on either
            // side of one half.
            const double tolerance = 4 * 0x1p-25;
            ASSERT_LT(distance(nx, {-n.x, n.y, n.z}), tolerance)
                << x << ", " << y << ", seed " << seed;
            ASSERT_LT(distance(ny, {n.x, -n.y, n.z}), tolerance)
                << x << ", " << y << ", seed " << seed;
            ASSERT_LT(distance(nt, {n.y, n.x, n.z}), tolerance)
                << x << ", " << y << ", seed " << seed;
        }
    }
}

TEST_P(Bake, TurningTheReliefInsideOutIsANegativeScale) {
    const Image heights = random_heights(7, 11);
    Image inverted = heights;
    for (float& texel : inverted.texels) texel = 1 - texel;
    EXPECT_EQ(bake(inverted, 0.2), bake(heights, -0.2));
}

TEST_P(Bake, EveryNormalHasLengthOneAndPointsOutwards) {
    for (const double scale : {1e-9, 0.05, 1.0, 1e6}) {
        const Image normals = bake(random_heights(16, 5), scale);
        for (int y = 0; y < normals.height; ++y) {
            for (int x = 0; x < normals.width; ++x) {
                const Vector n = normal_at(normals, x, y);
                ASSERT_NEAR(distance(n, {0, 0, 0}), 1.0, 4 * 0x1p-24) << scale;
                ASSERT_GE(n.z, 0.0);
            }
        }
    }
}

TEST_P(Bake, FlatMapsAndSingleTexelsPointStraightUp) {
    const std::pair<int, int> sizes[] = {{1, 1}, {5, 1}, {1, 7}, {2, 2}};
    for (const auto& [width, height] : sizes) {
        Image flat = blank_image(width, height, 1, 8);
        for (float& texel : flat.texels) texel = 0.3f;
        const Image normals = bake(flat, 1);
        for (std::size_t i = 0; i < normals.texels.size(); i += 3) {
            EXPECT_EQ(normals.texels[i], 0.5f);
            EXPECT_EQ(normals.texels[i + 1], 0.5f);
            EXPECT_EQ(normals.texels[i + 2], 1.0f);
        }
    }
}

TEST(BakeRepeat, ShiftingTheMapShiftsTheNormals) {
    const Image heights = random_heights(10, 8);
    for (const NormalKernel kernel : {NormalKernel::Central, NormalKernel::Sobel}) {
        const Image normals = *bake_normal(heights, 0.1, kernel, Wrap::Repeat);
        Image shifted = heights;
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 10; ++x) shifted.at((x + 3) % 10, (y + 5) % 8) = heights.at(x, y);
        }
        const Image after = *bake_normal(shifted, 0.1, kernel, Wrap::Repeat);
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 10; ++x) {
                for (int c = 0; c < 3; ++c) {
                    ASSERT_EQ(after.at((x + 3) % 10, (y + 5) % 8, c), normals.at(x, y, c));
                }
            }
        }
    }
}

TEST(BakeErrors, AreSentences) {
    const Image heights = blank_image(2, 2, 1, 8);
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double scale : {infinity, -infinity, std::nan(""), 1.1e6}) {
        const Result<Image> normals =
            bake_normal(heights, scale, NormalKernel::Central, Wrap::Repeat);
        ASSERT_FALSE(normals.ok());
        EXPECT_EQ(normals.error().code, "scale-range");
    }
    const Result<Image> normals = bake_normal(Image{}, 1, NormalKernel::Sobel, Wrap::Clamp);
    ASSERT_FALSE(normals.ok());
    EXPECT_EQ(normals.error().code, "image-malformed");
}

}  // namespace
}  // namespace intaglio::maps

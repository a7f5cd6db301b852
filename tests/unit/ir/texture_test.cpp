// Texture reads against the definition: a linearly filtered texture is the sum of all texels of all
// its copies, each weighted by a tent one texel wide.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "generator/ir/evaluate.h"
#include "generator/ir/parse.h"
#include "generator/ir/texture.h"
#include "tests/unit/ir/random_environment.h"

namespace intaglio::ir {
namespace {

using testing::Random;
using Coordinate = std::array<double, 3>;

// The red channel counts texels from 0; green is its negative.
Texture counting(int width, int height, int levels = 1) {
    Texture texture;
    texture.width = width;
    texture.height = height;
    for (int level = 0; level < levels; ++level) {
        const int texels = std::max(1, width >> level) * std::max(1, height >> level);
        auto& values = texture.levels.emplace_back();
        for (int i = 0; i < texels; ++i)
            for (int factor : {1, -1, 0, 100})
                values.push_back(static_cast<float>(factor * (i + 1000 * level)));
    }
    return texture;
}

double red(const Texture& texture, double u, double v, double level = 0) {
    return sample_level(texture, Coordinate{u, v, 0}, level)[0];
}

double tent(double distance) { return std::max(0.0, 1.0 - std::fabs(distance)); }

TEST(Texture, FiltersAsTheSumOfTents) {
    Random random(11);
    for (int i = 0; i < 2000; ++i) {
        Texture texture = testing::random_texture(random, 2);
        texture.filter = Texture::Filter::Linear;
        texture.weights = Texture::Weights::Exact;
        ASSERT_TRUE(texture.is_complete());
        const double u = random.unit() * 3 - 1, v = random.unit() * 3 - 1;
        const auto got = sample_level(texture, Coordinate{u, v, 0}, 0.0);
        const bool repeats = texture.wrap == Texture::Wrap::Repeat;
        std::array<double, 4> sum{};
        const int w = texture.width, h = texture.height;
        for (int y = -2 * h; y < 3 * h; ++y)
            for (int x = -2 * w; x < 3 * w; ++x) {
                const int column = repeats ? (x + 2 * w) % w : std::clamp(x, 0, w - 1);
                const int row = repeats ? (y + 2 * h) % h : std::clamp(y, 0, h - 1);
                const double weight = tent(u * w - (x + 0.5)) * tent(v * h - (y + 0.5));
                const auto index = static_cast<std::size_t>((row * w + column) * 4);
                for (std::size_t c = 0; c < 4; ++c)
                    sum[c] += weight * static_cast<double>(texture.levels[0][index + c]);
            }
        // Both sides round in double, from coordinates up to 27.
        for (std::size_t c = 0; c < 4; ++c)
            ASSERT_NEAR(got[c], sum[c], 1e-13) << w << "x" << h << " " << u << " " << v;
        const std::array<float, 3> coordinate = {static_cast<float>(u), static_cast<float>(v),
                                                 0.0f};
        const auto single = sample_level(texture, coordinate, 0.0f);
        // Eight texels across three copies: a coordinate's half ulp is 2^-20 texel; texels differ
        // by at most 1.
        for (std::size_t c = 0; c < 4; ++c) ASSERT_NEAR(single[c], sum[c], 4 * 0x1p-20);
    }
}

TEST(Texture, ReadsTheNearestTexel) {
    Texture texture = counting(4, 3);
    texture.filter = Texture::Filter::Nearest;
    EXPECT_EQ(red(texture, 0.0, 0.0), 0);
    EXPECT_EQ(red(texture, 0.25, 0.0), 1) << "a texel begins at its left edge";
    EXPECT_EQ(red(texture, 0.999, 0.999), 11);
    EXPECT_EQ(red(texture, 1.0, 0.0), 0) << "repeats";
    EXPECT_EQ(red(texture, -0.01, 0.0), 3);
    EXPECT_EQ(red(texture, -1e-300, 0.0), 0) << "a fraction that rounds to 1 is the next copy's 0";
    texture.wrap = Texture::Wrap::Clamp;
    EXPECT_EQ(red(texture, 1.0, 0.0), 3);
    EXPECT_EQ(red(texture, -5.0, 7.0), 8);
}

TEST(Texture, KnowsHandComputedValues) {
    Texture texture = counting(4, 2);
    EXPECT_EQ(red(texture, 0.5 / 4, 0.25), 0);
    EXPECT_EQ(red(texture, 1.0 / 4, 0.25), 0.5);
    EXPECT_EQ(red(texture, 1.0 / 4, 0.5), 2.5);
    EXPECT_EQ(red(texture, 0.0, 0.25), 1.5) << "half of texel 0, half of texel 3";
    texture.wrap = Texture::Wrap::Clamp;
    EXPECT_EQ(red(texture, 0.0, 0.25), 0);
    EXPECT_EQ(sample_level(texture, Coordinate{1.0 / 4, 0.5, 0}, 0.0),
              (std::array<double, 4>{2.5, -2.5, 0.0, 250.0}));
}

TEST(Texture, MixesLevels) {
    Texture texture = counting(4, 4, 3);
    const auto at = [&](double level) { return red(texture, 0.5, 0.5, level); };
    EXPECT_EQ(at(0), 7.5);
    EXPECT_EQ(at(1), 1001.5);
    EXPECT_EQ(at(0.25), 0.75 * 7.5 + 0.25 * 1001.5);
    EXPECT_EQ(at(2), 2000);
    EXPECT_EQ(at(9), 2000) << "clamped to the chain";
    EXPECT_EQ(at(-3), 7.5);
    texture.mip_filter = Texture::Filter::Nearest;
    EXPECT_EQ(at(0.5), 7.5) << "Vulkan: ceil(d + 0.5) - 1";
    EXPECT_EQ(at(0.51), 1001.5);
    EXPECT_EQ(at(1.75), 2000);
}

TEST(Texture, TakesTheLevelFromTheLongerGradientInTexels) {
    const Texture texture = counting(16, 4);
    const auto level = [&](Coordinate dx, Coordinate dy) {
        return level_of_gradients(texture, dx, dy);
    };
    EXPECT_DOUBLE_EQ(level({1.0 / 16, 0, 0}, {0, 1.0 / 4, 0}), 0);
    EXPECT_DOUBLE_EQ(level({4.0 / 16, 0, 0}, {0, 1.0 / 4, 0}), 2);
    EXPECT_DOUBLE_EQ(level({0, 0, 0}, {0, 2.0 / 4, 0}), 1);
    EXPECT_DOUBLE_EQ(level({3.0 / 16, 4.0 / 4, 0}, {0, 0, 0}), std::log2(5.0));
    EXPECT_EQ(level({0, 0, 0}, {0, 0, 0}), -std::numeric_limits<double>::infinity());
}

TEST(Texture, RoundsWeightsToEightBits) {
    Texture texture = counting(2, 1);
    texture.weights = Texture::Weights::EightBit;
    const auto at = [&](double texel) { return red(texture, (texel + 0.5) / 2, 0.5); };
    EXPECT_EQ(at(0.5), 0.5);
    EXPECT_EQ(at(0.25 + 0.3 / 256), 0.25);
    EXPECT_EQ(at(0.25 + 0.7 / 256), 65.0 / 256);
    EXPECT_EQ(at(1.0 - 0.3 / 256), 1.0) << "rounds up to the next texel";
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const double value = at(random.unit());
        ASSERT_EQ(value * 256, std::round(value * 256));
    }
}

TEST(Texture, ReadsVolumes) {
    Texture texture;
    texture.width = texture.height = 1;
    texture.depth = 4;
    texture.levels = {{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3}};
    ASSERT_TRUE(texture.is_complete());
    EXPECT_EQ(sample_level(texture, Coordinate{0.3, 0.9, 0.375}, 0.0)[0], 1);
    EXPECT_EQ(sample_level(texture, Coordinate{0.3, 0.9, 0.5}, 0.0)[0], 1.5);
    EXPECT_EQ(sample_level(texture, Coordinate{0.3, 0.9, 0.0}, 0.0)[0], 1.5)
        << "half of slice 0, half of slice 3";
}

TEST(Texture, NearestReadsGiveOneTexelOfOneLevel) {
    Random random(9);
    const Texture texture = counting(5, 3, 2);
    for (int i = 0; i < 1000; ++i) {
        const Coordinate at = {random.unit(), random.unit(), 0};
        const double level = random.unit();
        const int coarse = level > 0.5 ? 1 : 0, width = coarse ? 2 : 5, height = coarse ? 1 : 3;
        const int texel = static_cast<int>(at[1] * height) * width + static_cast<int>(at[0] * width);
        ASSERT_EQ(sample_nearest(texture, at, level)[0],
                  texture.levels[static_cast<std::size_t>(coarse)]
                                [static_cast<std::size_t>(texel) * 4])
            << at[0] << ", " << at[1] << " level " << level << " seed 9";
    }
}

TEST(Texture, IsFlatWhereItsTexelsAre) {
    Random random(8);
    Texture texture = counting(5, 3);
    for (float& value : texture.levels[0]) value = 0.1f;
    for (int i = 0; i < 1000; ++i) {
        const std::array<float, 3> coordinate = {random.any_float(), random.any_float(), 0.0f};
        for (float value : sample_level(texture, coordinate, random.any_float()))
            ASSERT_EQ(value, 0.1f);
    }
}

TEST(Texture, SurvivesAnyCoordinate) {
    constexpr double infinity = std::numeric_limits<double>::infinity(),
                     not_a_number = std::numeric_limits<double>::quiet_NaN();
    for (auto wrap : {Texture::Wrap::Repeat, Texture::Wrap::Clamp})
        for (auto filter : {Texture::Filter::Nearest, Texture::Filter::Linear}) {
            Texture texture = counting(4, 4, 2);
            texture.wrap = wrap;
            texture.filter = filter;
            for (double odd :
                 {infinity, -infinity, 1e300, -1e300, 1e-320, 2147483648.0, -4294967297.0})
                for (double level : {0.0, odd})
                    EXPECT_TRUE(std::isfinite(red(texture, odd, 0.3, level))) << odd;
            EXPECT_EQ(red(texture, not_a_number, 0.3), red(texture, 0.0, 0.3));
            EXPECT_EQ(red(texture, 0.4, 0.3, not_a_number), red(texture, 0.4, 0.3, 0.0));
        }
    Texture one = counting(1, 1);
    EXPECT_EQ(red(one, 17.3, -0.2), 0);
    Texture truncated = counting(4, 4);
    truncated.levels[0].resize(20);
    EXPECT_FALSE(truncated.is_complete());
    EXPECT_EQ(red(truncated, 0.7, 0.7), 0);
    EXPECT_EQ(red(Texture{}, 0.5, 0.5), 0);
}

TEST(Texture, IsReadByTheSampleOps) {
    const auto module = parse(R"(pixel "s" input uv float2 interpolant sampler map 2d
        output level float4 target output grad float4 target output implicit float4 target {
        %uv float2 = input uv  %one float1 = const 1.0  %dx float2 = const (0.5, 0.0)  %dy float2 = const (0.0, 0.25)
        %a float4 = sample_level map %uv, %one  %b float4 = sample_grad map %uv, %dx, %dy
        %c float4 = sample map %uv  return (%a, %b, %c) })",
                              "s.ir");
    ASSERT_TRUE(module) << to_string(module.error());
    const Texture texture = counting(4, 4, 3);
    Environment environment{.inputs = {{0.5, 0.5}}, .samplers = {&texture}};
    const Evaluator evaluator(*module);
    Evaluation evaluation = evaluator.run(environment, Precision::Double);
    EXPECT_EQ(evaluation.texture_reads, 3);
    EXPECT_EQ(evaluation.outputs[0][0], 1001.5);
    EXPECT_EQ(evaluation.outputs[1][0], 1001.5) << "half the map a pixel is two texels: level 1";
    EXPECT_EQ(evaluation.outputs[2][0], 7.5) << "no neighbours: level 0";
    environment.right_inputs = {{1.5, 0.5}};
    environment.lower_inputs = {{0.5, 0.5}};
    evaluation = evaluator.run(environment, Precision::Double);
    EXPECT_EQ(evaluation.outputs[2][0], 2000) << "the whole map a pixel is four texels: level 2";
    EXPECT_EQ(evaluation.texture_reads, 3) << "neighbours do not count";
}

TEST(Texture, IsReadAsTheSamplerSays) {
    const auto module = parse(R"(pixel "s" sampler soft 3d sampler hard 3d nearest "as it is"
        output a float4 target output b float4 target {
        %at float3 = const (0.3, 0.9, 0.45)  %zero float1 = const 0.0
        %a float4 = sample_level soft %at, %zero  %b float4 = sample_level hard %at, %zero
        return (%a, %b) })",
                              "s.ir");
    ASSERT_TRUE(module) << to_string(module.error());
    Texture texture;
    texture.depth = 4;
    texture.levels = {{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3}};
    const Environment environment{.samplers = {&texture, &texture}};
    const Evaluation evaluation = Evaluator(*module).run(environment, Precision::Double);
    EXPECT_NEAR(evaluation.outputs[0][0], 1.3, 1e-6) << "the constant 0.45 is a float";
    EXPECT_EQ(evaluation.outputs[1][0], 1);
}

}  // namespace
}  // namespace intaglio::ir

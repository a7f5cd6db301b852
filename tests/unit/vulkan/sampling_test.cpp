// Textures as the device samples them, against the texels themselves and an exact bilinear filter
// in double.
#include <cmath>
#include <random>

#include "tests/unit/vulkan/harness.h"

namespace intaglio::vulkan {
namespace {

class SamplingTest : public OnDevice {};

Texture random_texture(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> step(0, 255);  // exact in every format that has these steps
    Texture texture;
    texture.width = width;
    texture.height = height;
    texture.levels.emplace_back();
    for (int i = 0; i < 4 * width * height; ++i)
        texture.levels[0].push_back(static_cast<float>(step(random)) / 255);
    return texture;
}

std::array<double, 4> texel(const Texture& texture, int x, int y) {
    const auto wrap = [&](int at, int size) {
        if (texture.wrap == Texture::Wrap::Clamp) return std::min(std::max(at, 0), size - 1);
        return ((at % size) + size) % size;
    };
    const int column = wrap(x, texture.width), row = wrap(y, texture.height);
    const float* from =
        &texture.levels[0][4 * static_cast<std::size_t>(row * texture.width + column)];
    return {from[0], from[1], from[2], from[3]};
}

std::array<double, 4> bilinear(const Texture& texture, double u, double v) {
    const double x = u * texture.width - 0.5, y = v * texture.height - 0.5;
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    const double fx = x - left, fy = y - top;
    std::array<double, 4> result{};
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const auto t = texel(texture, left + i, top + j);
            const double weight = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
            for (std::size_t k = 0; k < 4; ++k) result[k] += weight * t[k];
        }
    }
    return result;
}

Stage scaled_read() {
    return glsl_fragment(R"(
        layout(location = 0) in vec2 uv;
        layout(binding = 1) uniform sampler2D height_map;
        layout(binding = 2) uniform Reading { float level; vec2 scale; };
        layout(location = 0) out vec4 color;
        void main() { color = textureLod(height_map, uv * scale, level); })");
}

TEST_F(SamplingTest, NearestReturnsEveryTexel) {
    for (const auto format : {Texture::Format::Rgba8Unorm, Texture::Format::Rgba16Unorm,
                              Texture::Format::Rgba32Float}) {
        Texture texture = random_texture(32, 32, 5);
        texture.filter = Texture::Filter::Nearest;
        texture.format = format;
        Draw draw = quad_draw(scaled_read(), 32);
        draw.textures["height_map"] = &texture;
        draw.uniforms = {{"level", {0}}, {"scale", {1, 1}}};
        const Picture picture = drawn(device(), draw).at(0);
        // A float comes back as it is; a step n / 255 or n / 65535 may be decoded with a rounded
        // reciprocal, which costs at most an ulp of 1.
        const double allowed = format == Texture::Format::Rgba32Float ? 0 : 1.2e-7;
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 32; ++x) {
                const auto expected = texel(texture, x, y);
                for (std::size_t k = 0; k < 4; ++k) {
                    ASSERT_NEAR(picture.at(x, y)[k], expected[k], allowed)
                        << x << ", " << y << " seed 5, format " << static_cast<int>(format);
                }
            }
        }
    }
}

TEST_F(SamplingTest, MipLevelsAreTheGivenOnes) {
    Texture texture;
    texture.width = 8;
    texture.height = 2;
    texture.format = Texture::Format::Rgba32Float;
    for (int l = 0; l < 4; ++l) {
        const std::size_t texels =
            static_cast<std::size_t>(std::max(1, 8 >> l) * std::max(1, 2 >> l));
        texture.levels.emplace_back(4 * texels, static_cast<float>(10 * l));
    }
    Draw draw = quad_draw(scaled_read(), 4);
    draw.textures["height_map"] = &texture;
    draw.uniforms = {{"level", {0}}, {"scale", {1, 1}}};
    auto program = Program::prepare(device(), draw);
    ASSERT_TRUE(program.ok()) << to_string(program.error());
    for (const float level : {0.0f, 1.0f, 1.5f, 2.0f, 3.0f, 9.0f}) {
        ASSERT_TRUE(program->set_uniform("level", {level}).ok());
        const auto pictures = program->draw();
        ASSERT_TRUE(pictures.ok());
        EXPECT_EQ((*pictures)[0].at(1, 1)[0], std::min(30.0f, 10 * level)) << "level " << level;
    }
}

TEST_F(SamplingTest, BilinearAgreesWithTheExactFilter) {
    struct Bound {
        Texture::Format format;
        double allowed;
    };
    // lavapipe filters RGBA8 with 8-bit weights and results (1.5 steps of 255 measured), wider
    // formats in float.
    for (const Bound& bound :
         {Bound{Texture::Format::Rgba8Unorm, 6e-3}, Bound{Texture::Format::Rgba16Unorm, 1e-6},
          Bound{Texture::Format::Rgba32Float, 1e-6}}) {
        for (const auto wrap : {Texture::Wrap::Repeat, Texture::Wrap::Clamp}) {
            Texture texture = random_texture(12, 20, 9);
            texture.format = bound.format;
            texture.wrap = wrap;
            const float scale_u = 1.75f, scale_v = 1.25f;  // beyond 1, so that wrapping shows
            Draw draw = quad_draw(scaled_read(), 128);
            draw.textures["height_map"] = &texture;
            draw.uniforms = {{"level", {0}}, {"scale", {scale_u, scale_v}}};
            const Picture picture = drawn(device(), draw).at(0);
            double worst = 0;
            for (int y = 0; y < 128; ++y) {
                for (int x = 0; x < 128; ++x) {
                    const auto expected =
                        bilinear(texture, (x + 0.5) / 128 * scale_u, (y + 0.5) / 128 * scale_v);
                    for (std::size_t k = 0; k < 4; ++k) {
                        worst = std::max(worst, std::abs(picture.at(x, y)[k] - expected[k]));
                    }
                }
            }
            EXPECT_LE(worst, bound.allowed) << "seed 9, format " << static_cast<int>(bound.format);
            EXPECT_GT(worst, 0) << "interpolation between random texels rounds somewhere";
        }
    }
}

TEST_F(SamplingTest, SeparateImagesAndSamplersOfHlsl) {
    const std::string hlsl = R"(
        Texture2D height_map : register(t0);
        Texture2D height : register(t1);
        SamplerState height_map_sampler : register(s0);
        SamplerState heightSampler : register(s1);
        float4 main(float2 uv : TEXCOORD0) : SV_Target {
            return float4(height_map.SampleLevel(height_map_sampler, uv, 0).xy,
                          height.SampleLevel(heightSampler, uv, 0).xy);
        })";
    Texture sharp = random_texture(4, 4, 2), smooth = random_texture(4, 4, 3);
    sharp.format = smooth.format = Texture::Format::Rgba32Float;
    sharp.filter = Texture::Filter::Nearest;
    Draw draw = quad_draw(compile(check::Language::Hlsl5, check::Stage::Pixel, hlsl), 32);
    draw.vertex = compile(check::Language::Hlsl5, check::Stage::Vertex, R"(
        struct Corner { float3 position : POSITION; float2 uv : TEXCOORD0; };
        struct Varyings { float2 uv : TEXCOORD0; float4 place : SV_Position; };
        Varyings main(Corner input) {
            Varyings output;
            output.place = float4(input.position.xy * 2 - 1, 0, 1);
            output.uv = input.uv;
            return output;
        })");
    draw.textures = {{"height", &smooth}, {"height_map", &sharp}};
    const Picture picture = drawn(device(), draw).at(0);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const auto nearest = texel(sharp, x / 8, y / 8);
            const auto linear = bilinear(smooth, (x + 0.5) / 32, (y + 0.5) / 32);
            ASSERT_EQ(picture.at(x, y)[0], static_cast<float>(nearest[0]))
                << x << ", " << y << " seed 2";
            ASSERT_NEAR(picture.at(x, y)[2], linear[0], 1e-6) << x << ", " << y << " seed 3";
        }
    }
}

TEST_F(SamplingTest, TexturesLargerThanTheDeviceAllowsAreASentence) {
    Texture wide;
    wide.width = 1 << 20;
    wide.height = 1;
    wide.levels.emplace_back(std::size_t{4} << 20);
    Draw draw = quad_draw(scaled_read(), 4);
    draw.textures["height_map"] = &wide;
    draw.uniforms = {{"level", {0}}, {"scale", {1, 1}}};
    EXPECT_THAT(refusal(device(), draw),
                testing::AllOf(testing::HasSubstr("texture 'height_map' is 1048576 by 1 texels"),
                               testing::HasSubstr("[too-large]")));
}

}  // namespace
}  // namespace intaglio::vulkan

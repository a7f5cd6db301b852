// The chain of witnesses on shaders written by hand, in every language.
#include "src/check/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/check/derive.h"
#include "src/check/frontend.h"
#include "src/check/spirv.h"
#include "tests/unit/check/shaders.h"

namespace intaglio::check {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class JudgeEachLanguage : public ::testing::TestWithParam<Language> {};

TEST_P(JudgeEachLanguage, AcceptsTheParallaxShaders) {
    for (const Source& source : {parallax_pixel(GetParam()), parallax_vertex(GetParam())}) {
        const Result<Witnessed> witnessed = judge(source);
        ASSERT_TRUE(witnessed.ok()) << to_string(witnessed.error()) << "\n" << source.text;
        EXPECT_EQ(witnessed->crossed.size(), 4u);
        EXPECT_EQ(witnessed->steps.front(), "glslang " + std::string(name_of(GetParam())));
        EXPECT_EQ(witnessed->steps.size(), 15u);
        EXPECT_TRUE(validate_spirv(witnessed->words).ok());
        EXPECT_TRUE(validate_spirv(witnessed->optimized).ok());
    }
}

TEST_P(JudgeEachLanguage, RefusesAnUndeclaredNameWithItsLine) {
    Source source = parallax_pixel(GetParam());
    const int line = static_cast<int>(
        std::count(
            source.text.begin(),
            source.text.begin() + static_cast<std::ptrdiff_t>(source.text.find("float t = 0.0;")),
            '\n') +
        1);
    source.text = replaced(source.text, "float t = 0.0;", "float t = no_such_name;");
    const Result<Witnessed> witnessed = judge(source);
    ASSERT_FALSE(witnessed.ok());
    EXPECT_THAT(witnessed.error().message, HasSubstr("no_such_name"));
    EXPECT_EQ(witnessed.error().line, line);
    EXPECT_EQ(witnessed.error().file, "parallax.pixel");
    EXPECT_THAT(witnessed.error().notes, ElementsAre(HasSubstr("float t = no_such_name;")));
}

TEST_P(JudgeEachLanguage, DerivesMetalAndBinary) {
    const Result<std::string> metal = derive_msl(parallax_pixel(GetParam()));
    ASSERT_TRUE(metal.ok()) << to_string(metal.error());
    EXPECT_THAT(*metal, HasSubstr("fragment main0_out main0("));
    const Result<SpirvWords> words = derive_spirv(parallax_pixel(GetParam()));
    ASSERT_TRUE(words.ok()) << to_string(words.error());
    const Result<Witnessed> witnessed = judge(parallax_pixel(GetParam()));
    ASSERT_TRUE(witnessed.ok());
    EXPECT_EQ(*words, witnessed->optimized) << "two ways to the same binary differ";
}

INSTANTIATE_TEST_SUITE_P(Languages, JudgeEachLanguage, ::testing::ValuesIn(spirv_languages),
                         [](const auto& instance) { return std::string(name_of(instance.param)); });

TEST(Judge, OldGlslEndsAfterTheFrontEnd) {
    for (const Language language : {Language::Glsl120, Language::Essl100}) {
        for (const Source& source : {parallax_pixel(language), parallax_vertex(language)}) {
            const Result<Witnessed> witnessed = judge(source);
            ASSERT_TRUE(witnessed.ok()) << to_string(witnessed.error());
            EXPECT_THAT(witnessed->steps, ElementsAre("glslang " + std::string(name_of(language))));
            EXPECT_TRUE(witnessed->words.empty());
            const Result<SpirvWords> words = to_spirv(source);
            ASSERT_FALSE(words.ok());
            EXPECT_EQ(words.error().code, "no-spirv");
        }
    }
}

// What the techniques need beyond the parallax shader: each kind of fetch, discard, integers,
// several outputs.
TEST(Judge, AcceptsEveryKindOfFetch) {
    const std::string glsl =
        "uniform sampler2D height_map;\nuniform sampler2D normal_map;\nuniform int steps;\n"
        "in vec2 uv;\nlayout(location = 0) out vec4 color;\nlayout(location = 1) out vec4 "
        "displaced;\n"
        "void main() {\n"
        "    if (texture(normal_map, uv).a < 0.5) discard;\n"
        "    vec2 dx = dFdx(uv);\n    vec2 dy = dFdy(uv);\n    vec4 sum = vec4(0.0);\n"
        "    for (int i = 0; i < steps; ++i) {\n"
        "        sum += textureGrad(height_map, uv * float(i), dx, dy);\n"
        "        if (sum.x > 4.0) break;\n    }\n"
        "    sum += texelFetch(height_map, ivec2(uv * vec2(textureSize(height_map, 0))), 0);\n"
        "    color = sum + textureLod(height_map, uv, 1.0);\n"
        "    displaced = inversesqrt(sum) + pow(sum, vec4(2.0)) + fract(uv.xyxy);\n}\n";
    const std::string hlsl_5 =
        "cbuffer Globals : register(b0) { int steps; };\n"
        "Texture2D height_map : register(t0);\nTexture2D normal_map : register(t1);\n"
        "SamplerState wrap : register(s0);\n"
        "struct Result { float4 color : SV_Target0; float4 displaced : SV_Target1; };\n"
        "Result main(float2 uv : TEXCOORD0) {\n"
        "    if (normal_map.Sample(wrap, uv).a < 0.5) discard;\n"
        "    float2 dx = ddx(uv);\n    float2 dy = ddy(uv);\n    precise float4 sum = 0.0;\n"
        "    [loop] for (int i = 0; i < steps; ++i) {\n"
        "        sum += height_map.SampleGrad(wrap, uv * i, dx, dy);\n"
        "        if (sum.x > 4.0) break;\n    }\n"
        "    uint width, height;\n    height_map.GetDimensions(width, height);\n"
        "    sum += height_map.Load(int3(uv * float2(width, height), 0));\n"
        "    Result result;\n"
        "    result.color = sum + height_map.SampleLevel(wrap, uv, 1.0);\n"
        "    result.displaced = rsqrt(sum) + pow(sum, 2.0) + frac(uv.xyxy);\n"
        "    return result;\n}\n";
    const std::string hlsl_3 =
        "sampler2D height_map : register(s0);\nsampler2D normal_map : register(s1);\nint steps;\n"
        "struct Result { float4 color : COLOR0; float4 displaced : COLOR1; };\n"
        "Result main(float2 uv : TEXCOORD0) {\n"
        "    if (tex2D(normal_map, uv).a < 0.5) discard;\n"
        "    float2 dx = ddx(uv);\n    float2 dy = ddy(uv);\n    float4 sum = 0.0;\n"
        "    [loop] for (int i = 0; i < steps; ++i) {\n"
        "        sum += tex2Dgrad(height_map, uv * i, dx, dy);\n"
        "        if (sum.x > 4.0) break;\n    }\n"
        "    Result result;\n"
        "    result.color = sum + tex2Dlod(height_map, float4(uv, 0.0, 1.0));\n"
        "    result.displaced = rsqrt(sum) + pow(sum, 2.0) + frac(uv.xyxy);\n"
        "    return result;\n}\n";
    const std::vector<std::pair<Language, std::string>> texts = {
        {Language::Glsl330, "#version 330\n" + glsl},
        {Language::Essl300,
         "#version 300 es\nprecision highp float;\nprecision highp sampler2D;\n" + glsl},
        {Language::Hlsl5, hlsl_5},
        {Language::Hlsl3, hlsl_3}};
    for (const auto& [language, text] : texts) {
        const Result<Witnessed> witnessed =
            judge({.language = language, .stage = Stage::Pixel, .text = text, .name = "fetches"});
        EXPECT_TRUE(witnessed.ok()) << name_of(language) << ": " << to_string(witnessed.error());
    }
}

// A triangle without buffers: each GLSL numbers vertices under a name of its own, Vulkan knows one.
TEST(Judge, AcceptsVertexNumbers) {
    const std::string glsl =
        "void main() {\n    gl_Position = vec4(float(NUMBER & 1), float(NUMBER >> 1), 0.0, "
        "1.0);\n}\n";
    const std::vector<std::pair<Language, std::string>> texts = {
        {Language::Glsl450, "#version 450\n#define NUMBER gl_VertexIndex\n" + glsl},
        {Language::Glsl330, "#version 330\n#define NUMBER gl_VertexID\n" + glsl},
        {Language::Essl300, "#version 300 es\n#define NUMBER gl_VertexID\n" + glsl},
        {Language::Hlsl5,
         "float4 main(uint number : SV_VertexID) : SV_Position {\n"
         "    return float4(number & 1, number >> 1, 0.0, 1.0);\n}\n"}};
    for (const auto& [language, text] : texts) {
        const Result<Witnessed> witnessed =
            judge({.language = language, .stage = Stage::Vertex, .text = text, .name = "numbers"});
        EXPECT_TRUE(witnessed.ok()) << name_of(language) << ": " << to_string(witnessed.error());
    }
}

}  // namespace
}  // namespace intaglio::check

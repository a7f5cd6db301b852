// The languages of old hardware: what their texts ask for, what changes on the way to them and is
// said in a note, and what they refuse.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "tests/unit/target/programs.h"

namespace intaglio {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// One texture read at a level.
ir::Program reading(std::string_view level, std::string_view dimension = "2d") {
    return testing::program_of(testing::parsed(fmt::format(
        R"(
pixel "p"
input uv float{} interpolant
output to float4 target
sampler map {}
file "templates/search/mine.cpp"
{{
    %uv float{} = input uv
    %level float1 = const {}
    %texel float4 = sample_level map %uv, %level @0:7
    return (%texel)
}})",
        dimension == "3d" ? 3 : 2, dimension, dimension == "3d" ? 3 : 2, level)));
}

TEST(ShaderModel2, LeavesTheLevelToTheHardwareAndSaysSo) {
    const ir::Program program = testing::program_of(testing::parsed(R"(
pixel "p"
input uv float2 interpolant
output to float4 target
uniform scale float2
sampler map 2d
{
    %uv float2 = input uv
    %scale float2 = uniform scale
    %scaled float2 = mul %uv, %scale
    %along float2 = ddx %scaled
    %down float2 = ddy %scaled
    %zero float1 = const 0.0
    %a float4 = sample_level map %uv, %zero
    %b float4 = sample_grad map %uv, %along, %down
    %sum float4 = add %a, %b
    return (%sum)
})"));
    for (std::string_view name : {"hlsl_2_0", "hlsl_2_b"}) {
        const Artifact artifact = testing::emitted(program, ir::Stage::Pixel, name);
        EXPECT_THAT(artifact.text, HasSubstr("tex2D(map, pixel.uv)"));
        for (const char* gone : {"lod", "grad", "ddx", "ddy", "scale"})
            EXPECT_THAT(artifact.text, Not(HasSubstr(gone)));
        ASSERT_EQ(artifact.notes.size(), 1u);
        EXPECT_THAT(artifact.notes[0], HasSubstr("1 read at level 0 and 1 read with gradients"));
    }
    EXPECT_TRUE(testing::emitted(program, ir::Stage::Pixel, "hlsl_3_0").notes.empty());
}

TEST(ShaderModel2, RefusesWhatTheProfilesCannotSay) {
    const auto refusal = [](const ir::Program& program, std::string_view target) {
        const auto artifact = emit(program, *find_target(target));
        EXPECT_FALSE(artifact.ok()) << (artifact.ok() ? artifact->pixel.text : "");
        return artifact.ok() ? "" : to_string(artifact.error());
    };
    EXPECT_EQ(
        refusal(reading("1.5"), "hlsl_2_0"),
        "templates/search/mine.cpp:7: error: hlsl_2_0 has no texture reads with a given level "
        "other than 0 [target-limit]\n"
        "  hint: level=0, nyquist=0, max_leaps=0 or shadow_leaps=0, where they are what gives "
        "it\n"
        "  hint: hlsl_5_0, hlsl_3_0 can");

    constexpr std::string_view march = R"(
pixel "p"
input uv float2 interpolant
output to float4 target
sampler map 2d
{{
    %uv float2 = input uv
    %zero float1 = const 0.0
    %start float4 = compose %uv, %uv
    %end float4 = loop "march" {} rolled (%start) {{
    (%i int1, %sum float4):
        %at float2 = swizzle %sum.xy
        %texel float4 = sample_level map %at, %zero
        %next float4 = add %sum, %texel
        yield (%next)
    }}
    return (%end)
}})";
    const auto program = [&](int trips) {
        return testing::program_of(testing::parsed(fmt::format(march, trips)));
    };
    EXPECT_EQ(refusal(program(33), "hlsl_2_0"),
              "error: p reads textures more than 32 times once its loops are unrolled, and "
              "hlsl_2_0 allows no more [target-limit]\n"
              "  hint: try fewer taps or steps");
    // Not unrolled to be refused.
    EXPECT_EQ(refusal(program(1 << 24), "hlsl_2_0"), refusal(program(33), "hlsl_2_0"));
    EXPECT_TRUE(emit(program(32), *find_target("hlsl_2_0")).ok());
    EXPECT_TRUE(emit(program(33), *find_target("hlsl_2_b")).ok());
}

TEST(OldGlsl, AsksForTheExtensionsThatItsReadsNeed) {
    const auto pixel = [](std::string_view target) {
        return testing::emitted(reading("1.5"), ir::Stage::Pixel, target).text;
    };
    EXPECT_THAT(pixel("glsl_120"), HasSubstr("#extension GL_ARB_shader_texture_lod : require\n"));
    EXPECT_THAT(pixel("glsl_120"), HasSubstr("gl_FragColor = texture2DLod(map, uv, 1.5);"));
    EXPECT_THAT(pixel("essl_100"), HasSubstr("#extension GL_EXT_shader_texture_lod : require\n"));
    EXPECT_THAT(pixel("essl_100"), HasSubstr("gl_FragColor = texture2DLodEXT(map, uv, 1.5);"));
    for (std::string_view target : {"glsl_120", "essl_100"})
        EXPECT_THAT(testing::emitted(reading("1.5"), ir::Stage::Vertex, target).text,
                    Not(HasSubstr("#extension")));
}

TEST(OldGlsl, RefusesWhatTheLanguagesLack) {
    ir::Program two = reading("0.0");
    two.pixel.outputs.push_back({"also", ir::float4, ir::Semantic::Target});
    two.pixel.body.body.back().operands.push_back(two.pixel.body.body.back().operands[0]);
    for (const auto& [program, target, sentence] :
         {std::tuple{reading("1.0", "3d"), "essl_100", "essl_100 has no volume textures"},
          std::tuple{two, "essl_100", "p has 2 colour outputs; essl_100 can write 1"}}) {
        const auto artifact = emit(program, *find_target(target));
        ASSERT_FALSE(artifact.ok());
        EXPECT_EQ(artifact.error().message, sentence);
    }
}

}  // namespace
}  // namespace intaglio

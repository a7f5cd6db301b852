// The Direct3D 9 profiles as rows of the table: what emit gives, and what it refuses.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/resources.h"
#include "tests/unit/target/programs.h"

namespace intaglio {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::string_view pixel_text = R"(
pixel "p"
input uv float2 interpolant
input tint float3 interpolant
output colour float4 target
uniform strength float1 "of the texel"
sampler map 2d "what is shown"
file "templates/shading/mine.cpp"
step show "Show the texel."
{
    %uv float2 = input uv
    %tint float3 = input tint
    %strength float1 = uniform strength
    %texel float4 = sample map %uv @0:7 #show
    %strengths float3 = swizzle %strength.xxx
    %rgb float3 = swizzle %texel.xyz
    %strong float3 = mul %rgb, %strengths @0:8 #show
    %sum float3 = add %strong, %tint @0:9 #show
    %one float1 = const 1.0
    %colour float4 = compose %sum, %one
    return (%colour)
})";

ir::Program program() { return testing::program_of(testing::parsed(pixel_text)); }

std::vector<std::uint32_t> words_of(const std::string& bytes) {
    std::vector<std::uint32_t> words(bytes.size() / 4);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        words[i / 4] |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * (i % 4));
    return words;
}

d3d9::Shader decoded(const Artifact& artifact, std::string_view target) {
    EXPECT_EQ(artifact.bytecode.bytes.size() % 4, 0u);
    const auto shader =
        d3d9::decode(words_of(artifact.bytecode.bytes), d3d9::profile_named(target));
    EXPECT_TRUE(shader.ok()) << to_string(shader.error());
    return shader.ok() ? *shader : d3d9::Shader{};
}

TEST(Direct3D9, GivesTextAndBytesOfBothStages) {
    for (const auto& [target, vertex] : {std::pair{"ps_2_0", "vs_2_0"},
                                         {"ps_2_a", "vs_2_0"},
                                         {"ps_2_b", "vs_2_0"},
                                         {"ps_3_0", "vs_3_0"}}) {
        const auto both = emit(program(), *find_target(target));
        ASSERT_TRUE(both.ok()) << to_string(both.error());
        for (const auto& [artifact, profile, extension, code] :
             {std::tuple{&both->pixel, target, ".psh", ".pso"},
              {&both->vertex, vertex, ".vsh", ".vso"}}) {
            EXPECT_EQ(artifact->extension, extension);
            EXPECT_EQ(artifact->bytecode.extension, code);
            const d3d9::Shader shader = decoded(*artifact, target);
            EXPECT_EQ(name_of(shader.profile), profile);
            const auto parsed = d3d9::parse(artifact->text, "text", d3d9::profile_named(target));
            ASSERT_TRUE(parsed.ok()) << to_string(parsed.error()) << artifact->text;
            EXPECT_EQ(*parsed, shader) << artifact->text;
        }
        EXPECT_EQ(both->pixel.stage, ir::Stage::Pixel);
        EXPECT_EQ(both->vertex.stage, ir::Stage::Vertex);
    }
}

TEST(Direct3D9, ListsWhatToBindWhatIsLeftAndWhoSpends) {
    const auto both = emit(program(), *find_target("ps_2_0"));
    ASSERT_TRUE(both.ok()) << to_string(both.error());
    const d3d9::Resources used = d3d9::count(decoded(both->pixel, "ps_2_0"));
    EXPECT_THAT(
        both->pixel.text,
        AllOf(HasSubstr("// test: pixel stage for ps_2_0\n"),
              HasSubstr("// c0 strength: of the texel\n"), HasSubstr("// s0 map: what is shown\n"),
              HasSubstr("// Show the texel.\n"), HasSubstr("show: templates/shading/mine.cpp:7\n"),
              HasSubstr(fmt::format("// {:>4} of 64   arithmetic slots\n", used.arithmetic)),
              HasSubstr("//    1 of 32   texture slots\n")));
}

TEST(Direct3D9, AVertexProfileStandsAlone) {
    for (const char* target : {"vs_2_0", "vs_3_0"}) {
        EXPECT_FALSE(find_target(target)->pixel_stage);
        const auto both = emit(program(), *find_target(target));
        ASSERT_TRUE(both.ok()) << to_string(both.error());
        EXPECT_EQ(name_of(decoded(both->vertex, target).profile), target);
        EXPECT_EQ(both->pixel.text, "");
        EXPECT_EQ(both->pixel.bytecode.bytes, "");
    }
}

TEST(Direct3D9, CountsItsOwnReads) {
    EmitOptions options;
    options.count_reads = true;
    const auto both = emit(program(), *find_target("ps_2_0"), options);
    ASSERT_TRUE(both.ok()) << to_string(both.error());
    const d3d9::Shader shader = decoded(both->pixel, "ps_2_0");
    EXPECT_EQ(d3d9::count(shader).colour_outputs, 2);
    EXPECT_EQ(d3d9::count(shader).texture, 1);
}

TEST(Direct3D9, RefusalsAreToldFromErrors) {
    for (const char* code : {"target-limit", "d3d9-limit", "d3d9-level", "d3d9-op", "d3d9-texture"})
        EXPECT_TRUE(is_refusal(input_error(code, "")));
    for (const char* code : {"knob-range", "target-derived", "d3d9-round-trip", ""})
        EXPECT_FALSE(is_refusal(input_error(code, "")));
}

TEST(Direct3D9, HasNoListOfPassesToShow) {
    const EmitOptions options{[](std::string_view, const ir::Module&) {}};
    const auto both = emit(program(), *find_target("ps_2_0"), options);
    ASSERT_FALSE(both.ok());
    EXPECT_EQ(to_string(both.error()),
              "error: ps_2_0 is the smallest of several attempts, so there is no one list of "
              "passes to show; the target none shows the common ones [dump-ir]");
}

}  // namespace
}  // namespace intaglio

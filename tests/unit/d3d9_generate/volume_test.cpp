// Volumes in Direct3D 9: declared as such, read with three coordinates, in every pixel profile.
#include <gmock/gmock.h>

#include <random>

#include "generator/ir/evaluate.h"
#include "generator/ir/parse.h"
#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/interpret.h"
#include "generator/target/d3d9/legality.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

using ::testing::HasSubstr;

// Two reads, the second at a coordinate that the first moves, as sphere tracing does.
ir::Program tracing(std::string_view level) {
    const std::string text = std::string(R"(
pixel "tracing"
input at float3 interpolant
output colour float4 target
uniform step float3
sampler distance_map 3d nearest
{
    %at float3 = input at
    %step float3 = uniform step
    %level float1 = const )") +
                             std::string(level) + R"(
    %first float4 = sample_level distance_map %at, %level
    %reach float3 = swizzle %first.xxx
    %move float3 = mul %reach, %step
    %next float3 = add %at, %move
    %second float4 = sample_level distance_map %next, %level
    %sum float4 = add %first, %second
    return (%sum)
})";
    const auto pixel = ir::parse(text, "tracing.ir");
    const auto vertex = ir::parse(R"(
vertex "tracing"
input place float3 attribute
output position float4 position
output at float3 interpolant
{
    %place float3 = input place
    %one float1 = const 1.0
    %clip float4 = compose %place, %one
    return (%clip, %place)
})",
                                  "tracing.ir");
    EXPECT_TRUE(pixel && vertex);
    ir::Program program;
    program.name = "tracing";
    program.pixel = *pixel;
    program.vertex = *vertex;
    return program;
}

TEST(Volume, IsReadByEveryProfile) {
    ir::Texture texture;
    texture.width = 4;
    texture.height = 2;
    texture.depth = 8;
    std::mt19937 random(33);
    std::uniform_real_distribution<float> unit(0, 1);
    texture.levels.emplace_back();
    for (int i = 0; i < 4 * 4 * 2 * 8; ++i) texture.levels[0].push_back(unit(random));
    for (const Profile profile : pixel_profiles()) {
        const ir::Program program = tracing("0.0");
        std::vector<std::string> notes;
        const auto shader = generate_pixel(program, profile, &notes);
        ASSERT_TRUE(shader) << to_string(shader.error());
        EXPECT_TRUE(check(*shader).empty()) << print(*shader);
        EXPECT_THAT(print(*shader), HasSubstr("dcl_volume s0"));
        EXPECT_THAT(notes, ::testing::Contains(HasSubstr("distance_map must be sampled nearest")));
        texture.filter = texture.mip_filter = ir::Texture::Filter::Nearest;
        const auto environment =
            environment_of(*shader, {{"step", {0.1f, -0.2f, 0.3f}}}, {{"distance_map", &texture}});
        ASSERT_TRUE(environment) << to_string(environment.error());
        const auto interpreter = Interpreter::prepare(*shader);
        ASSERT_TRUE(interpreter) << to_string(interpreter.error());
        texture.filter = ir::Texture::Filter::Linear;  // the IR's own sampler says nearest
        const ir::Environment::Vector step = {0.1f, -0.2f, 0.3f};
        ir::Environment expected;
        expected.inputs.emplace_back();
        expected.uniforms.push_back({step});
        expected.samplers = {&texture};
        for (int i = 0; i < 200; ++i) {
            Inputs inputs;
            for (std::size_t k = 0; k < 3; ++k) {
                const float coordinate = 2 * unit(random) - 0.5f;
                inputs.texcoords[0][k] = inputs.attributes[0][k] = coordinate;
                expected.inputs[0][k] = static_cast<double>(coordinate);
            }
            texture.filter = ir::Texture::Filter::Nearest;
            const Execution got = interpreter->run(*environment, inputs, Arithmetic::Fp32);
            texture.filter = ir::Texture::Filter::Linear;
            const auto want = ir::Evaluator(program.pixel).run(expected, ir::Precision::Single);
            for (std::size_t k = 0; k < 4; ++k)
                ASSERT_NEAR(static_cast<double>(got.colours[0][k]), want.outputs[0][k], 1e-6)
                    << name_of(profile) << " pixel " << i << " seed 33\n"
                    << print(*shader);
        }
    }
}

TEST(Volume, TakesItsLevelOnlyWhereTheProfileCan) {
    const auto refused = generate_pixel(tracing("1.0"), Profile::ps_2_b);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, "d3d9-level");
    const auto shader = generate_pixel(tracing("1.0"), Profile::ps_3_0);
    ASSERT_TRUE(shader) << to_string(shader.error());
    EXPECT_THAT(print(*shader), HasSubstr("texldl"));
}

}  // namespace
}  // namespace intaglio::d3d9

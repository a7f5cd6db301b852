// What pixel shaders write beside colours: a depth, and whether the pixel is there at all.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/interpret.h"
#include "generator/target/d3d9/legality.h"
#include "tests/unit/d3d9_generate/comparison.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

class Outputs : public ::testing::TestWithParam<Profile> {};
INSTANTIATE_TEST_SUITE_P(Profiles, Outputs, ::testing::ValuesIn(pixel_profiles()),
                         [](const auto& test) { return std::string(name_of(test.param)); });

int count_ops(const Shader& shader, Opcode op) {
    int count = 0;
    for (const Instruction& instruction : shader.instructions) count += instruction.op == op;
    return count;
}
int count_depths(const Shader& shader) {
    int count = 0;
    for (const Instruction& instruction : shader.instructions)
        count += instruction.destination && instruction.destination->file == File::DepthOut;
    return count;
}

TEST_P(Outputs, AreWhatTheProgramSays) {
    int refused = 0;
    for (const Case& a_case : output_cases()) {
        SCOPED_TRACE(a_case.name());
        const auto program = record(a_case, GetParam());
        ASSERT_TRUE(program) << program.error().message;
        const auto shader = generate_pixel(*program, GetParam());
        if (!shader) {
            EXPECT_EQ(shader.error().code, "d3d9-limit") << shader.error().message;
            ++refused;
            continue;
        }
        const auto violations = check(*shader);
        EXPECT_TRUE(violations.empty()) << violations[0].message << print(*shader);
        constexpr int pixels = 400;
        // A hit at another step moves depth and place, too.
        EXPECT_LE(count_differences(*program, *shader, pixels), pixels / 100) << print(*shader);
        int depths = 0, clips = 0;
        for (const ir::Declaration& output : program->pixel.outputs) {
            depths += output.semantic == ir::Semantic::Depth;
            clips += output.semantic == ir::Semantic::Clip;
        }
        EXPECT_EQ(count_depths(*shader), depths);
        EXPECT_EQ(count_ops(*shader, Opcode::Texkill), clips);
        const auto decoded = decode(encode(*shader));
        ASSERT_TRUE(decoded) << decoded.error().message;
        EXPECT_EQ(encode(*decoded), encode(*shader));
    }
    // A search or a shadow, shading, depth and the tile's edge at once are too much for 64 slots,
    // and one of them reads deeper than four.
    const int too_much[] = {3, 0, 1, 0};
    EXPECT_EQ(refused, too_much[static_cast<std::size_t>(GetParam())]);
}

TEST_P(Outputs, CostOneSlotEachBesideWhatComputesThem) {
    const auto slots = [](const Case& a_case) {
        const auto shader = generate_pixel(*record(a_case, GetParam()), GetParam());
        EXPECT_TRUE(shader) << (shader ? "" : shader.error().message);
        return shader ? slots_of(*shader) : Slots{};
    };
    const Slots plain = slots({"bump,output=displaced", {}});
    const Slots clipped = slots({"bump,output=displaced", {{"clip_tile", "1"}}});
    EXPECT_EQ(clipped.texture, plain.texture + 1);
    // Two differences, two minima; two movs where no swizzle brings zw to xy.
    EXPECT_LE(clipped.arithmetic, plain.arithmetic + 6);
}

// Values of a program; outputs are chosen from them.
enum Value { Input, Uniform, Constant, Texel, NegatedInput, NegatedUniform, Sum, Root };

ir::Program program_writing(Value depth, Value clip, bool looped) {
    constexpr const char* ids[] = {"%1", "%2", "%4", "%6", "%7", "%8", "%9", "%11"};
    std::string text =
        "pixel \"outputs\"\ninput at float2 interpolant\noutput inside float1 clip\n"
        "output colour float4 target\noutput depth float1 depth\noutput more float4 target\n"
        "uniform shift float1\nsampler map 2d\n{\n"
        "%0 float2 = input at\n%1 float1 = swizzle %0.y\n%2 float1 = uniform shift\n"
        "%3 float1 = const 0.0\n%4 float1 = const -0.5\n%5 float4 = sample_level map %0, %3\n"
        "%6 float1 = swizzle %5.y\n%7 float1 = neg %1\n%8 float1 = neg %2\n"
        "%9 float1 = add %1, %6\n%10 float1 = abs %9\n%11 float1 = sqrt %10\n"
        "%12 float4 = compose %9, %6, %2, %4\n%13 float4 = mul %12, %12\n";
    std::string colour = "%13";
    if (looped) {
        text +=
            "%14 float4 = loop \"sum\" 5 rolled (%13) {\n(%15 int1, %16 float4):\n%17 float4 = add "
            "%16, %12\nyield (%17)\n}\n";
        colour = "%14";
    }
    text += fmt::format("return ({}, {}, {}, %12)\n}}\n", ids[clip], colour, ids[depth]);
    return program_of_pixel(text);
}

TEST_P(Outputs, MayBeAnything) {
    for (const Value depth :
         {Input, Uniform, Constant, Texel, NegatedInput, NegatedUniform, Sum, Root})
        for (const Value clip : {Input, Constant, Texel, NegatedUniform, Sum, Root}) {
            SCOPED_TRACE(fmt::format("depth {} clip {}", int(depth), int(clip)));
            const ir::Program program = program_writing(depth, clip, false);
            const auto shader = generate_pixel(program, GetParam());
            ASSERT_TRUE(shader) << shader.error().message;
            EXPECT_TRUE(check(*shader).empty()) << check(*shader)[0].message << print(*shader);
            EXPECT_EQ(count_differences(program, *shader, 200), 0) << print(*shader);
        }
}

TEST(OutputsOfLoops, MayBeAnything) {
    for (const Value depth : {Input, Constant, Texel, NegatedUniform, Sum, Root})
        for (const Value clip : {Input, Uniform, Texel, NegatedInput, Sum, Root}) {
            SCOPED_TRACE(fmt::format("depth {} clip {}", int(depth), int(clip)));
            const ir::Program program = program_writing(depth, clip, true);
            const auto shader = generate_pixel(program, Profile::ps_3_0);
            ASSERT_TRUE(shader) << shader.error().message;
            EXPECT_EQ(count_ops(*shader, Opcode::Rep), 1);
            EXPECT_TRUE(check(*shader).empty()) << check(*shader)[0].message << print(*shader);
            EXPECT_EQ(count_differences(program, *shader, 200), 0) << print(*shader);
        }
}

}  // namespace
}  // namespace intaglio::d3d9

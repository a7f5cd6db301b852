// Every opcode on numbers whose results are known by hand and exact in binary32.
#include <cmath>
#include <limits>
#include <set>

#include "generator/target/d3d9/ops.h"
#include "tests/unit/interpret/programs.h"

namespace intaglio::d3d9 {
namespace {

constexpr float largest = std::numeric_limits<float>::max();
constexpr float infinity = std::numeric_limits<float>::infinity();

struct Case {
    const char* code;
    Vector expected;
};

const std::vector<Vector> constants = {
    {2, -3, 0.5f, 4}, {0.25f, 8, -1, 3}, {1, 0, -2, 0.5f}, {0, 0, 4, 8},  // r0 to r3
    {1, 0, 0, 0},     {0, 2, 0, 0},      {0, 0, 3, 0},     {1, 1, 1, 1},  // a matrix in c4
};

const Case pixel_cases[] = {
    {"nop", {2, -3, 0.5f, 4}},
    {"mov r0, r1", {0.25f, 8, -1, 3}},
    {"mov r0, -r1.wzyx", {-3, 1, -8, -0.25f}},
    {"mov r0.xz, r1", {0.25f, -3, -1, 4}},
    {"mov_sat r0, r1", {0.25f, 1, 0, 1}},
    {"mov r0, -r0_abs", {-2, -3, -0.5f, -4}},
    {"mov r0.yw, r1.xxzz", {2, 0.25f, 0.5f, -1}},
    {"add r0, r0, r1", {2.25f, 5, -0.5f, 7}},
    {"sub r0, r0, r1", {1.75f, -11, 1.5f, 1}},
    {"mul r0, r0, r1", {0.5f, -24, -0.5f, 12}},
    {"mad r0, r0, r1, r2", {1.5f, -24, -2.5f, 12.5f}},
    {"rcp r0, r0.x", {0.5f, 0.5f, 0.5f, 0.5f}},
    {"rcp r0.y, r1.y", {2, 0.125f, 0.5f, 4}},
    {"rsq r0, r0.w", {0.5f, 0.5f, 0.5f, 0.5f}},
    {"rsq r0.x, -r0.w", {0.5f, -3, 0.5f, 4}},
    {"dp3 r0, r0, r1", {-24, -24, -24, -24}},
    {"dp4 r0.x, r0, r1", {-12, -3, 0.5f, 4}},
    {"dp2add r0, r0, r1, r2.w", {-23, -23, -23, -23}},
    {"min r0, r0, r1", {0.25f, -3, -1, 3}},
    {"max r0, r0, r1", {2, 8, 0.5f, 4}},
    {"exp r0, r0.x", {4, 4, 4, 4}},
    {"log r0, r0.w", {2, 2, 2, 2}},
    {"log r0, -r0.w", {2, 2, 2, 2}},
    {"lrp r3, r1, r0, r2\nmov r0, r3", {1.25f, -24, -4.5f, 11}},
    {"frc r0, -r1", {0.75f, 0, 0, 0}},
    {"pow r3, r0.x, r1.w\nmov r0, r3", {8, 8, 8, 8}},
    {"pow r3, -r0.x, r1.w\nmov r0, r3", {8, 8, 8, 8}},
    {"crs r3.xyz, r0, r1\nmov r0.xyz, r3", {-1, 2.125f, 16.75f, 4}},
    {"abs r0, r0", {2, 3, 0.5f, 4}},
    {"nrm r0, r3", {0, 0, 1, 2}},
    {"nrm r0.xyz, r3", {0, 0, 1, 4}},
    {"cmp r0, r0, r1, r2", {0.25f, 0, -1, 3}},
    {"cmp r0, -r3.x, r1, r2", {0.25f, 8, -1, 3}},  // -0 is at least 0
    {"sincos r0.xy, r3.x", {1, 0, 0.5f, 4}},
    {"m4x4 r3, r0, c4\nmov r0, r3", {2, -6, 1.5f, 3.5f}},
    {"m4x3 r3.xyz, r0, c5\nmov r0.xyz, r3", {-6, 1.5f, 3.5f, 4}},
    {"m3x4 r3, r0, c4\nmov r0, r3", {2, -6, 1.5f, -0.5f}},
    {"m3x3 r3.xyz, r0, c5\nmov r0.xyz, r3", {-6, 1.5f, -0.5f, 4}},
    {"m3x2 r3.xy, r0, c5\nmov r0.xy, r3", {-6, 1.5f, 0.5f, 4}},
    {"setp_gt p0, r0, r1\n(p0) mov r0, r2", {1, -3, -2, 0.5f}},
    {"setp_gt p0, r0, r1\n(!p0) mov r0, r2", {2, 0, 0.5f, 4}},
    {"setp_gt p0, r0, r1\n(p0.y) mov r0, r2", {2, -3, 0.5f, 4}},
    {"setp_le p0.y, r0, r1\n(p0) mov r0, r2", {2, 0, 0.5f, 4}},
    // The reference's edges.
    {"rcp r0, r3.x", {largest, largest, largest, largest}},
    {"rsq r0, r3.x", {largest, largest, largest, largest}},
    {"log r0, r3.x", {-largest, -largest, -largest, -largest}},
    {"mul r1, r3, -r3.x\nmov r0, r1\nnrm r1.xyz, r0\nmov r0.xyz, r1", {0, 0, 0, 0}},
    {"pow r0, r3.x, r3.x", {1, 1, 1, 1}},
    {"add r1, r3.zzzz, r3.zzzz\nexp r0, r1.x\nexp r1, r0.x\nmov_sat r0, -r1", {0, 0, 0, 0}},
    {"exp r1, r3.w\nexp r0, r1.x", {infinity, infinity, infinity, infinity}},
};

class PixelOpcode : public testing::TestWithParam<Case> {};

TEST_P(PixelOpcode, GivesTheKnownNumbers) {
    EXPECT_THAT(r0_after(GetParam().code, constants), SameNumbers(GetParam().expected))
        << GetParam().code;
}
INSTANTIATE_TEST_SUITE_P(Cases, PixelOpcode, testing::ValuesIn(pixel_cases));

const Case vertex_cases[] = {
    {"slt r0, r0, r1", {0, 1, 0, 0}},
    {"sge r0, r0, r0", {1, 1, 1, 1}},
    {"sge r0, r0, r1", {1, 0, 1, 1}},
    {"sgn r0, r2, r1, r3", {1, 0, -1, 1}},
    {"lit r0, r0", {1, 2, 0, 1}},               // lit, N.H negative
    {"lit r0, r1.yxzw", {1, 8, 1.0f / 64, 1}},  // 0.25 to the power 3
    {"lit r0, -r0", {1, 0, 0, 1}},
    {"dst r0, r0, r1", {1, -24, 0.5f, 3}},
    {"mova a0.x, r2.x\nmov r0, c[a0.x + 4]", {0, 2, 0, 0}},
    {"mova a0.y, -r2.x\nmov r0, c[a0.y + 2]", {0.25f, 8, -1, 3}},
    {"mova a0.x, r2.z\nmov r0, c[a0.x + 0]", {0, 0, 0, 0}},  // below the registers
};

class VertexOpcode : public testing::TestWithParam<Case> {};

TEST_P(VertexOpcode, GivesTheKnownNumbers) {
    Environment environment;
    environment.constants = constants;
    const std::string text =
        std::string("vs_2_0\nmov r0, c0\nmov r1, c1\nmov r2, c2\nmov r3, c3\n") + GetParam().code +
        "\nmov oPos, r0\nmov oT3, r0.wzyx\n";
    const Shader shader = parsed(text);
    const Execution execution = prepared(shader).run(environment, {}, Arithmetic::Fp32);
    EXPECT_THAT(execution.position, SameNumbers(GetParam().expected)) << text;
    const Vector texcoord = output_of(shader, execution, Usage::Texcoord, 3);
    EXPECT_EQ(texcoord[0], GetParam().expected[3]);
}
INSTANTIATE_TEST_SUITE_P(Cases, VertexOpcode, testing::ValuesIn(vertex_cases));

// The cases above and the texture and flow tests name every mnemonic of the ops table.
TEST(Opcodes, EveryArithmeticOneHasACase) {
    std::set<std::string> seen;
    const auto collect = [&](const std::string& code) {
        std::size_t start = 0;
        while (start < code.size()) {
            const std::size_t end = std::min(code.find('\n', start), code.size());
            std::string word = code.substr(start, end - start);
            if (word[0] == '(') word = word.substr(word.find(')') + 2);
            seen.insert(word.substr(0, word.find_first_of(" _")));
            start = end + 1;
        }
    };
    for (const Case& c : pixel_cases) collect(c.code);
    for (const Case& c : vertex_cases) collect(c.code);
    for (const OpInfo& row : all_ops()) {
        if (row.has(Trait::Flow) || row.has(Trait::Texture) || row.has(Trait::NeedsGradients))
            continue;
        EXPECT_THAT(seen, testing::Contains(std::string(row.mnemonic)));
    }
}

TEST(Opcodes, SincosOfModel2LosesZ) {
    const std::string sincos = "sincos r0.xy, r3.x, c0, c1";
    Vector r0 = r0_after(sincos, constants, Arithmetic::Fp32, "ps_2_x");
    EXPECT_EQ(r0[0], 1);
    EXPECT_EQ(r0[1], 0);
    EXPECT_TRUE(std::isnan(r0[2]));
    EXPECT_EQ(r0[3], 4);
    r0 = r0_after("sincos r0.x, r3.x, c0, c1", constants, Arithmetic::Fp32, "ps_2_x");
    EXPECT_TRUE(std::isnan(r0[1]) && std::isnan(r0[2]));
}

TEST(Opcodes, TexkillTestsTheFirstThreeComponents) {
    for (int lane = 0; lane < 4; ++lane) {
        Inputs inputs;
        inputs.texcoords[0] = {0, 0, 0, 0};
        inputs.texcoords[0][static_cast<std::size_t>(lane)] = -0.25f;
        const Execution execution = ran("ps_2_0\ndcl t0\ntexkill t0\nmov oC0, t0\n", {}, inputs);
        EXPECT_EQ(execution.killed, lane < 3);
        EXPECT_EQ(execution.texture_reads, 0);
        EXPECT_EQ(execution.instructions, 2);
    }
}

TEST(Opcodes, DefinitionsHideConstants) {
    Environment environment;
    environment.constants = {{1, 2, 3, 4}, {5, 6, 7, 8}};
    const Execution execution =
        ran("ps_2_0\ndef c1, 9, 10, 11, 12\nmov r0, c0\nadd r0, r0, c1\nmov oC0, r0\nmov oDepth, "
            "r0.w\n",
            environment);
    EXPECT_THAT(execution.colours[0], SameNumbers(Vector{10, 12, 14, 16}));
    EXPECT_EQ(execution.depth, 16);
}

TEST(Opcodes, InputsByUsage) {
    const Shader shader = parsed(
        "ps_3_0\ndcl_texcoord0 v0.xy\ndcl_texcoord5 v0.zw\ndcl_color1 v3\ndcl vPos.xy\ndcl "
        "vFace\nmov r0, v0\nadd r0, r0, v3\nadd r0.xy, r0, vPos\ncmp r0.z, vFace, r0.z, "
        "-r0.z\nmov oC2, r0\n");
    Inputs inputs;
    set_input(shader, inputs, Usage::Texcoord, 0, {1, 2, 3, 4});
    set_input(shader, inputs, Usage::Texcoord, 5, {5, 6, 7, 8});
    set_input(shader, inputs, Usage::Color, 1, {10, 20, 30, 40});
    inputs.position = {100, 200, 0, 0};
    inputs.face = -1;
    const Execution execution = prepared(shader).run({}, inputs, Arithmetic::Fp32);
    EXPECT_THAT(execution.colours[2], SameNumbers(Vector{111, 222, -37, 48}));
}

TEST(EnvironmentOf, PutsNamesIntoTheirRegisters) {
    Shader shader = parsed("ps_3_0\nmov r0, c2\nadd r0, r0, c3\nmov oC0, r0\n");
    shader.constants = {{"flag", Constant::Set::Bool, 1, 1, 1, 1},
                        {"steps", Constant::Set::Int4, 0, 1, 3, 1},
                        {"pair", Constant::Set::Float4, 2, 2, 3, 2},
                        {"map", Constant::Set::Sampler, 1, 1, 0, 1}};
    const ir::Texture texture;
    std::map<std::string, std::vector<float>> values = {
        {"flag", {1}}, {"steps", {7, 0, 1}}, {"pair", {1, 2, 3, 4, 5, 6}}, {"other", {1}}};
    const auto environment = environment_of(shader, values, {{"map", &texture}});
    ASSERT_TRUE(environment.ok()) << to_string(environment.error());
    EXPECT_THAT(prepared(shader).run(*environment, {}, Arithmetic::Fp32).colours[0],
                SameNumbers(Vector{5, 7, 9, 0}));
    EXPECT_EQ(environment->integers.at(0), (std::array<int, 4>{7, 0, 1, 0}));
    EXPECT_TRUE(environment->booleans.at(1));
    EXPECT_EQ(environment->samplers.at(1), &texture);

    EXPECT_EQ(environment_of(shader, values, {}).error().code, "missing-texture");
    values["pair"].pop_back();
    EXPECT_EQ(environment_of(shader, values, {{"map", &texture}}).error().code, "bad-uniform");
    values.erase("pair");
    EXPECT_EQ(environment_of(shader, values, {{"map", &texture}}).error().code, "missing-uniform");
    shader.constants[2].index = 255;
    EXPECT_EQ(environment_of(shader, values, {{"map", &texture}}).error().code, "d3d9-malformed");
}

}  // namespace
}  // namespace intaglio::d3d9

// Control flow: counted loops, breaks, branches, calls; alone and with pixels of a quad that part.
#include "tests/unit/interpret/programs.h"

namespace intaglio::d3d9 {
namespace {

// Code between `ps_3_0` with i0 = (5, 2, 3), b0 = true, b1 = false and c0 = 0, 1, 0.5, 2, and the
// output of r0.
Execution ran_flow(const std::string& code, const Inputs& inputs = {}) {
    return ran(
        "ps_3_0\ndefi i0, 5, 2, 3, 0\ndefi i1, 3, 0, 0, 0\ndefb b0, true\ndefb b1, false\ndef c0, "
        "0, 1, 0.5, 2\ndcl_texcoord0 v0\nmov r0, c0.x\nmov r1, c0.x\n" +
            code,
        {}, inputs);
}

float r0x(const std::string& code, float v0 = 0) {
    Inputs inputs;
    inputs.attributes[0] = {v0, v0, v0, v0};
    return ran_flow(code + "\nmov oC0, r0\n", inputs).colours[0][0];
}

TEST(Flow, RepCounts) {
    EXPECT_EQ(r0x("rep i0\nadd r0, r0, c0.y\nendrep"), 5);
    EXPECT_EQ(r0x("rep i0\nrep i1\nadd r0, r0, c0.y\nendrep\nendrep"), 15);
    EXPECT_EQ(r0x("rep i5\nadd r0, r0, c0.y\nendrep"), 0) << "an unset count is 0";
}

TEST(Flow, LoopCountsItsRegister) {
    Inputs inputs;
    for (std::size_t i = 0; i < 16; ++i) inputs.attributes[i] = {static_cast<float>(i), 0, 0, 0};
    // aL is 2, 5, 8, 11, 14.
    const Execution execution =
        ran_flow("loop aL, i0\nadd r0, r0, v[aL]\nendloop\nmov oC0, r0\n", inputs);
    EXPECT_EQ(execution.colours[0][0], 2 + 5 + 8 + 11 + 14);
}

TEST(Flow, LoopsWriteOutputsByTheirRegister) {
    // aL is 1, 4, 7, 10, 13: the last is beyond the registers.
    const Execution execution =
        ran("vs_3_0\ndefi i0, 5, 1, 3, 0\ndef c0, 3, 0, 0, 0\ndcl_texcoord0 o0\nloop aL, i0\nmov "
            "o[aL], c0.x\nendloop\n");
    for (std::size_t i = 0; i < 12; ++i)
        EXPECT_EQ(execution.outputs[i][0], i % 3 == 1 ? 3 : 0) << i;
}

TEST(Flow, Branches) {
    EXPECT_EQ(r0x("if b0\nmov r0, c0.y\nelse\nmov r0, c0.w\nendif"), 1);
    EXPECT_EQ(r0x("if b1\nmov r0, c0.y\nelse\nmov r0, c0.w\nendif"), 2);
    EXPECT_EQ(r0x("if !b1\nmov r0, c0.y\nendif"), 1);
    EXPECT_EQ(r0x("setp_eq p0, v0.x, c0.x\nif p0.x\nmov r0, c0.y\nendif"), 1);
    const struct {
        const char* comparison;
        bool below, equal, above;
    } rows[] = {{"lt", true, false, false}, {"le", true, true, false},  {"gt", false, false, true},
                {"ge", false, true, true},  {"eq", false, true, false}, {"ne", true, false, true}};
    for (const auto& row : rows) {
        const std::string code = std::string("if_") + row.comparison +
                                 " v0.x, c0.z\nmov r0, c0.y\nelse\nmov r0, -c0.y\nendif";
        EXPECT_EQ(r0x(code, 0.25f), row.below ? 1 : -1) << row.comparison;
        EXPECT_EQ(r0x(code, 0.5f), row.equal ? 1 : -1) << row.comparison;
        EXPECT_EQ(r0x(code, 0.75f), row.above ? 1 : -1) << row.comparison;
        const float nan = std::numeric_limits<float>::quiet_NaN();
        EXPECT_EQ(r0x(code, nan), std::string(row.comparison) == "ne" ? 1 : -1) << row.comparison;
    }
}

TEST(Flow, Breaks) {
    EXPECT_EQ(r0x("rep i0\nadd r0, r0, c0.y\nbreak_ge r0.x, v0.x\nendrep", 3), 3);
    EXPECT_EQ(r0x("rep i0\nadd r0, r0, c0.y\nbreak\nendrep"), 1);
    EXPECT_EQ(r0x("rep i0\nadd r0, r0, c0.y\nif_ge r0.x, v0.x\nbreak\nendif\nendrep", 2), 2);
    EXPECT_EQ(r0x("rep i0\nadd r0, r0, c0.y\nsetp_ge p0, r0, v0\nbreakp p0.x\nendrep", 4), 4);
    EXPECT_EQ(
        r0x("rep i0\nadd r0, r0, c0.y\nif_lt r0.x, v0.x\nnop\nelse\nbreak\nendif\nadd r1, r1, "
            "c0.y\nendrep\nadd r0, r0, r1",
            2),
        3);
    // Only the innermost loop ends.
    EXPECT_EQ(r0x("rep i0\nrep i1\nadd r0, r0, c0.y\nbreak_ge r0.x, c0.x\nendrep\nendrep"), 5);
}

TEST(Flow, Calls) {
    EXPECT_EQ(r0x("call l0\ncall l0\ncallnz l1, b0\ncallnz l1, b1\nmov oC0, r0\nret\nlabel l0\nadd "
                  "r0, r0, c0.y\nret\nlabel l1\ncall l0\nadd r0, r0, c0.w\nret\nlabel l2"),
              5);
    const Execution endless = ran_flow("call l0\nret\nlabel l0\ncall l0\nret\n");
    EXPECT_FALSE(endless.complete);
}

TEST(Flow, EndlessWorkIsCutOff) {
    const Execution execution =
        ran("ps_3_0\ndefi i0, 255, 0, 0, 0\nrep i0\nrep i0\nrep i0\nrep "
            "i0\nnop\nendrep\nendrep\nendrep\nendrep\nmov oC0, c0\n");
    EXPECT_FALSE(execution.complete);
    EXPECT_TRUE(ran("ps_3_0\nmov oC0, c0\n").complete);
}

// Four pixels in step give what each gives alone, whoever leaves where.
TEST(Flow, QuadsAgreeWithSinglePixels) {
    const Shader shader = parsed(
        "ps_3_0\ndefi i0, 9, 0, 0, 0\ndef c0, 0, 1, 0.5, 3\ndcl_texcoord0 v0\nmov r0, c0.x\nrep "
        "i0\nadd r0.x, r0, c0.y\nif_gt v0.y, r0.x\nbreak_ge r0.x, v0.x\nadd r0.y, r0, "
        "c0.y\nelse\nif_lt v0.z, c0.x\nbreak\nendif\nadd r0.z, r0, c0.y\nendif\nadd r0.w, r0, "
        "c0.y\nendrep\nmov oC0, r0\n");
    const Interpreter interpreter = prepared(shader);
    std::array<Inputs, 4> inputs;
    inputs[0].attributes[0] = {2, 5, 1, 0};
    inputs[1].attributes[0] = {7, 4, -1, 0};
    inputs[2].attributes[0] = {9, 0, 1, 0};
    inputs[3].attributes[0] = {1, 9, 1, 0};
    std::vector<long> quad_counts, single_counts;
    const auto quad = interpreter.run_quad({}, inputs, Arithmetic::Fp32, &quad_counts);
    for (std::size_t i = 0; i < 4; ++i) {
        const Execution alone = interpreter.run({}, inputs[i], Arithmetic::Fp32, &single_counts);
        EXPECT_THAT(quad[i].colours[0], SameNumbers(alone.colours[0])) << i;
        EXPECT_EQ(quad[i].instructions, alone.instructions) << i;
    }
    EXPECT_EQ(quad_counts, single_counts);
    EXPECT_NE(quad[0].instructions, quad[2].instructions);
}

std::string refusal(const std::string& text) {
    const auto interpreter = Interpreter::prepare(parsed(text));
    return interpreter ? "accepted" : to_string(interpreter.error());
}

TEST(Prepare, RefusesWhatDoesNotFit) {
    EXPECT_THAT(refusal("ps_3_0\nrep i0\n"), testing::HasSubstr("never closed"));
    EXPECT_THAT(
        refusal("ps_3_0\nnop\nendif\n"),
        testing::AllOf(testing::HasSubstr("instruction 1"), testing::HasSubstr("closes nothing")));
    EXPECT_THAT(refusal("ps_3_0\nif b0\nendrep\n"), testing::HasSubstr("closes nothing"));
    EXPECT_THAT(refusal("ps_3_0\nbreak\n"), testing::HasSubstr("outside a loop"));
    EXPECT_THAT(refusal("ps_3_0\ncall l3\n"), testing::HasSubstr("no label l3"));
    EXPECT_THAT(refusal("ps_3_0\nrep i0\nret\nendrep\n"), testing::HasSubstr("inside a block"));
    EXPECT_THAT(refusal("ps_2_0\ndcl_cube s0\ndcl t0\ntexld r0, t0, s0\nmov oC0, r0\n"),
                testing::HasSubstr("cube"));
    Shader shader = parsed("ps_3_0\nmov r0, c0\n");
    shader.instructions[0].sources[0].index = 256;
    EXPECT_EQ(Interpreter::prepare(shader).error().code, "d3d9-malformed");
    shader.instructions[0].sources[0].index = 0;
    shader.instructions[0].destination->index = 32;
    EXPECT_EQ(Interpreter::prepare(shader).error().code, "d3d9-malformed");
    shader.instructions[0].destination.reset();
    EXPECT_EQ(Interpreter::prepare(shader).error().code, "d3d9-malformed");
    shader = parsed("ps_3_0\nmov r0, c0\n");
    shader.instructions[0].sources.clear();
    EXPECT_EQ(Interpreter::prepare(shader).error().code, "d3d9-malformed");
}

}  // namespace
}  // namespace intaglio::d3d9

// The counts behind the rules: orders of texture reads, resources, and which components a path has
// written.
#include <gmock/gmock.h>

#include "tests/unit/d3d9_legality/cases.h"
#include "tests/unit/d3d9_legality/random_program.h"

namespace intaglio::d3d9 {
namespace {

using testing::ElementsAre;

std::vector<int> levels(const std::string& body) {
    return dependent_levels(shader_of("ps_2_0\ndcl t0\ndcl t1\ndcl_2d s0\n" + body));
}

TEST(DependentReads, FollowTheChainOfCoordinates) {
    EXPECT_THAT(levels("texld r0, t0, s0\ntexld r1, r0, s0\ntexld r2, t1, s0\n"),
                ElementsAre(0, 1, 0));
    EXPECT_THAT(levels("mov r0, t0\ntexld r1, r0, s0\n"), ElementsAre(-1, 1));
    EXPECT_THAT(levels("texld r0, t0, s0\nadd r1, t0, r0\ntexld r2, r1, s0\nmul r3, r2, r0\ntexld "
                       "r4, r3, s0\n"),
                ElementsAre(0, -1, 1, -1, 2));
}

TEST(DependentReads, ReusingADestinationCostsAnOrder) {
    EXPECT_THAT(levels("texld r0, t0, s0\ntexld r0, t1, s0\ntexld r0, t0, s0\n"),
                ElementsAre(0, 1, 2));
    EXPECT_THAT(levels("mov r0, c0\ntexld r0, t0, s0\n"), ElementsAre(-1, 1));
    EXPECT_THAT(levels("texld r0, t0, s0\ntexld r1, r0, s0\nmov r1, c0\ntexld r2, r1, s0\n"),
                ElementsAre(0, 1, -1, 2))
        << "an overwrite does not lower the order";
}

TEST(DependentReads, TexkillReadsAndWritesItsTemp) {
    EXPECT_THAT(levels("texkill t0\nmov r0, t0\ntexkill r0\ntexld r1, r0, s0\n"),
                ElementsAre(0, -1, 1, 2));
}

TEST(Resources, AreCountedByTheValidatorsCharge) {
    const Shader shader = shader_of(
        "ps_2_0\ndef c5, 1, 1, 1, 1\ndcl t3.xy\ndcl v0\ndcl_2d s2\ntexld r3, t3, s2\nlrp r4, r3, "
        "c5, v0\nnrm r0.xyz, r4\n"
        "pow r0.w, r4.x, r4.y\nm3x2 r1.xy, r4, c8\nmov oC0, r3\n");
    const Resources used = count(shader);
    EXPECT_EQ(used.arithmetic, 2 + 3 + 3 + 2 + 1);
    EXPECT_EQ(used.texture, 1);
    EXPECT_EQ(used.total, 12);
    EXPECT_EQ(used.temps, 5);
    EXPECT_EQ(used.constants, 10) << "a matrix takes its rows";
    EXPECT_EQ(used.samplers, 3);
    EXPECT_EQ(used.texcoords, 4);
    EXPECT_EQ(used.inputs, 1);
    EXPECT_EQ(used.dependent_level, 0);
    for (const Headroom& row : headroom(shader)) {
        EXPECT_GE(row.left(), 0) << row.resource;
        if (row.resource == "arithmetic slots") {
            EXPECT_EQ(row.left(), 64 - 11);
        }
    }
}

// A shader that writes some of r0 on some ways, then reads r0.x.
bool initialised(const std::string& body) {
    const Shader shader = shader_of(
        "ps_3_0\ndefi i1, 3, 0, 0, 0\nmov r1, c0\nsetp_gt p0, c0, c0\n" + body + "mov oC0, r0.x\n");
    const auto violations = check(shader);
    for (const Violation& violation : violations)
        EXPECT_EQ(violation.rule, "uninitialised") << violation.message;
    return violations.empty();
}

TEST(Initialisation, NeedsBothBranchesOfAnIf) {
    EXPECT_TRUE(initialised("if_gt r1.x, r1.y\nmov r0, c0\nelse\nmov r0.x, c1\nendif\n"));
    EXPECT_FALSE(initialised("if_gt r1.x, r1.y\nmov r0, c0\nelse\nmov r0.y, c1\nendif\n"));
    EXPECT_FALSE(initialised("if b0\nmov r0, c0\nendif\n"));
    EXPECT_FALSE(initialised("if b0\nif b1\nmov r0, c0\nendif\nelse\nmov r0, c0\nendif\n"));
    EXPECT_TRUE(initialised(
        "if b0\nif b1\nmov r0, c0\nelse\nmov r0, c2\nendif\nelse\nmov r0, c0\nendif\n"));
}

TEST(Initialisation, ALoopMayNotRunUnlessItsCountIsDefined) {
    EXPECT_FALSE(initialised("rep i0\nmov r0, c0\nendrep\n"));
    EXPECT_TRUE(initialised("rep i1\nmov r0, c0\nendrep\n"));
    EXPECT_FALSE(initialised("rep i1\nbreak_gt r1.x, r1.y\nmov r0, c0\nendrep\n"))
        << "left before the write";
    EXPECT_TRUE(initialised("rep i1\nmov r0, c0\nbreak_gt r1.x, r1.y\nendrep\n"));
    EXPECT_TRUE(initialised("mov r0, c0\nrep i0\nadd r0, r0, r1\nendrep\n"));
    EXPECT_FALSE(initialised("rep i1\nadd r0, r0, r1\nendrep\n")) << "the first round reads it";
    EXPECT_TRUE(initialised(
        "rep i1\nif b0\nbreak\nelse\nmov r2, c0\nendif\nmov r3, r2\nendrep\nmov r0, c0\n"))
        << "who gets here did not break";
}

TEST(Initialisation, APredicateAndItsInverseMakeOneWrite) {
    EXPECT_FALSE(initialised("(p0.x) mov r0, c0\n"));
    EXPECT_TRUE(initialised("(p0.x) mov r0, c0\n(!p0.x) mov r0, c1\n"));
    EXPECT_FALSE(initialised("(p0.x) mov r0, c0\n(!p0.y) mov r0, c1\n"));
    EXPECT_TRUE(initialised("(p0) mov r0, c0\n(!p0.x) mov r0, c1\n")) << "p0 is p0.x for x";
    EXPECT_FALSE(initialised("(p0.x) mov r0, c0\nsetp_gt p0, r1, c0\n(!p0.x) mov r0, c1\n"))
        << "another p0";
}

TEST(Initialisation, RunsSubroutinesInPlace) {
    const auto legal = [](const std::string& call) {
        return check(
                   shader_of("ps_3_0\n" + call + "\nmov oC0, r0\nret\nlabel l0\nmov r0, c0\nret\n"))
            .empty();
    };
    EXPECT_TRUE(legal("call l0"));
    EXPECT_FALSE(legal("callnz l0, b0"));
}

TEST(Check, AnswersOnAnyShader) {
    for (unsigned seed = 0; seed < 3000; ++seed) {
        const Shader shader = random_nonsense(seed);
        for (const Violation& violation : check(shader)) {
            EXPECT_THAT(rule_names, testing::Contains(violation.rule)) << "seed " << seed;
            EXPECT_LT(violation.instruction, static_cast<int>(shader.instructions.size()));
        }
    }
}

}  // namespace
}  // namespace intaglio::d3d9

// Text: what it looks like, that it reads back equal, and what is refused where.
#include "generator/target/d3d9/assembly.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "generator/target/d3d9/ops.h"
#include "tests/rounds.h"
#include "tests/unit/d3d9/dice.h"
#include "tests/unit/d3d9/random_shader.h"

namespace intaglio::d3d9 {
namespace {

using testing::HasSubstr;

TEST(Assembly, OneOfEachKindOfLine) {
    const std::string text =
        "ps_2_x\n"
        "// profile ps_2_b\n"
        "// uniform float3 light[2] : c4, 2 registers\n"
        "// uniform sampler height_map : s0\n"
        "def c0, 1, -0.0, 1e-38, 1000000000.0\n"
        "dcl_pp_centroid t0.xy\n"
        "dcl_2d s0\n"
        "texld r0, t0, s0\n"
        "mad_sat_pp r0.xyz, -r0.x, c0, r0.yzxw\n"
        "(!p0.x) mov r1, -c4\n"
        "mov oC0, r0\n";
    const auto shader = parse(text, "one.asm");
    ASSERT_TRUE(shader) << to_string(shader.error());
    EXPECT_EQ(shader->profile, Profile::ps_2_b);
    EXPECT_EQ(slots_of(*shader), (Slots{4, 1}));
    EXPECT_THAT(print(*shader, {.comments = false}),
                HasSubstr("mad_sat_pp r0.xyz, -r0.x, c0, r0.yzxw\n"));
    const auto again = parse(print(*shader), "again.asm");
    ASSERT_TRUE(again) << to_string(again.error());
    EXPECT_EQ(*again, *shader);
}

TEST(Assembly, XProfileIsWhatTheCallerSays) {
    EXPECT_EQ(parse("ps_2_x\n// profile ps_2_b\n", "", Profile::ps_2_a)->profile, Profile::ps_2_a);
    EXPECT_EQ(parse("ps_2_x\n", "", Profile::ps_2_b)->profile, Profile::ps_2_b);
    EXPECT_EQ(parse("ps_2_x\n", "")->profile, Profile::ps_2_a);
    EXPECT_EQ(parse("ps_3_0\n// profile ps_2_b\n", "", Profile::ps_2_b)->profile, Profile::ps_3_0);
}

TEST(Assembly, CommentsNameStepsLinesAndSlots) {
    Shader shader = *parse("ps_2_0\nnrm r0.xyz, t0\ntexld r1, t0, s0\nmov oC0, r1\n", "");
    shader.steps = {{"march", "down the ray \\\nmov r0, c0"}};
    shader.files = {"templates/search/march.cpp"};
    shader.instructions[1].origin = {0, 28, 0};
    shader.instructions[2].origin = {0, 28, 0};
    const std::string text = print(shader);
    EXPECT_THAT(text, HasSubstr(" ;   3   0\n// down the ray / mov r0, c0\ntexld r1"));
    EXPECT_THAT(text, HasSubstr(" ;   3   1  march: templates/search/march.cpp:28\n"));
    EXPECT_THAT(text, HasSubstr(" ;   4   1  march: templates/search/march.cpp:28\n"));
    EXPECT_EQ(text.find("down the ray"), text.rfind("down the ray")) << "a step is introduced once";
    EXPECT_EQ(*parse(text, ""), shader);
}

TEST(Assembly, AStepCannotPassForAUniform) {
    Shader shader = *parse("ps_2_0\nmov oC0, c0\n", "");
    shader.steps = {{"uniform float3 x : c0", ""}};
    shader.instructions[0].origin.step = 0;
    EXPECT_EQ(*parse(print(shader), ""), shader);
}

TEST(Assembly, RandomShadersReadBackEqual) {
    for (const Profile profile : every_profile)
        for (std::uint32_t seed = 0; seed < rounds(500u); ++seed) {
            const Shader shader = random_shader(seed, profile);
            const std::string text = print(shader, {.comments = seed % 2 == 0});
            const auto again = parse(text, "random.asm");
            ASSERT_TRUE(again) << name_of(profile) << " seed " << seed << "\n"
                               << to_string(again.error()) << "\n"
                               << text;
            ASSERT_EQ(*again, shader) << name_of(profile) << " seed " << seed << "\n" << text;
        }
}

TEST(Assembly, FloatsReadBackToTheBit) {
    Dice dice(7);
    Shader shader;
    for (int i = 0; i < rounds(50000); ++i)
        shader.definitions.push_back(
            {File::Const,
             i % 32,
             {dice.float_bits(), dice.float_bits(), dice.bits() & 0xFFFFFF, dice.float_bits()}});
    EXPECT_TRUE(*parse(print(shader), "") == shader) << "seed 7";
}

TEST(Assembly, ShorthandsOfTheSyntax) {
    const auto wide = parse(
        "vs_3_0\nmov r0, c[a0.y + 3].xy\nmov o[aL], v2[aL].bgra\n"
        "mov r0, -c_abs[a0.z + 1]\nmov r0, c[a0.z]_abs.x\n",
        "");
    ASSERT_TRUE(wide) << to_string(wide.error());
    EXPECT_EQ(text_of(wide->instructions[0]), "mov r0, c3[a0.y].xyyy");
    EXPECT_EQ(text_of(wide->instructions[1]), "mov o0[aL], v2[aL].zyxw");
    EXPECT_EQ(text_of(wide->instructions[2]), "mov r0, -c1_abs[a0.z]");
    EXPECT_EQ(text_of(wide->instructions[3]), "mov r0, c0_abs[a0.z].x");
}

struct Refusal {
    std::string text;
    int line;
    int column;
    std::string message;
};

class RefusedText : public testing::TestWithParam<Refusal> {};

TEST_P(RefusedText, WithASentenceAndAPlace) {
    const auto result = parse(GetParam().text, "bad.asm");
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, "d3d9-parse");
    EXPECT_EQ(result.error().line, GetParam().line);
    EXPECT_EQ(result.error().column, GetParam().column);
    EXPECT_THAT(result.error().message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Text, RefusedText,
    testing::Values(Refusal{"", 1, 1, "no version"},
                    Refusal{"\nps_1_1\n", 2, 1, "expected a version"},
                    Refusal{"ps_2_0\nfoo r0\n", 2, 1, "no instruction \"foo\""},
                    Refusal{"ps_2_0\nmov r0\n", 2, 7, "mov needs 2 operands"},
                    Refusal{"ps_2_0\nmov r0, c0, c1\n", 2, 11, "goes on"},
                    Refusal{"ps_2_0\nmov r0, q1\n", 2, 9, "no register \"q\""},
                    Refusal{"ps_3_0\nmov r0, t1\n", 2, 9, "ps_3_0 has no register \"t\""},
                    Refusal{"ps_2_0\nmov r2048, c1\n", 2, 5, "0 to 2047"},
                    Refusal{"ps_3_0\nmov r0_abs, c1\n", 2, 5, "no _abs"},
                    Refusal{"ps_2_0\nmov r0.yx, c1\n", 2, 7, "in the order xyzw"},
                    Refusal{"ps_2_0\nmov r0, c1.xq\n", 2, 12, "one to four"},
                    Refusal{"ps_2_0\nif c0.x, c1.x\n", 2, 8, "goes on"},
                    Refusal{"ps_3_0\nif_gt_sat c0.x, c1.x\n", 2, 1, "writes nothing"},
                    Refusal{"ps_3_0\nsetp p0, c0, c1\n", 2, 1, "needs a comparison"},
                    Refusal{"ps_3_0\nmov_lt r0, c1\n", 2, 1, "takes no comparison"},
                    Refusal{"ps_3_0\nmov_foo r0, c1\n", 2, 1, "\"foo\" is no modifier"},
                    Refusal{"ps_3_0\n(r0) mov r0, c1\n", 2, 1, "a predicate reads"},
                    Refusal{"ps_3_0\nmov r0, c0\ndef c0, 1, 2, 3, 4\n", 3, 1,
                            "before the first instruction"},
                    Refusal{"ps_3_0\ndef c0, 1, 2, 3\n", 2, 16, "needs 4 values"},
                    Refusal{"ps_3_0\ndef c0, 1, two, 3, 4\n", 2, 12, "no value"},
                    Refusal{"ps_3_0\ndef i0, 1, 2, 3, 4\n", 2, 5, "whole c register"},
                    Refusal{"ps_3_0\ndcl v0\n", 2, 5, "needs a usage"},
                    Refusal{"ps_2_0\ndcl_texcoord t0\n", 2, 14, "takes no usage"},
                    Refusal{"ps_3_0\ndcl r0\n", 2, 5, "cannot be declared"},
                    Refusal{"vs_2_0\nmov r0, c[r0.x]\n", 2, 11, "a relative register"},
                    Refusal{"ps_2_0\n// uniform vec3 light : c4\n", 2, 17, "a uniform comment"}));

TEST(Assembly, MutatedTextNeverCrashes) {
    Dice dice(11);
    int accepted = 0;
    std::string text;
    for (int i = 0; i < 20000; ++i) {
        const Profile profile = every_profile[i / 50 % 6];
        if (i % 50 == 0) text = print(random_shader(static_cast<std::uint32_t>(i), profile));
        std::string changed = text;
        for (int edits = dice.up_to(3); edits >= 0; --edits) {
            const auto at =
                static_cast<std::size_t>(dice.up_to(static_cast<int>(changed.size()) - 1));
            const std::size_t other =
                static_cast<std::size_t>(dice.up_to(static_cast<int>(text.size()) - 1));
            if (dice.one_in(3))
                changed.erase(at, 1 + static_cast<std::size_t>(dice.up_to(5)));
            else if (dice.one_in(2))
                changed[at] = static_cast<char>(dice.up_to(255));
            else
                changed.insert(at, text.substr(other, static_cast<std::size_t>(dice.up_to(12))));
            if (changed.empty()) changed = "p";
        }
        const auto result = parse(changed, "mutated.asm");
        if (!result) continue;
        ++accepted;
        const auto again = parse(print(*result), "printed.asm");
        ASSERT_TRUE(again) << "seed 11, input " << i << "\n"
                           << to_string(again.error()) << "\n"
                           << print(*result);
        ASSERT_EQ(print(*again), print(*result)) << "seed 11, input " << i;
    }
    EXPECT_GT(accepted, 100) << "the mutations are so coarse that nothing is tested";
}

}  // namespace
}  // namespace intaglio::d3d9

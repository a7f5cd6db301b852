// Every slot is charged once, to its step and to its line.
#include "generator/target/d3d9/explain.h"

#include <gtest/gtest.h>

#include "generator/target/d3d9/assembly.h"
#include "tests/rounds.h"
#include "tests/unit/d3d9/random_shader.h"

namespace intaglio::d3d9 {
namespace {

Slots sum_of(const std::vector<Spent>& rows) {
    Slots sum;
    for (const Spent& row : rows) {
        sum.arithmetic += row.slots.arithmetic;
        sum.texture += row.slots.texture;
    }
    return sum;
}

TEST(Explain, ChargesStepsAndLinesAndNamesReads) {
    Shader shader = *parse(
        "ps_2_0\n// uniform sampler height_map : s0\ndcl t0.xy\ndcl_2d s0\ndcl_2d s1\n"
        "texld r0, t0, s0\nnrm r1.xyz, r0\ntexld r1, r1, s1\nadd r0, r0, r1\nmov oC0, r0\n",
        "test.asm");
    shader.files = {"a.cpp"};
    shader.steps = {{"march", ""}, {"shade", ""}};
    shader.instructions[0].origin = {0, 7, 0};
    shader.instructions[1].origin = {0, 9, 1};
    shader.instructions[2].origin = {0, 8, 1};
    shader.instructions[3].origin = {0, 9, 1};
    const Explanation all = explain(shader);
    EXPECT_EQ(all.slots, (Slots{5, 2}));
    ASSERT_EQ(all.steps.size(), 3u);
    EXPECT_EQ(all.steps[0].step, "shade");
    EXPECT_EQ(all.steps[0].slots, (Slots{4, 1}));
    ASSERT_EQ(all.lines.size(), 4u);
    EXPECT_EQ(all.lines[0].line, 9);
    EXPECT_EQ(all.lines[0].slots, (Slots{4, 0}));
    EXPECT_EQ(all.lines[1].line, 8);
    ASSERT_EQ(all.reads.size(), 2u);
    EXPECT_EQ(all.reads[0].sampler, "height_map");
    EXPECT_EQ(all.reads[0].level, 0);
    EXPECT_EQ(all.reads[1].sampler, "s1") << "no name in the constant table";
    EXPECT_EQ(all.reads[1].level, 1);
    EXPECT_EQ(all.reads[1].step, "shade");
}

TEST(Explain, SumsAreTheShaders) {
    for (std::uint32_t seed = 1; seed <= rounds(300u); ++seed)
        for (const Profile profile : every_profile) {
            Shader shader = random_legal_shader(seed, profile);
            shader.files = {"a.cpp", "b.cpp"};
            shader.steps = {{"one", ""}, {"two", ""}};
            for (std::size_t i = 0; i < shader.instructions.size(); ++i)
                // Some of them outside every step or file.
                shader.instructions[i].origin = {static_cast<int>(i * seed % 4) - 1,
                                                 static_cast<int>(i % 3),
                                                 static_cast<int>(i * seed % 5) - 1};
            const Explanation all = explain(shader);
            EXPECT_EQ(sum_of(all.steps), slots_of(shader)) << "seed " << seed;
            EXPECT_EQ(sum_of(all.lines), slots_of(shader)) << "seed " << seed;
            EXPECT_EQ(all.slots, slots_of(shader)) << "seed " << seed;
            int deepest = 0;
            for (const TextureRead& read : all.reads) deepest = std::max(deepest, read.level);
            EXPECT_LE(deepest, count(shader).dependent_level) << "seed " << seed;
        }
}

}  // namespace
}  // namespace intaglio::d3d9

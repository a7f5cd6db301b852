// Direct3D's own validator accepts the vertex shaders, and its compiler needs no fewer slots for
// the HLSL of the same stage.
#include <gtest/gtest.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/ops.h"
#include "generator/target/target.h"
#include "tests/judge/judge.h"
#include "tests/unit/d3d9_generate/random_vertex.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

struct Row {
    Profile profile;
    const char* hlsl;
};
constexpr Row rows[] = {{Profile::vs_2_0, "hlsl_2_0"}, {Profile::vs_3_0, "hlsl_3_0"}};

TEST(VertexJudge, AcceptsEveryText) {
    judge::Batch batch;
    std::vector<std::string> texts;
    for (const Row& row : rows) {
        for (const std::string surface : {"bump", "parallax_occlusion", "fur"}) {
            const auto program = record({surface, {}}, Profile::ps_2_0);
            ASSERT_TRUE(program) << to_string(program.error());
            const auto shader = generate_vertex(*program, row.profile);
            ASSERT_TRUE(shader) << to_string(shader.error());
            texts.push_back(print(*shader));
        }
        for (unsigned seed = 1; seed <= 60; ++seed) {
            const auto shader = generate_vertex(random_vertex_program(seed, 14), row.profile);
            if (shader) texts.push_back(print(*shader));
        }
    }
    ASSERT_GE(texts.size(), 100u);
    for (const std::string& text : texts) batch.assemble(text);
    const auto answers = batch.run(*judge::find());
    ASSERT_TRUE(answers) << answers.error().message;
    for (std::size_t i = 0; i < texts.size(); ++i)
        EXPECT_TRUE(answers->at(i).accepted) << answers->at(i).text << texts[i];
}

TEST(VertexJudge, NeedsNoMoreSlotsThanTheCompiler) {
    judge::Batch batch;
    std::vector<int> ours;
    for (const Row& row : rows)
        for (const std::string surface : {"bump", "parallax_occlusion"}) {
            const auto program = record({surface, {}}, Profile::ps_2_0);
            ASSERT_TRUE(program) << to_string(program.error());
            const auto text = emit(*program, *find_target(row.hlsl));
            ASSERT_TRUE(text) << to_string(text.error());
            batch.compile(text->vertex.text, "vertex_main", std::string(name_of(row.profile)));
            const auto shader = generate_vertex(*program, row.profile);
            ASSERT_TRUE(shader) << to_string(shader.error());
            ours.push_back(slots_of(*shader).total());
        }
    const auto answers = batch.run(*judge::find());
    ASSERT_TRUE(answers) << answers.error().message;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        ASSERT_TRUE(answers->at(i).accepted) << answers->at(i).text;
        const auto theirs = decode(answers->at(i).words);
        ASSERT_TRUE(theirs) << to_string(theirs.error());
        EXPECT_LE(ours[i], slots_of(*theirs).total()) << answers->at(i).text;
        RecordProperty("slots_" + std::to_string(i), ours[i]);
        RecordProperty("compiler_" + std::to_string(i), slots_of(*theirs).total());
    }
}

}  // namespace
}  // namespace intaglio::d3d9

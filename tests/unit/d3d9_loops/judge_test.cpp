// Direct3D's own validator accepts every shader with loops, and its bytes are ours.
#include <gtest/gtest.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"
#include "tests/judge/judge.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

TEST(LoopsJudge, AcceptsEveryTextAndMakesItsBytes) {
    std::vector<Case> cases;
    for (const std::string steps : {"10", "255", "256", "257", "511"})
        for (const std::string nyquist : {"0", "1"})
            cases.push_back(
                {"steep_parallax,shadow=march", {{"max_steps", steps}, {"nyquist", nyquist}}});
    for (const std::string surface :
         {"search=steep_parallax,output=displaced", "search=none,shadow=march", "fur",
          "parallax_occlusion", "parallax_occlusion,shadow=fur_depth,output=displaced"})
        cases.push_back({surface, {}});
    judge::Batch batch;
    std::vector<Shader> shaders;
    for (const Case& a_case : cases) {
        const auto program = record(a_case, Profile::ps_3_0);
        ASSERT_TRUE(program) << program.error().message;
        const auto shader = generate_pixel(*program, Profile::ps_3_0);
        ASSERT_TRUE(shader) << a_case.name() << ": " << shader.error().message;
        shaders.push_back(*shader);
        batch.assemble(print(*shader));
    }
    const auto answers = batch.run(*judge::find());
    ASSERT_TRUE(answers) << answers.error().message;
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        SCOPED_TRACE(cases[i].name());
        ASSERT_TRUE(answers->at(i).accepted) << answers->at(i).text << print(shaders[i]);
        // The assembler writes no constant table.
        Shader bare = shaders[i];
        bare.constants.clear();
        const auto theirs = decode(answers->at(i).words);
        ASSERT_TRUE(theirs) << theirs.error().message;
        Shader bare_theirs = *theirs;
        bare_theirs.constants.clear();
        EXPECT_EQ(encode(bare), encode(bare_theirs));
    }
}

}  // namespace
}  // namespace intaglio::d3d9

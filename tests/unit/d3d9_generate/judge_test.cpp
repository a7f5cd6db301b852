// Direct3D's own validator accepts what the generator emits, every surface in every profile.
#include <gtest/gtest.h>

#include "generator/target/d3d9/assembly.h"
#include "tests/judge/judge.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

void expect_accepted(const std::vector<Case>& cases, std::size_t least) {
    judge::Batch batch;
    std::vector<std::string> texts, names;
    for (const Profile profile : pixel_profiles())
        for (const Case& a_case : cases) {
            const auto program = record(a_case, profile);
            ASSERT_TRUE(program) << program.error().message;
            const auto shader = generate_pixel(*program, profile);
            if (!shader) continue;
            texts.push_back(print(*shader));
            names.push_back(std::string(name_of(profile)) + ": " + a_case.name());
            batch.assemble(texts.back());
        }
    ASSERT_GE(texts.size(), least);
    const auto answers = batch.run(*judge::find());
    ASSERT_TRUE(answers) << answers.error().message;
    for (std::size_t i = 0; i < texts.size(); ++i)
        EXPECT_TRUE(answers->at(i).accepted) << names[i] << "\n" << answers->at(i).text << texts[i];
}

TEST(GenerateJudge, AcceptsEveryText) { expect_accepted(all_cases(), 48); }
TEST(GenerateJudge, AcceptsDepthsAndDroppedPixels) { expect_accepted(output_cases(), 48); }

}  // namespace
}  // namespace intaglio::d3d9

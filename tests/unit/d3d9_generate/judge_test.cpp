// Direct3D's own validator accepts what the generator emits: every surface here on one profile that
// holds it, the profiles in turn.  Every technique on every profile is the business of
// tests/judge/variants_judge_test.cpp.
#include <gtest/gtest.h>

#include "generator/target/d3d9/assembly.h"
#include "tests/judge/judge.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

void expect_accepted(const std::vector<Case>& cases) {
    const std::vector<Profile> profiles = pixel_profiles();
    judge::Batch batch;
    std::vector<std::string> texts, names;
    for (std::size_t i = 0; i < cases.size(); ++i)
        for (std::size_t k = 0; k < profiles.size(); ++k) {
            const Profile profile = profiles[(i + k) % profiles.size()];
            const auto program = record(cases[i], profile);
            ASSERT_TRUE(program) << program.error().message;
            const auto shader = generate_pixel(*program, profile);
            if (!shader) continue;
            texts.push_back(print(*shader));
            names.push_back(std::string(name_of(profile)) + ": " + cases[i].name());
            batch.assemble(texts.back());
            break;
        }
    ASSERT_EQ(texts.size(), cases.size()) << "ps_3_0 holds every case";
    const auto answers = batch.run(*judge::find());
    ASSERT_TRUE(answers) << answers.error().message;
    for (std::size_t i = 0; i < texts.size(); ++i)
        EXPECT_TRUE(answers->at(i).accepted) << names[i] << "\n" << answers->at(i).text << texts[i];
}

TEST(GenerateJudge, AcceptsEveryText) { expect_accepted(all_cases()); }
TEST(GenerateJudge, AcceptsDepthsAndDroppedPixels) { expect_accepted(output_cases()); }

}  // namespace
}  // namespace intaglio::d3d9

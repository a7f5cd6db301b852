// Our verdicts against Direct3D's validator: on every shader of the tables, and on random programs.
#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "generator/target/d3d9/assembly.h"
#include "tests/judge/judge.h"
#include "tests/unit/d3d9_legality/cases.h"
#include "tests/unit/d3d9_legality/random_program.h"

namespace intaglio::d3d9 {
namespace {

std::vector<judge::Answer> answers_to(const std::vector<std::string>& texts) {
    judge::Batch batch;
    for (const std::string& text : texts) batch.assemble(text);
    auto answers = batch.run(*judge::find());
    if (!answers) {
        ADD_FAILURE() << answers.error().message;
        return std::vector<judge::Answer>(texts.size());
    }
    return *answers;
}

TEST(LegalityJudge, AgreesOnTheShadersOfEachRule) {
    const auto cases = rule_cases();
    std::vector<std::string> texts;
    for (const RuleCase& one : cases) texts.push_back(judge_text(one.text));
    const auto answers = answers_to(texts);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const bool accepts = cases[i].kind != RuleCase::Kind::Bad;
        EXPECT_EQ(answers[i].accepted, accepts)
            << "rules.txt:" << cases[i].line << "\n"
            << cases[i].text << (accepts ? answers[i].text : "");
    }
}

TEST(LegalityJudge, SaysOfEachProbeWhatIsRecorded) {
    const auto all = probes();
    std::vector<std::string> texts;
    for (const Probe& probe : all) texts.push_back(probe.text);
    const auto answers = answers_to(texts);
    for (std::size_t i = 0; i < all.size(); ++i)
        EXPECT_EQ(answers[i].accepted, all[i].accepted)
            << "probes.txt:" << all[i].line << "\n"
            << all[i].text << (all[i].accepted ? answers[i].text : "");
}

TEST(LegalityJudge, AgreesOnRandomPrograms) {
    const char* from = std::getenv("INTAGLIO_SEED");
    const unsigned first = from != nullptr ? static_cast<unsigned>(std::atoi(from)) : 1;
    constexpr unsigned each = 1000;
    std::vector<Shader> shaders;
    std::vector<std::string> texts;
    for (const Profile profile : {Profile::ps_2_0, Profile::ps_2_a, Profile::ps_3_0})
        for (unsigned seed = first; seed < first + each; ++seed) {
            shaders.push_back(random_program(profile, seed));
            texts.push_back(print(shaders.back(), {.comments = false}));
        }
    const auto answers = answers_to(texts);
    int legal = 0, differing = 0;
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        const auto violations = check(shaders[i], validator_limits(shaders[i].profile));
        legal += answers[i].accepted;
        if (violations.empty() == answers[i].accepted || ++differing > 10) continue;
        ADD_FAILURE() << "seed " << first + i % each << "\n"
                      << texts[i] << "\nours:\n"
                      << describe(violations) << "\nDirect3D's: " << answers[i].text.substr(0, 600);
    }
    EXPECT_EQ(differing, 0) << "of " << shaders.size() << "; from seed " << first;
    // Otherwise the comparison would say little.
    EXPECT_GT(legal, static_cast<int>(shaders.size()) / 8);
    EXPECT_LT(legal, static_cast<int>(shaders.size()) * 7 / 8);
}

}  // namespace
}  // namespace intaglio::d3d9

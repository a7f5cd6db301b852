// Finding the judge and reading what it prints, without one.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/judge/judge.h"

namespace intaglio::judge {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

TEST(FindJudge, PrefersTheVariableThenOurFolderThenTheOther) {
    const fs::path home = fs::path(testing::TempDir()) / "judge-home";
    fs::remove_all(home);
    setenv("HOME", home.c_str(), 1);
    unsetenv("INTAGLIO_JUDGE");
    std::string why;
    EXPECT_EQ(find(&why), std::nullopt);
    EXPECT_THAT(why, HasSubstr("scripts/judge"));

    const auto install = [&](const char* folder) {
        const fs::path path = home / ".cache" / folder / "judge";
        fs::create_directories(path.parent_path());
        std::ofstream(path) << "#!/bin/sh\n";
        return path;
    };
    const fs::path other = install("d3d-judge");
    EXPECT_EQ(find(), other);
    const fs::path ours = install("intaglio-judge");
    EXPECT_EQ(find(), ours);
    setenv("INTAGLIO_JUDGE", other.c_str(), 1);
    EXPECT_EQ(find(), other);
    setenv("INTAGLIO_JUDGE", "/nowhere/judge", 1);
    EXPECT_EQ(find(&why), std::nullopt) << "a wrong name is not silently replaced";
    EXPECT_THAT(why, HasSubstr("/nowhere/judge"));
    unsetenv("INTAGLIO_JUDGE");
    fs::remove_all(home);
}

TEST(JudgeOutput, IsCutAtItsVerdicts) {
    const auto verdicts = cut_verdicts(
        "    ps_2_0\r\n    mov oC0, c0\n\n#### 0\nx(2): error X5204: r0\nrefused\n\n#### 1\n");
    EXPECT_THAT(verdicts,
                ElementsAre(Field(&Verdict::exit_code, 0), Field(&Verdict::exit_code, 1)));
    EXPECT_THAT(verdicts[0].text, HasSubstr("ps_2_0\n    mov oC0, c0\n"));
    EXPECT_EQ(error_code({false, verdicts[1].text, {}}), "X5204");
    EXPECT_EQ(error_code({true, verdicts[0].text, {}}), "");
}

TEST(JudgeOutput, AProgramThatDoesNotAnswerIsAnError) {
    Batch batch;
    batch.assemble("ps_2_0\n");
    const auto answers = batch.run("/bin/false");
    ASSERT_FALSE(answers.ok());
    EXPECT_THAT(answers.error().message, HasSubstr("0 of 1"));
}

}  // namespace
}  // namespace intaglio::judge

// The chain of witnesses on shaders written by hand, in every language.
#include "src/check/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/check/derive.h"
#include "src/check/frontend.h"
#include "src/check/spirv.h"
#include "tests/unit/check/shaders.h"

namespace intaglio::check {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class JudgeEachLanguage : public ::testing::TestWithParam<Language> {};

TEST_P(JudgeEachLanguage, AcceptsTheParallaxShaders) {
    for (const Source& source : {parallax_pixel(GetParam()), parallax_vertex(GetParam())}) {
        const Result<Witnessed> witnessed = judge(source);
        ASSERT_TRUE(witnessed.ok()) << to_string(witnessed.error()) << "\n" << source.text;
        EXPECT_EQ(witnessed->crossed.size(), 4u);
        EXPECT_EQ(witnessed->steps.front(), "glslang " + std::string(name_of(GetParam())));
        EXPECT_EQ(witnessed->steps.size(), 15u);
        EXPECT_TRUE(validate_spirv(witnessed->words).ok());
        EXPECT_TRUE(validate_spirv(witnessed->optimized).ok());
    }
}

TEST_P(JudgeEachLanguage, RefusesAnUndeclaredNameWithItsLine) {
    Source source = parallax_pixel(GetParam());
    const int line = static_cast<int>(
        std::count(
            source.text.begin(),
            source.text.begin() + static_cast<std::ptrdiff_t>(source.text.find("float t = 0.0;")),
            '\n') +
        1);
    source.text = replaced(source.text, "float t = 0.0;", "float t = no_such_name;");
    const Result<Witnessed> witnessed = judge(source);
    ASSERT_FALSE(witnessed.ok());
    EXPECT_THAT(witnessed.error().message, HasSubstr("no_such_name"));
    EXPECT_EQ(witnessed.error().line, line);
    EXPECT_EQ(witnessed.error().file, "parallax.pixel");
    EXPECT_THAT(witnessed.error().notes, ElementsAre(HasSubstr("float t = no_such_name;")));
}

TEST_P(JudgeEachLanguage, DerivesMetalAndBinary) {
    const Result<std::string> metal = derive_msl(parallax_pixel(GetParam()));
    ASSERT_TRUE(metal.ok()) << to_string(metal.error());
    EXPECT_THAT(*metal, HasSubstr("fragment main0_out main0("));
    const Result<SpirvWords> words = derive_spirv(parallax_pixel(GetParam()));
    ASSERT_TRUE(words.ok()) << to_string(words.error());
    const Result<Witnessed> witnessed = judge(parallax_pixel(GetParam()));
    ASSERT_TRUE(witnessed.ok());
    EXPECT_EQ(*words, witnessed->optimized) << "two ways to the same binary differ";
}

INSTANTIATE_TEST_SUITE_P(Languages, JudgeEachLanguage, ::testing::ValuesIn(spirv_languages),
                         [](const auto& instance) { return std::string(name_of(instance.param)); });

TEST(Judge, OldGlslEndsAfterTheFrontEnd) {
    for (const Language language : {Language::Glsl120, Language::Essl100}) {
        for (const Source& source : {parallax_pixel(language), parallax_vertex(language)}) {
            const Result<Witnessed> witnessed = judge(source);
            ASSERT_TRUE(witnessed.ok()) << to_string(witnessed.error());
            EXPECT_THAT(witnessed->steps, ElementsAre("glslang " + std::string(name_of(language))));
            EXPECT_TRUE(witnessed->words.empty());
            const Result<SpirvWords> words = to_spirv(source);
            ASSERT_FALSE(words.ok());
            EXPECT_EQ(words.error().code, "no-spirv");
        }
    }
}

}  // namespace
}  // namespace intaglio::check

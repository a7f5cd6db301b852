// SPIRV-Tools is really asked: broken modules are refused at every door.
#include "src/check/spirv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "src/check/cost.h"
#include "src/check/cross.h"
#include "src/check/frontend.h"
#include "src/check/reflect.h"
#include "tests/unit/check/shaders.h"

namespace intaglio::check {
namespace {

using ::testing::HasSubstr;

SpirvWords good_words() {
    Result<SpirvWords> words = to_spirv(parallax_pixel(Language::Glsl450));
    return words ? std::move(*words) : SpirvWords{};
}

TEST(Spirv, RefusesAModuleWithoutEntryPointsCapability) {
    SpirvWords words = good_words();
    ASSERT_GT(words.size(), 7u);
    // The first instruction is OpCapability Shader: words 5 and 6 after the header.
    ASSERT_EQ(words[5], (2u << 16) | 17u);
    words.erase(words.begin() + 5, words.begin() + 7);
    const Status valid = validate_spirv(words);
    ASSERT_FALSE(valid.ok());
    EXPECT_EQ(valid.error().code, "spirv-invalid");
    EXPECT_THAT(valid.error().message, HasSubstr("spirv-val: "));
    EXPECT_FALSE(optimize_spirv(words).ok());
    EXPECT_FALSE(reflect(words).ok());
    EXPECT_FALSE(cross_to(words, CrossTarget::Glsl450).ok());
    EXPECT_FALSE(count_spirv(words, 1).ok());
}

TEST(Spirv, RefusesNoModuleAtAll) {
    for (const SpirvWords& words : {SpirvWords{}, SpirvWords{0x07230203}, SpirvWords(64, 0)}) {
        EXPECT_FALSE(validate_spirv(words).ok());
        EXPECT_FALSE(disassemble(words).ok());
        EXPECT_FALSE(reflect(words).ok());
        EXPECT_FALSE(count_spirv(words, 1).ok());
    }
}

// A swapped operand or a truncation is refused or harmless, but never takes the process down.
TEST(Spirv, CorruptWordsAreMostlyRefusedAndNeverCrash) {
    const SpirvWords good = good_words();
    ASSERT_FALSE(good.empty());
    constexpr std::uint32_t seed = 20260;
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    int refused = 0;
    constexpr int rounds = 200;
    for (int round = 0; round < rounds; ++round) {
        SpirvWords words = good;
        const std::size_t place = 5 + random() % (words.size() - 5);
        words[place] ^= 1u << (random() % 32);
        if (!validate_spirv(words)) {
            ++refused;
            EXPECT_FALSE(reflect(words).ok());
        } else {
            static_cast<void>(reflect(words));
            static_cast<void>(count_spirv(words, 4));
        }
    }
    // The rest are flips inside names and constants, which remain valid.
    EXPECT_GT(refused, rounds / 2);
}

TEST(Spirv, OptimizingTwiceStaysValidAndKeepsTheInterface) {
    for (const Language language : spirv_languages) {
        const Result<SpirvWords> words = to_spirv(parallax_pixel(language));
        ASSERT_TRUE(words.ok());
        const Result<SpirvWords> once = optimize_spirv(*words);
        ASSERT_TRUE(once.ok());
        const Result<SpirvWords> twice = optimize_spirv(*once);
        ASSERT_TRUE(twice.ok());
        const Result<Reflection> before = reflect(*words);
        const Result<Reflection> after = reflect(*twice);
        ASSERT_TRUE(before.ok() && after.ok());
        EXPECT_EQ(before->blocks, after->blocks) << name_of(language);
        EXPECT_EQ(before->images, after->images) << name_of(language);
        EXPECT_EQ(before->outputs, after->outputs) << name_of(language);
    }
}

TEST(Spirv, TargetsVulkan11) {
    const SpirvWords words = good_words();
    ASSERT_GT(words.size(), 5u);
    EXPECT_EQ(words[1], 0x00010300u) << "SPIR-V 1.3";
    EXPECT_THAT(*disassemble(words), HasSubstr("OpEntryPoint Fragment %main"));
}

// At the Vulkan 1.3 target discard becomes demote, and plain GLSL cannot say that.
TEST(Spirv, DiscardCrossesToEveryLanguage) {
    const Source source{.language = Language::Hlsl5,
                        .stage = Stage::Pixel,
                        .text =
                            "float4 main(float2 uv : TEXCOORD0) : SV_Target {\n"
                            "    if (uv.x < 0.5) discard;\n"
                            "    return uv.xyxy;\n}\n"};
    const Result<SpirvWords> words = to_spirv(source);
    ASSERT_TRUE(words.ok()) << to_string(words.error());
    for (const CrossTarget target : {CrossTarget::Glsl450, CrossTarget::Glsl330,
                                     CrossTarget::Essl300, CrossTarget::Hlsl50, CrossTarget::Msl}) {
        const Result<std::string> text = cross_to(*words, target);
        ASSERT_TRUE(text.ok()) << to_string(text.error());
        EXPECT_THAT(*text, HasSubstr("discard")) << name_of(target);
    }
}

TEST(Cross, HlslRegistersStayWithinShaderModel5) {
    for (const Language language : spirv_languages) {
        const Result<SpirvWords> words = to_spirv(parallax_pixel(language));
        ASSERT_TRUE(words.ok());
        const Result<std::string> text = cross_to(*words, CrossTarget::Hlsl50);
        ASSERT_TRUE(text.ok());
        EXPECT_THAT(*text, HasSubstr("register(b0)")) << name_of(language);
        EXPECT_THAT(*text, HasSubstr("register(t0)")) << name_of(language);
        EXPECT_THAT(*text, HasSubstr("register(s0)")) << name_of(language);
    }
}

}  // namespace
}  // namespace intaglio::check

// What the front end refuses, and how it says so.
#include "src/check/frontend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "src/check/spirv.h"
#include "tests/unit/check/shaders.h"

namespace intaglio::check {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

Source pixel(Language language, std::string text) {
    return {
        .language = language, .stage = Stage::Pixel, .text = std::move(text), .name = "test.frag"};
}

TEST(Parse, QuotesTheLineOfASyntaxError) {
    const Status parsed = parse(pixel(Language::Glsl450,
                                      "#version 450\n"
                                      "layout(location = 0) out vec4 color;\n"
                                      "void main() {\n"
                                      "    color = vec4(1.0)) ;\n"
                                      "}\n"));
    ASSERT_FALSE(parsed.ok());
    EXPECT_EQ(parsed.error().code, "glsl-refused");
    EXPECT_EQ(parsed.error().line, 4);
    EXPECT_THAT(parsed.error().message, HasSubstr("glslang refuses this glsl_450 pixel stage"));
    EXPECT_THAT(parsed.error().message, HasSubstr("syntax error"));
    EXPECT_EQ(parsed.error().message.find('\n'), std::string::npos);
    EXPECT_THAT(parsed.error().notes, ElementsAre("line 4: color = vec4(1.0)) ;"));
}

TEST(Parse, RefusesHlslSyntaxErrorsToo) {
    const Status parsed = parse(
        pixel(Language::Hlsl5, "float4 main() : SV_Target {\n    return float4(1.0, 2.0;\n}\n"));
    ASSERT_FALSE(parsed.ok());
    EXPECT_EQ(parsed.error().code, "hlsl-refused");
    EXPECT_EQ(parsed.error().line, 2);
}

TEST(Parse, RefusesATextInAnotherLanguage) {
    Source source = parallax_pixel(Language::Glsl450);
    source.language = Language::Glsl330;
    const Status wrong = parse(source);
    ASSERT_FALSE(wrong.ok());
    EXPECT_EQ(wrong.error().code, "version-mismatch");
    EXPECT_EQ(wrong.error().line, 1);
    const Status none = parse(pixel(Language::Glsl330, "void main() {}\n"));
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().code, "version-mismatch");
}

TEST(Parse, Glsl330KnowsNothingOf450) {
    // The relaxed Vulkan rules on the way to SPIR-V must not leak into the language's own.
    const Source source = pixel(Language::Glsl330,
                                "#version 330\n"
                                "layout(binding = 3) uniform sampler2D map;\n"
                                "out vec4 color;\n"
                                "void main() { color = texture(map, vec2(0.0)); }\n");
    const Status parsed = parse(source);
    ASSERT_FALSE(parsed.ok());
    EXPECT_EQ(parsed.error().line, 2);
}

// GLSL ES 1.00 appendix A: WebGL 1 has neither `while` nor loops with computed bounds.
TEST(Parse, Essl100HoldsToAppendixA) {
    const auto with_body = [](const std::string& body) {
        return pixel(Language::Essl100,
                     "#version 100\nprecision highp float;\nvarying vec2 uv;\nuniform int steps;\n"
                     "void main() {\n    float t = uv.x;\n" +
                         body + "    gl_FragColor = vec4(t);\n}\n");
    };
    EXPECT_TRUE(
        parse(with_body("    for (int i = 0; i < 8; i++) { if (t > 2.0) break; t += 1.0; }\n"))
            .ok());
    // The grammar of the appendix has no prefix form.
    EXPECT_FALSE(parse(with_body("    for (int i = 0; i < 8; ++i) { t += 1.0; }\n")).ok());
    EXPECT_FALSE(parse(with_body("    while (t < 2.0) { t += 1.0; }\n")).ok());
    EXPECT_FALSE(parse(with_body("    do { t += 1.0; } while (t < 2.0);\n")).ok());
    EXPECT_FALSE(parse(with_body("    for (int i = 0; i < steps; i++) { t += 1.0; }\n")).ok());
    EXPECT_FALSE(parse(with_body("    for (;;) { t += 1.0; if (t > 2.0) break; }\n")).ok());
}

TEST(ToSpirv, KeepsPreciseAsNoContraction) {
    const Source precise = parallax_pixel(Language::Glsl450);
    const Result<SpirvWords> words = to_spirv(precise);
    ASSERT_TRUE(words.ok()) << to_string(words.error());
    const Result<SpirvWords> optimized = optimize_spirv(*words);
    ASSERT_TRUE(optimized.ok());
    Source contractible = precise;
    contractible.text = replaced(contractible.text, "precise out", "out");
    const Result<SpirvWords> loose = to_spirv(contractible);
    ASSERT_TRUE(loose.ok());

    const auto decorations = [](const SpirvWords& module) {
        const Result<std::string> text = disassemble(module);
        int found = 0;
        for (std::size_t at = text->find("NoContraction"); at != std::string::npos;
             at = text->find("NoContraction", at + 1)) {
            ++found;
        }
        return found;
    };
    // slide: / and *; t: +; color: * and -.  `at` is not among them: glslang's `precise` does not
    // reach through the arguments of a texture fetch, nor through conditions.
    EXPECT_EQ(decorations(*words), 5);
    EXPECT_EQ(decorations(*optimized), 5);
    EXPECT_EQ(decorations(*loose), 0);
}

TEST(ToSpirv, Direct3D9SamplersNeedTheirOwnDialect) {
    // In HLSL 5's dialect glslang takes tex2D on a sampler2D and makes SPIR-V that the validator
    // refuses: both the reason for Hlsl3's settings and the proof that the validator is asked.
    const std::string text =
        "sampler2D map : register(s0);\n"
        "float4 main(float2 uv : TEXCOORD0) : SV_Target { return tex2D(map, uv); }\n";
    EXPECT_TRUE(parse(pixel(Language::Hlsl5, text)).ok());
    const Result<SpirvWords> wrong = to_spirv(pixel(Language::Hlsl5, text));
    ASSERT_FALSE(wrong.ok());
    EXPECT_EQ(wrong.error().code, "spirv-invalid");
    EXPECT_EQ(wrong.error().file, "test.frag");
    const Result<SpirvWords> right = to_spirv(pixel(Language::Hlsl3, text));
    EXPECT_TRUE(right.ok()) << to_string(right.error());
}

TEST(ToSpirv, HlslPreciseBecomesNoContraction) {
    const std::string text =
        "float4 main(float4 a : TEXCOORD0) : SV_Target { precise float4 b = a * a + a; return b; "
        "}\n";
    const Result<SpirvWords> precise = to_spirv(pixel(Language::Hlsl5, text));
    const Result<SpirvWords> loose =
        to_spirv(pixel(Language::Hlsl5, replaced(text, "precise ", "")));
    ASSERT_TRUE(precise.ok() && loose.ok());
    EXPECT_THAT(*disassemble(*precise), HasSubstr("NoContraction"));
    EXPECT_THAT(*disassemble(*loose), Not(HasSubstr("NoContraction")));
}

TEST(ToSpirv, Glsl450HasEveryPlaceInItsText) {
    const Source source = parallax_pixel(Language::Glsl450);
    ASSERT_TRUE(to_spirv(source).ok());
    for (const char* place :
         {"layout(set = 0, binding = 16) ", "layout(location = 1) ", "set = 0, binding = 0, "}) {
        Source without = source;
        without.text = replaced(source.text, place, "");
        EXPECT_FALSE(to_spirv(without).ok()) << place;
    }
}

TEST(ToSpirv, HlslTakesTheNamedEntryPoint) {
    Source source = pixel(Language::Hlsl5,
                          "float4 red() : SV_Target { return float4(1.0, 0.0, 0.0, 1.0); }\n"
                          "float4 blue() : SV_Target { return float4(0.0, 0.0, 1.0, 1.0); }\n");
    source.entry = "blue";
    const Result<SpirvWords> words = to_spirv(source);
    ASSERT_TRUE(words.ok()) << to_string(words.error());
    EXPECT_THAT(*disassemble(*words), HasSubstr("OpEntryPoint Fragment %main \"main\""));
    source.entry = "green";
    EXPECT_FALSE(to_spirv(source).ok());
}

TEST(ToSpirv, IsTheSameFromEveryThread) {
    const Result<SpirvWords> expected = to_spirv(parallax_pixel(Language::Hlsl5));
    ASSERT_TRUE(expected.ok());
    std::vector<SpirvWords> results(4);
    std::vector<std::thread> threads;
    for (SpirvWords& result : results) {
        threads.emplace_back([&result] {
            Result<SpirvWords> words = to_spirv(parallax_pixel(Language::Hlsl5));
            if (words) result = std::move(*words);
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const SpirvWords& result : results) EXPECT_EQ(result, *expected);
}

}  // namespace
}  // namespace intaglio::check

// Diagnostics as users see them, nearest names, indented text.
#include <gtest/gtest.h>

#include "generator/base/nearest.h"
#include "generator/base/result.h"
#include "generator/base/text.h"

namespace intaglio {
namespace {

TEST(Diagnostic, SaysFileLineColumnSentenceAndCode) {
    Diagnostic error = input_error("knob-range", "knob taps takes 1 to 256", "scene.toml", 3, 7);
    error.notes = {"hint: use 256"};
    EXPECT_EQ(to_string(error),
              "scene.toml:3:7: error: knob taps takes 1 to 256 [knob-range]\n  hint: use 256");
    EXPECT_EQ(to_string(input_error("a", "b")), "error: b [a]");
    EXPECT_EQ(to_string(input_error("a", "b", "f", 0, 9)), "f: error: b [a]")
        << "a column without a line means nothing";
}

TEST(Result, HoldsAValueOrAnError) {
    Result<std::string> good = std::string("x");
    Result<std::string> bad = input_error("code", "sentence");
    EXPECT_TRUE(good.ok());
    EXPECT_EQ(*good, "x");
    EXPECT_FALSE(bad.ok());
    EXPECT_EQ(bad.error().code, "code");
    EXPECT_EQ(internal_error("a", "b").fault, Fault::Internal);
}

TEST(NearestName, FindsATypingError) {
    const std::vector<std::string> names = {"parallax_occlusion", "steep_parallax", "none"};
    EXPECT_EQ(nearest_name("paralax_oclusion", names), "parallax_occlusion");
    EXPECT_EQ(nearest_name("steep_paralax", names), "steep_parallax");
    EXPECT_EQ(nearest_name("qqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqq", names), "");
    EXPECT_EQ(unknown_name_sentence("search", "nnoe", names),
              "unknown search 'nnoe'; did you mean 'none'?");
    EXPECT_EQ(
        unknown_name_sentence("search", "zzzzzzzzzzzzzz", names),
        "unknown search 'zzzzzzzzzzzzzz'; there are: parallax_occlusion, steep_parallax, none");
}

TEST(TextBuilder, IndentsLinesButNotEmptyOnes) {
    TextBuilder text;
    text.line("{");
    text.indent();
    text.format("x = {};", 1);
    text.line();
    text.outdent();
    text.line("}");
    EXPECT_EQ(text.text(), "{\n    x = 1;\n\n}\n");
}

}  // namespace
}  // namespace intaglio

// Names, literals and line breaking by themselves.
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "generator/target/clike/layout.h"
#include "generator/target/clike/literals.h"
#include "generator/target/clike/names.h"
#include "tests/rounds.h"
#include "tests/unit/ir/random.h"

namespace intaglio::clike {
namespace {

TEST(Literals, ReadBackToTheSameBits) {
    const Spelling spelling{.ops = {},
                            .types = {},
                            .splat = {},
                            .float_from_bits = "cast(%0)",
                            .rolled_loop = {},
                            .precise = {}};
    ir::testing::Random random(42);
    for (int i = 0; i < rounds(100000); ++i) {
        const float value = random.any_float();
        const auto bits = std::bit_cast<std::uint32_t>(value);
        const std::string text = *float_literal(bits, spelling);
        if (!std::isfinite(value)) {
            EXPECT_EQ(text.rfind("cast(0x", 0), 0u) << text;
            continue;
        }
        EXPECT_NE(text.find_first_of(".e"), std::string::npos) << text;
        // Compilers read a double and round once more.
        EXPECT_EQ(
            std::bit_cast<std::uint32_t>(static_cast<float>(std::strtod(text.c_str(), nullptr))),
            bits)
            << text;
    }
    EXPECT_EQ(*float_literal(std::bit_cast<std::uint32_t>(0.125f), spelling), "0.125");
    EXPECT_EQ(*float_literal(std::bit_cast<std::uint32_t>(1.0f), spelling), "1.0");
    EXPECT_EQ(*float_literal(std::bit_cast<std::uint32_t>(-0.0f), spelling), "-0.0");
    EXPECT_EQ(*float_literal(std::bit_cast<std::uint32_t>(1e-30f), spelling), "1e-30");
    EXPECT_EQ(int_literal(0x80000000u), "(-2147483647 - 1)");
    EXPECT_EQ(int_literal(0xffffffffu), "-1");
}

TEST(Names, AreLegalEverywhere) {
    EXPECT_EQ(legal_name("height"), "height");
    EXPECT_EQ(legal_name("gl_Position"), "n_gl_Position");
    EXPECT_EQ(legal_name("two__words"), "two_words");
    EXPECT_EQ(legal_name("_edge_"), "edge");
    EXPECT_EQ(legal_name("2nd try"), "n_2nd_try");
    EXPECT_EQ(legal_name("caf\xc3\xa9"), "caf");
    EXPECT_EQ(legal_name("\xc3\xa9"), "");
    for (const char* word :
         {"input", "output", "sample", "texture", "half", "float4x4", "vec3", "sampler2DShadow",
          "Texture2D", "saturate", "kernel", "main", "precise", "int", "uint3", "min16float2"})
        EXPECT_TRUE(is_reserved(word)) << word;
    for (const char* word : {"sampler_size", "intensity", "floating", "image_scale", "vector2",
                             "height", "texture_size"})
        EXPECT_FALSE(is_reserved(word)) << word;
}

TEST(Names, AreNumberedWhereTheyMeetAndFreeAgainAfterTheirScope) {
    NameScope scope;
    EXPECT_EQ(scope.declare("t"), "t");
    EXPECT_EQ(scope.declare("t"), "t_2");
    scope.open();
    EXPECT_EQ(scope.declare("t"), "t_3");
    EXPECT_EQ(scope.declare("\xc3\xa9", "sum"), "sum");
    EXPECT_EQ(scope.declare_everywhere("i"), "i");
    scope.close();
    EXPECT_EQ(scope.declare("sum"), "sum");
    EXPECT_EQ(scope.declare("i"), "i_2");
}

std::string put(std::string_view statement) {
    TextBuilder out;
    put_statement(out, statement);
    return out.take();
}

TEST(Lines, BreakLeastNestedThenLoosest) {
    const std::string a(28, 'a'), b(28, 'b'), c(28, 'c'), d(28, 'd');
    EXPECT_EQ(put(a + " * " + b + " + " + c + " * " + d + ";"),
              a + " * " + b + "\n    + " + c + " * " + d + ";\n");
    EXPECT_EQ(put("f(" + a + ", " + b + " + " + c + " * " + d + ");"),
              "f(" + a + ",\n    " + b + " + " + c + " * " + d + ");\n");
    EXPECT_EQ(put(std::string(150, 'x')), std::string(150, 'x') + "\n");
}

TEST(Comments, CannotEndEarly) {
    TextBuilder out;
    put_comment(out, "one\ntwo \\");
    EXPECT_EQ(out.text(), "// one two /\n");
}

}  // namespace
}  // namespace intaglio::clike

// parse(print(m)) == m on thousands of random modules, hand-written text, malformed text, and
// random damage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "tests/rounds.h"
#include "tests/unit/ir/random_module.h"

namespace intaglio::ir {
namespace {

using ::testing::HasSubstr;
using testing::Random;
using testing::random_module;

constexpr const char* march = R"(pixel "march"
input uv float2 interpolant
output colour float4 target
uniform scale float1 "depth of the relief in texture units"
uniform world float4[3]
sampler height_map 2d
sampler distance_map 3d nearest "empty radius"
sampler phong_map 2d baked "shininess=32"
file "templates/search/parallax_occlusion.cpp"
step march "March the view ray down through the relief."
{
    %0 "uv" float2 = input uv @0:25 #march
    %1 float1 = const 0.0
    %2 float4 = uniform world[2]
    %3 float1 = uniform scale
    %4 float3 = const (0.1, -0.0, inf)
    %5 float1 = dot %4, %4
    %13 float1, %14 float1 = loop "march" 8 rolled closed_form (%1, %5) @0:30 #march {
    (%6 "i" int1, %7 float1, %8 "above" float1):
        %9 float4 = sample_level height_map %0, %7
        %10 float1 = swizzle %9.w
        %11 bool1 = greater_equal %10, %3
        break_if %11 (%7, %10)
        %12 float1 = add %7, %3
        yield (%12, %10)
    }
    %15 bool1 = less %13, %14
    %18 float4 = if %15 {
        %16 float4 = const (0x7fc00001, 1e-40, 3.4028235e+38, 0.5)
        yield (%16)
    } else {
        %17 float4 = swizzle %0.xyxy
        yield (%17)
    }
    return (%18)
}
)";

TEST(Print, GivesBackTheTextItParsed) {
    const auto module = parse(march, "march.ir");
    ASSERT_TRUE(module) << to_string(module.error());
    EXPECT_TRUE(verify(*module));
    EXPECT_EQ(print(*module), march);
}

TEST(Print, WritesEachFloatSoThatItReadsBackToItsBits) {
    EXPECT_EQ(print_component(Scalar::Float, float_bits(0.1f)), "0.1");
    EXPECT_EQ(print_component(Scalar::Float, float_bits(-0.0f)), "-0.0");
    EXPECT_EQ(print_component(Scalar::Float, float_bits(3.0f)), "3.0");
    EXPECT_EQ(print_component(Scalar::Float, 0xff800000u), "-inf");
    EXPECT_EQ(print_component(Scalar::Float, 0xffc00000u), "0xffc00000");
    EXPECT_EQ(print_component(Scalar::Float, 1u), "1e-45");
    EXPECT_EQ(print_component(Scalar::Int, 0xffffffffu), "-1");
    EXPECT_EQ(print_component(Scalar::Bool, 1u), "true");
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
        const auto bits = static_cast<std::uint32_t>(random.bits());
        std::string text = "function \"f\" { %0 float1 = const ";
        text.append(print_component(Scalar::Float, bits)).append(" }");
        const auto module = parse(text, "f.ir");
        ASSERT_TRUE(module) << text;
        ASSERT_EQ(module->body.body[0].bits[0], bits) << text;
    }
}

TEST(Parse, UndoesPrintOnRandomModules) {
    int loops = 0;
    for (std::uint64_t seed = 0; seed < rounds(2000u); ++seed) {
        testing::RandomModuleOptions options;
        options.instructions = 5 + static_cast<int>(seed % 90);
        const Module module = random_module(seed, options);
        const Status status = verify(module);
        ASSERT_TRUE(status) << "seed " << seed << ": " << to_string(status.error()) << "\n"
                            << print(module);
        const std::string text = print(module);
        const auto again = parse(text, "random.ir");
        ASSERT_TRUE(again) << "seed " << seed << ": " << to_string(again.error()) << "\n" << text;
        ASSERT_TRUE(*again == module) << "seed " << seed << "\n" << text;
        ASSERT_EQ(print(*again), text) << "seed " << seed;
        loops += text.find(" = loop ") != std::string::npos ? 1 : 0;
    }
    EXPECT_GT(loops, rounds(500));  // otherwise the generator has stopped testing regions
}

TEST(Parse, TakesTextWrittenByHand) {
    const auto module = parse(R"(
        function "half" // no origins, no numbers
        input a float1 parameter
        output b float1 result
        {
            %a float1 = input a
            %half float1 = const .5e0 // no digit before the point
            %b float1 = mul %a, %half
            return (%b)
        })",
                              "half.ir");
    ASSERT_FALSE(module);  // a float begins with a digit
    EXPECT_EQ(to_string(module.error()),
              "half.ir:7:34: error: expected a component of a float1, found '.' [ir-parse]");
    const auto repaired = parse(R"(function "half" input a float1 parameter output b float1 result {
        %a float1 = input a  %half float1 = const 0.5
        %b "result" float1 = mul %a, %half  return (%b) })",
                                "half.ir");
    ASSERT_TRUE(repaired) << to_string(repaired.error());
    EXPECT_TRUE(verify(*repaired));
    EXPECT_EQ(repaired->value(static_cast<ValueId>(1)).name, "half");
    EXPECT_EQ(repaired->value(static_cast<ValueId>(2)).name, "result");
    EXPECT_TRUE(*parse(print(*repaired), "again.ir") == *repaired);
}

TEST(Parse, SaysWhatIsWrongAndWhere) {
    const struct {
        const char* text;
        const char* message;
    } cases[] = {
        {"", "t.ir:1:1: error: expected 'vertex', 'pixel' or 'function', found the end [ir-parse]"},
        {"pixel \"a\n", "t.ir:1:9: error: a string ends on the line it begins on [ir-parse]"},
        {"pixel \"a\\q\" {}", "a backslash in a string is followed by"},
        {"pixel \"a\" { \x01 }", "t.ir:1:13: error: the byte 0x01 has no meaning here [ir-parse]"},
        {"pixel \"a\" { & }", "'&' has no meaning here"},
        {"pixel \"a\" { % }", "a value is written as % and a number or a word"},
        {"pixel \"a\" {} {}", "expected the end after the module's body, found '{'"},
        {"pixel \"a\" inpt",
         "expected a declaration (input, output, uniform, sampler, file, step, value) or '{'"},
        {"pixel \"a\" input uv float5",
         "expected a type such as float3, int1 or bool1, found 'float5'"},
        {"pixel \"a\" input uv float2 color", "'attribute', 'interpolant', 'position', 'target'"},
        {"pixel \"a\" sampler s 2", "expected a dimension, 2d or 3d, found '2'"},
        {"pixel \"a\" uniform u float1[x]", "expected an integer, found 'x'"},
        {"pixel \"a\" { %0 float1 = const 1e50 }",
         "expected a component of a float1, found '1e50'"},
        {"pixel \"a\" { %0 float2 = const (1.0 2.0) }", "expected ',', found '2.0'"},
        {"pixel \"a\" { %0 bool1 = const 1 }", "expected a component of a bool1, found '1'"},
        {"pixel \"a\" { %0 float1 = const 1.0 %0 float1 = const 1.0 }", "%0 is already defined"},
        {"pixel \"a\" { %0 float1 = neg %1 }", "t.ir:1:29: error: %1 is never defined [ir-parse]"},
        {"pixel \"a\" { %1 float1 = const 1.0 }",
         "%1 is defined but %0 is not; numbers have no gaps"},
        {"pixel \"a\" { %99999999999 float1 = const 1.0 }", "its number is malformed"},
        {"pixel \"a\" { %a float1 = neg %0 }", "values are called by numbers or by words"},
        {"pixel \"a\" { %0 float1 = input uv }", "no input is called 'uv'"},
        {"pixel \"a\" { %0 float1 = negate %0 }", "expected an instruction, found 'negate'"},
        {"pixel \"a\" { const 1.0 }", "'const' defines one value"},
        {"pixel \"a\" { %0 float3 = swizzle %0.xy }", "expected 3 of the letters xyzw, found 'xy'"},
        {"pixel \"a\" { if %0 { } }", "expected 'else', found '}'"},
        {"pixel \"a\" { yield () #march }", "no step is called 'march'"},
    };
    for (const auto& [text, message] : cases) {
        const auto module = parse(text, "t.ir");
        ASSERT_FALSE(module) << text;
        EXPECT_THAT(to_string(module.error()), HasSubstr(message)) << text;
        EXPECT_THAT(to_string(module.error()), HasSubstr("[ir-parse]"));
    }
}

TEST(Parse, RefusesNestingThatWouldExhaustTheStack) {
    std::string text = "pixel \"deep\" { %0 bool1 = const true ";
    for (int i = 0; i < 100000; ++i) text += "if %0 { ";
    const auto module = parse(text, "deep.ir");
    ASSERT_FALSE(module);
    EXPECT_EQ(module.error().message, "regions nest deeper than 64");
}

// Damaged text never crashes, hangs or trips a sanitizer; whatever still parses can be verified and
// printed, and what then verifies reads back to itself.
TEST(Parse, SurvivesDamage) {
    Random random(20240607);
    std::vector<std::string> texts(10, march);
    for (std::uint64_t seed = 0; seed < 30; ++seed)
        texts.push_back(print(random_module(seed, {.instructions = 20})));
    int parsed = 0, verified = 0;
    for (int i = 0; i < 6000; ++i) {
        std::string text = texts[static_cast<std::size_t>(random.below(40))];
        for (int edits = random.between(1, 3); edits > 0 && !text.empty(); --edits) {
            const auto at = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
            const auto from = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
            switch (random.below(6)) {
                case 0: text[at] = static_cast<char>(random.below(256)); break;
                case 1: text.erase(at, static_cast<std::size_t>(random.between(1, 8))); break;
                case 2:
                    text.insert(at,
                                text.substr(from, static_cast<std::size_t>(random.between(1, 20))));
                    break;
                case 3: text[at] = text[from]; break;
                case 4: text[at] = static_cast<char>('0' + random.below(10)); break;
                case 5:
                    if (random.chance(10)) text.resize(at);
                    break;
            }
        }
        const auto module = parse(text, "damaged.ir");
        if (!module) continue;
        ++parsed;
        const std::string printed = print(*module);
        if (!verify(*module)) continue;
        ++verified;
        const auto again = parse(printed, "again.ir");
        ASSERT_TRUE(again) << to_string(again.error()) << "\n" << printed;
        ASSERT_TRUE(*again == *module) << "edit " << i << "\n" << printed;
    }
    EXPECT_GT(parsed, verified);
    EXPECT_GT(verified, 300);
}

TEST(Print, SurvivesIdsAndIndexesOutOfRange) {
    Module module = *parse(march, "march.ir");
    for (Instruction& instruction : module.body.body) {
        for (ValueId& id : instruction.results) id = static_cast<ValueId>(1000);
        instruction.slot = -7;
        instruction.lanes = {200, 200, 200, 200};
        instruction.origin = {-5, -5, 99};
    }
    EXPECT_THAT(print(module), HasSubstr("%1000 ? = uniform $-7[0] @-5:-5 #99"));
    EXPECT_FALSE(verify(module));
}

}  // namespace
}  // namespace intaglio::ir

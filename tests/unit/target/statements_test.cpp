// What the printed statements look like: who gets a variable, what is inlined, where parentheses
// and comments stand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/target/programs.h"

namespace intaglio {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// The body of main(), printed as the module stands: no pass has run.
std::string printed(std::string_view module_text, std::string_view target = "glsl_330") {
    const auto artifact = find_target(target)->print(
        testing::program_of(testing::parsed(module_text)), ir::Stage::Pixel);
    EXPECT_TRUE(artifact.ok()) << to_string(artifact.error());
    return testing::body_of(artifact->text);
}

// The result of one expression over floats a to d, vectors u and v, ints m and n.
std::string expression(const std::string& instructions) {
    std::string text = R"(
pixel "p"
input a float1 interpolant
input b float1 interpolant
input c float1 interpolant
input u float3 interpolant
input v float3 interpolant
output to float1 target
{
    %a float1 = input a
    %b float1 = input b
    %c float1 = input c
    %u float3 = input u
    %v float3 = input v
)";
    const std::string body = printed(text + instructions + "}\n");
    EXPECT_EQ(body.rfind("to = ", 0), 0u) << body;
    return body.substr(5, body.size() - 5 - 2);
}

TEST(Expressions, GroupAsTheModuleDoes) {
    EXPECT_EQ(expression("%_1 float1 = add %a, %b\n%_2 float1 = add %_1, %c\nreturn (%_2)\n"),
              "a + b + c");
    EXPECT_EQ(expression("%_1 float1 = add %b, %c\n%_2 float1 = add %a, %_1\nreturn (%_2)\n"),
              "a + (b + c)");
    EXPECT_EQ(expression("%_1 float1 = sub %b, %c\n%_2 float1 = sub %a, %_1\nreturn (%_2)\n"),
              "a - (b - c)");
    EXPECT_EQ(expression("%_1 float1 = mul %b, %c\n%_2 float1 = div %a, %_1\nreturn (%_2)\n"),
              "a / (b * c)");
    EXPECT_EQ(expression("%_1 float1 = mul %a, %b\n%_2 float1 = add %_1, %c\nreturn (%_2)\n"),
              "a * b + c");
    EXPECT_EQ(expression("%_1 float1 = neg %a\n%_2 float1 = neg %_1\nreturn (%_2)\n"), "-(-a)");
    EXPECT_EQ(expression("%_1 float1 = add %a, %b\n%_2 float1 = neg %_1\nreturn (%_2)\n"),
              "-(a + b)");
    EXPECT_EQ(expression("%k float1 = const -2.0\n%_2 float1 = neg %k\nreturn (%_2)\n"), "-(-2.0)");
    EXPECT_EQ(expression("%_1 bool1 = less %a, %b\n%_2 bool1 = not %_1\n%_3 float1 = select %_2, "
                         "%a, %c\nreturn (%_3)\n"),
              "!(a < b) ? a : c");
    EXPECT_EQ(expression("%_1 float3 = add %u, %v\n%_2 float1 = swizzle %_1.y\nreturn (%_2)\n"),
              "(u + v).y");
}

TEST(Expressions, KeepScalarsBesideVectors) {
    EXPECT_EQ(expression("%_1 float3 = swizzle %a.xxx\n%_2 float3 = mul %u, %_1\n%_3 float1 = dot "
                         "%_2, %v\nreturn (%_3)\n"),
              "dot(u * a, v)");
    EXPECT_EQ(expression("%_1 float3 = const (0.0, 0.0, 0.0)\n%_2 float3 = max %u, %_1\n%_3 float1 "
                         "= dot %_2, %v\n"
                         "return (%_3)\n"),
              "dot(max(u, 0.0), v)");
    EXPECT_EQ(expression("%_1 float3 = const (1.0, 1.0, 1.0)\n%_2 float3 = max %_1, %u\n%_3 float1 "
                         "= dot %_2, %v\n"
                         "return (%_3)\n"),
              "dot(max(vec3(1.0), u), v)");
    EXPECT_EQ(
        expression(
            "%_1 float3 = swizzle %a.xxx\n%_2 float3 = swizzle %b.xxx\n%_3 float3 = mul %_1, %_2\n"
            "%_4 float1 = dot %_3, %v\nreturn (%_4)\n"),
        "dot(vec3(a) * b, v)");
    EXPECT_EQ(expression("%_1 float3 = swizzle %u.zzz\n%_2 float3 = mul %v, %_1\n%_3 float1 = dot "
                         "%_2, %v\nreturn (%_3)\n"),
              "dot(v * u.z, v)");
}

constexpr std::string_view loop_head = R"(
pixel "p"
input a float1 interpolant
input b float1 interpolant
output to float2 target
{
    %a float1 = input a
    %b float1 = input b
)";

TEST(Loops, StoreCarriedValuesWhereTheyAreComputed) {
    const std::string body = printed(std::string(loop_head) + R"(
    %zero float1 = const 0.0
    %first float1, %second float1 = loop "march" 8 (%zero, %a) {
    (%i int1, %above float1, %below float1):
        %done bool1 = greater_equal %below, %zero
        break_if %done (%above, %below)
        %less float1 = sub %below, %b
        yield (%below, %less)
    }
    %both float2 = compose %first, %second
    return (%both)
})");
    EXPECT_EQ(body,
              "float above = 0.0;\n"
              "float below = a;\n"
              "for (int i = 0; i < 8; ++i) {\n"
              "    bool done = below >= 0.0;\n"
              "    if (done) break;\n"
              "    above = below;\n"
              "    below = below - b;\n"
              "}\n"
              "to = vec2(above, below);\n");
}

TEST(Loops, SwapThroughACopyOnly) {
    const std::string body = printed(std::string(loop_head) + R"(
    %_1 float1, %_2 float1 = loop "swap" 3 (%a, %b) {
    (%_3 int1, %x float1, %y float1):
        yield (%y, %x)
    }
    %both float2 = compose %_1, %_2
    return (%both)
})");
    EXPECT_EQ(body,
              "float x = a;\n"
              "float y = b;\n"
              "for (int i = 0; i < 3; ++i) {\n"
              "    float old_x = x;\n"
              "    x = y;\n"
              "    y = old_x;\n"
              "}\n"
              "to = vec2(x, y);\n");
}

TEST(Loops, NestWithNamesOfTheirOwnAndShareTheCarriedVariable) {
    const std::string body = printed(std::string(loop_head) + R"(
    %_1 float1 = loop "outer" 3 (%a) {
    (%_2 int1, %t float1):
        %_3 float1 = loop "inner" 4 (%t) {
        (%_4 int1, %_5 float1):
            %_6 float1 = to_float %_4
            %_7 float1 = add %_5, %_6
            %_8 bool1 = greater %_7, %b
            break_if %_8 (%b)
            yield (%_7)
        }
        yield (%_3)
    }
    %both float2 = compose %_1, %b
    return (%both)
})");
    EXPECT_EQ(body,
              "float t = a;\n"
              "for (int i = 0; i < 3; ++i) {\n"
              "    for (int j = 0; j < 4; ++j) {\n"
              "        t = t + float(j);\n"
              "        if (t > b) {\n"
              "            t = b;\n"
              "            break;\n"
              "        }\n"
              "    }\n"
              "}\n"
              "to = vec2(t, b);\n");
}

TEST(Loops, KeepReadsOutsideThatStandOutside) {
    const std::string body = printed(R"(
pixel "p"
input uv float2 interpolant
output to float4 target
sampler map 2d
{
    %uv float2 = input uv
    %zero float1 = const 0.0
    %start float4 = const (0.0, 0.0, 0.0, 0.0)
    %read float4 = sample_level map %uv, %zero
    %sum float4 = loop "sum" 4 (%start) {
    (%i int1, %s float4):
        %more float4 = add %s, %read
        yield (%more)
    }
    return (%sum)
})");
    EXPECT_THAT(body, HasSubstr("vec4 read = textureLod(map, uv, 0.0);\nvec4 s = vec4(0.0);\nfor"));
    EXPECT_THAT(body, HasSubstr("    s = s + read;\n"));
}

TEST(Ifs, StoreIntoTheVariableThatTheyMayChange) {
    const std::string body = printed(std::string(loop_head) + R"(
    %zero float1 = const 0.0
    %_1 float1 = loop "best" 8 (%zero) {
    (%i int1, %best float1):
        %_3 float1 = to_float %i
        %score float1 = mul %_3, %b
        %_4 bool1 = greater %score, %best
        %_5 float1 = if %_4 {
            yield (%score)
        } else {
            yield (%best)
        }
        yield (%_5)
    }
    %both float2 = compose %_1, %b
    return (%both)
})");
    EXPECT_EQ(body,
              "float best = 0.0;\n"
              "for (int i = 0; i < 8; ++i) {\n"
              "    float score = float(i) * b;\n"
              "    if (score > best) {\n"
              "        best = score;\n"
              "    }\n"
              "}\n"
              "to = vec2(best, b);\n");
}

TEST(Steps, BeginWithTheirCommentOnce) {
    const std::string body = printed(R"(
pixel "p"
input a float1 interpolant
output to float1 target
file "f.cpp"
step setup "Prepare."
step march "Walk down."
{
    %a float1 = input a @0:1 #setup
    %x float1 = sqrt %a @0:2 #setup
    %y float1 = add %x, %x @0:3 #march
    %z float1 = mul %y, %y @0:4 #march
    %w float1 = add %z, %x @0:5 #march
    return (%w)
})");
    EXPECT_EQ(body,
              "// Prepare.\n"
              "float x = sqrt(a);\n"
              "\n"
              "// Walk down.\n"
              "float y = x + x;\n"
              "float z = y * y;\n"
              "to = z + x;\n");
}

TEST(Names, AvoidWordsOfEveryLanguageAndEachOther) {
    const std::string body = printed(R"(
pixel "p"
input texture float1 interpolant
input half float1 interpolant
output output float1 target
uniform sample float1
{
    %texture float1 = input texture
    %half float1 = input half
    %sample float1 = uniform sample
    %input float1 = mul %texture, %half
    %float3 float1 = mul %input, %sample
    %dot float1 = add %float3, %input
    %again float1 = mul %dot, %dot
    return (%again)
})");
    EXPECT_EQ(body,
              "float input_value = texture_value * half_value;\n"
              "float float3_value = input_value * sample_value;\n"
              "float dot_value = float3_value + input_value;\n"
              "output_value = dot_value * dot_value;\n");
}

TEST(LoopHints, StandWhereTheScheduleKeepsALoopAndTheLanguageHasAWord) {
    const std::string module = std::string(loop_head) + R"(
    %_1 float1 = loop "march" 200 rolled (%a) {
    (%_2 int1, %t float1):
        %_3 float1 = add %t, %b
        yield (%_3)
    }
    %both float2 = compose %_1, %b
    return (%both)
})";
    const ir::Program program = testing::program_of(testing::parsed(module));
    const std::string vulkan = testing::emitted(program, ir::Stage::Pixel, "glsl_450").text;
    EXPECT_THAT(vulkan, HasSubstr("#extension GL_EXT_control_flow_attributes : require\n"));
    EXPECT_THAT(vulkan, HasSubstr("    [[dont_unroll]] for (int i = 0;"));
    EXPECT_THAT(testing::emitted(program, ir::Stage::Pixel, "hlsl_5_0").text,
                HasSubstr("    [loop] for (int i = 0;"));
    EXPECT_THAT(testing::emitted(program, ir::Stage::Pixel, "glsl_330").text,
                HasSubstr("\n    for (int i = 0;"));
    for (const testing::TextTarget& target : testing::text_targets) {
        const Artifact artifact = testing::emitted(program, ir::Stage::Pixel, target.name);
        const auto judged = check::judge(testing::source_of(artifact, target.language));
        EXPECT_TRUE(judged.ok()) << to_string(judged.error()) << artifact.text;
    }
}

TEST(Lines, StayWithinTheWidthAndBreakAtOperators) {
    std::string module = R"(
pixel "p"
input a_rather_long_name_of_an_input float4 interpolant
output to float4 target
uniform another_long_name_of_a_uniform float4 "A comment that is so long that it would not fit beside its declaration within a line."
{
    %_0 float4 = input a_rather_long_name_of_an_input
    %_1 float4 = uniform another_long_name_of_a_uniform
)";
    for (int i = 2; i < 8; ++i)
        module += "    %_" + std::to_string(i) + " float4 = " + (i % 2 ? "add %_" : "mul %_") +
                  std::to_string(i - 1) + ", %_" + std::to_string(i % 2) + "\n";
    const ir::Program program =
        testing::program_of(testing::parsed(module + "    return (%_7)\n}\n"));
    for (const testing::TextTarget& target : testing::text_targets) {
        const Artifact artifact = testing::emitted(program, ir::Stage::Pixel, target.name);
        std::istringstream lines(artifact.text);
        for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
        EXPECT_THAT(artifact.text, HasSubstr("\n        ")) << "nothing was broken";
        const Status words = testing::accepted(testing::source_of(artifact, target.language));
        EXPECT_TRUE(words.ok()) << to_string(words.error()) << artifact.text;
    }
}

}  // namespace
}  // namespace intaglio

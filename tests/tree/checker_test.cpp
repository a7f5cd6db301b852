// The checker on made-up files: what it must report, with file and line, and what it must let pass.
#include "tests/tree/checker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace intaglio::tree {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

struct Arrow {
    std::string_view path;
    std::string_view line;
};

class Forbidden : public ::testing::TestWithParam<Arrow> {};
class Allowed : public ::testing::TestWithParam<Arrow> {};

std::string third_line(std::string_view line) {
    return "// A comment.\n#pragma once\n" + std::string(line) + "\nint x;\n";
}

TEST_P(Forbidden, IsReportedWithItsLine) {
    const auto& [path, line] = GetParam();
    EXPECT_THAT(check_includes(rules(), path, third_line(line)),
                ElementsAre(StartsWith(std::string(path) + ":3: includes ")))
        << line;
}

INSTANTIATE_TEST_SUITE_P(
    Arrows, Forbidden,
    ::testing::Values(
        // Against the order of the two arms.
        Arrow{"generator/base/text.h", "#include \"generator/ir/module.h\""},
        Arrow{"generator/ir/print.cpp", "#include \"generator/passes/pipeline.h\""},
        Arrow{"generator/passes/pipeline.cpp", "#include \"generator/target/target.h\""},
        Arrow{"generator/passes/pipeline.cpp", "#include \"generator/dsl/schedule.h\""},
        Arrow{"generator/dsl/values.h", "#include \"generator/passes/rewrite.h\""},
        Arrow{"generator/dsl/values.h", "#include \"templates/all_techniques.h\""},
        Arrow{"generator/target/target.h", "#include \"generator/dsl/surface.h\""},
        Arrow{"generator/target/glsl/glsl.cpp", "#include \"templates/all_techniques.h\""},
        Arrow{"templates/search/none.cpp", "#include \"generator/target/target.h\""},
        Arrow{"templates/search/none.cpp", "#include \"generator/passes/pipeline.h\""},
        // One target to another, the shared printer to a target, a target to the list of all.
        Arrow{"generator/target/glsl/glsl.cpp", "#include \"generator/target/hlsl/hlsl.h\""},
        Arrow{"generator/target/hlsl/hlsl.cpp", "#include \"generator/target/none/none.h\""},
        Arrow{"generator/target/clike/plan.cpp", "#include \"generator/target/glsl/glsl.h\""},
        Arrow{"generator/target/target.cpp", "#include \"generator/target/glsl/glsl.h\""},
        // From the compiler to the world.
        Arrow{"generator/ir/print.cpp", "#include \"src/maps/image.h\""},
        Arrow{"generator/base/text.cpp", "#include <fstream>"},
        Arrow{"generator/passes/pipeline.cpp", "#include <filesystem>"},
        Arrow{"generator/target/target.cpp", "#include <chrono>"},
        Arrow{"generator/ir/print.cpp", "#include <random>"},
        Arrow{"templates/search/none.cpp", "#include <thread>"},
        Arrow{"generator/target/glsl/glsl.cpp", "#include <glslang/Public/ShaderLang.h>"},
        Arrow{"generator/target/glsl/glsl.cpp", "#include <spirv_glsl.hpp>"},
        Arrow{"generator/target/glsl/glsl.cpp", "#include <vulkan/vulkan.h>"},
        // Among the folders that touch the world.
        Arrow{"src/reference/trace.h", "#include \"generator/base/result.h\""},
        Arrow{"src/reference/trace.h", "#include \"src/maps/image.h\""},
        Arrow{"src/reference/trace.h", "#include <fmt_impostor.h>"},
        Arrow{"src/maps/bake.cpp", "#include \"src/reference/trace.h\""},
        Arrow{"src/check/cost.cpp", "#include \"generator/ir/module.h\""},
        Arrow{"src/vulkan/program.cpp", "#include \"src/variant/variant.h\""},
        Arrow{"src/variant/variant.cpp", "#include \"src/vulkan/device.h\""},
        Arrow{"src/measure/hits.cpp", "#include \"src/scene/measurement.h\""},
        Arrow{"src/scene/measurement.cpp", "#include \"src/cli/main.h\""},
        // In other spellings.
        Arrow{"generator/base/text.h", "  #  include   \"generator/ir/module.h\"  // why not"},
        Arrow{"generator/ir/print.cpp", "#include \"print.h\""},
        Arrow{"generator/ir/print.cpp", "#include \"../passes/pipeline.h\""},
        Arrow{"generator/ir/print.cpp", "#include \"generator/irresolute/print.h\""},
        Arrow{"generator/ir/print.cpp", "#include HEADER"}));

TEST_P(Allowed, Passes) {
    const auto& [path, line] = GetParam();
    EXPECT_THAT(check_includes(rules(), path, third_line(line)), IsEmpty()) << line;
}

INSTANTIATE_TEST_SUITE_P(
    Arrows, Allowed,
    ::testing::Values(
        Arrow{"generator/base/text.h", "#include \"generator/base/result.h\""},
        Arrow{"generator/base/text.h", "#include <fmt/format.h>"},
        Arrow{"generator/base/text.h", "#include <string>"},
        Arrow{"generator/passes/pipeline.cpp", "#include \"generator/ir/module.h\""},
        Arrow{"generator/target/all_targets.cpp", "#include \"generator/target/glsl/glsl.h\""},
        Arrow{"generator/target/glsl/glsl.cpp", "#include \"generator/target/clike/shell.h\""},
        Arrow{"templates/search/none.cpp", "#include \"generator/intaglio.h\""},
        Arrow{"src/check/frontend.cpp", "#include <glslang/Public/ShaderLang.h>"},
        Arrow{"src/measure/measure.cpp", "#include <thread>"},
        Arrow{"src/cli/main.cpp", "#include \"src/report/table.h\""},
        Arrow{"generator/base/text.h", "// #include \"generator/ir/module.h\""},
        Arrow{"generator/base/text.h", "int include; // # include"}));

TEST(Includes, SentenceNamesBothEndsOfTheArrow) {
    EXPECT_THAT(check_includes(rules(), "generator/base/a.h", "#include \"generator/ir/module.h\""),
                ElementsAre("generator/base/a.h:1: includes \"generator/ir/module.h\" of "
                            "generator/ir, but generator/base may see only nothing"));
}

TEST(Includes, EveryFaultIsReported) {
    EXPECT_THAT(
        check_includes(rules(), "generator/ir/a.cpp",
                       "#include <thread>\n\n#include <string>\n#include \"src/cli/a.h\""),
        ElementsAre(StartsWith("generator/ir/a.cpp:1: "), StartsWith("generator/ir/a.cpp:4: ")));
}

TEST(Includes, FolderWithoutARowIsReported) {
    EXPECT_THAT(check_includes(rules(), "generator/parser/a.cpp", "int x;"),
                ElementsAre(HasSubstr("no row")));
    EXPECT_THAT(check_includes(rules(), "generator/base_camp/a.cpp", "int x;"),
                ElementsAre(HasSubstr("no row")));
}

TEST(Text, LongFileIsReportedUnlessATable) {
    Rules few = rules();
    few.longest_file = 3;
    few.tables = {"a/table.cpp"};
    EXPECT_THAT(check_text(few, "a/code.cpp", "1\n2\n3\n"), IsEmpty());
    EXPECT_THAT(check_text(few, "a/code.cpp", "1\n2\n3"), IsEmpty());
    EXPECT_THAT(check_text(few, "a/code.cpp", "1\n2\n3\n4\n"),
                ElementsAre("a/code.cpp:4: has 4 lines; a file is full at 3"));
    EXPECT_THAT(check_text(few, "a/table.cpp", "1\n2\n3\n4\n"), IsEmpty());
}

TEST(Text, UnfinishedWorkIsReported) {
    EXPECT_THAT(check_text(rules(), "a.cpp",
                           "x\n// TO"
                           "DO: y\n# FIX"
                           "ME\n"),
                ElementsAre(StartsWith("a.cpp:2: "), StartsWith("a.cpp:3: ")));
    EXPECT_THAT(check_text(rules(), "a.cpp",
                           "TO"
                           "DOS a_TO"
                           "DO mas"
                           "TO"
                           "DON\n"),
                IsEmpty());
}

TEST(Rules, CircleAndUnknownRowAreReported) {
    Rules circle;
    circle.rows = {{"a", {}}, {"b", {"a", "c"}}, {"c", {"b"}}};
    EXPECT_THAT(check_rules(circle),
                AllOf(SizeIs(2), ElementsAre(HasSubstr("b stands"), HasSubstr("c stands"))));
    Rules unknown;
    unknown.rows = {{"a", {"z"}}};
    EXPECT_THAT(check_rules(unknown), Contains(HasSubstr("a sees z, which has no row")));
}

}  // namespace
}  // namespace intaglio::tree

// The table for people: aligned, complete, honest about what it merges and what it does not know.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sstream>

#include "src/report/report.h"
#include "tests/unit/report/sample.h"

namespace intaglio::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

// The lines of the block whose title begins so, the head first.
std::vector<std::string> block(const std::string& text, const std::string& title) {
    std::vector<std::string> found;
    bool inside = false;
    for (const std::string& line : lines_of(text)) {
        if (inside && line.empty()) break;
        if (inside) found.push_back(line);
        inside = inside || line.rfind(title, 0) == 0;
    }
    return found;
}

// The words of a line; cells of the sample have no blanks inside.
std::vector<std::string> words_of(const std::string& line) {
    std::istringstream stream(line);
    return {std::istream_iterator<std::string>(stream), {}};
}

TEST(Table, HasABlockPerMapViewAndLightWithALinePerVariant) {
    const Sample made = sample({{90, 0}, {30, 20}}, {{45, 135}, {-5, 10}});
    const std::string text = table(made.plan, made.measurement);
    for (const char* map : {"bricks", "smooth"})
        for (const char* view : {"straight above", "elevation 30 azimuth 20"})
            for (const char* light : {"elevation 45 azimuth 135", "elevation -5 azimuth 10"})
                EXPECT_EQ(block(text, fmt::format("{} (32 x 8), seen from {}, lit from {}", map,
                                                  view, light))
                              .size(),
                          4u);
}

TEST(Table, CellsAreTheNumbersOfTheCase) {
    const Sample made = sample();
    const auto lines =
        block(table(made.plan, made.measurement), "bricks (32 x 8), seen from elevation 30");
    ASSERT_EQ(lines.size(), 4u);
    // p95 = 1 + 0.2 + 2 + 0.02
    EXPECT_THAT(words_of(lines[3]),
                ::testing::ElementsAre("3", "parallax_occlusion", "taps=8", "march:unroll",
                                       "hlsl_5_0", "102/12/122", "6.25", "3.00", "37.5", "1.073",
                                       "3.220", "3.542", "322.0", "0.78", "0", "0/0"));
    EXPECT_THAT(lines[2], HasSubstr("steep_parallax,shadow=march  max_steps=32 per_vertex"));
}

TEST(Table, ColumnsAreAligned) {
    const Sample made = sample();
    const auto lines =
        block(table(made.plan, made.measurement), "bricks (32 x 8), seen from elevation 30");
    ASSERT_EQ(lines.size(), 4u);
    for (const std::string& line : lines) {
        EXPECT_EQ(line.size(), lines[0].size()) << line;
        EXPECT_LE(line.size(), table_width);
    }
    // Numbers end where their titles end.
    for (const std::string title : {"reads", "ns/px", "p95", "shad%", "NaN"}) {
        const std::size_t end = lines[0].find(title) + title.size();
        for (const std::string& line : lines) {
            EXPECT_NE(line[end - 1], ' ') << title << ": " << line;
            EXPECT_TRUE(end == line.size() || line[end] == ' ') << title << ": " << line;
        }
    }
}

TEST(Table, LongNamesAreCutToTheWidthAndWrittenOutBelow) {
    Sample made = sample();
    made.plan.rows[2].surface = "a_" + std::string(90, 'x') + "_b";
    made.plan.rows[2].knobs = {{"a_rather_long_knob", "1"},
                               {"another_long_knob", "0.333333333333"}};
    const std::string text = table(made.plan, made.measurement);
    for (const std::string& line : block(text, "bricks (32 x 8), seen from straight above"))
        EXPECT_LE(line.size(), table_width);
    EXPECT_THAT(text,
                HasSubstr("\n#3: " + made.plan.rows[2].surface +
                          " a_rather_long_knob=1 another_long_knob=0.333333333333 march:unroll\n"));
    EXPECT_THAT(text, Not(HasSubstr("#1:")));
}

TEST(Table, TheOverviewHasTheP95OfEachElevation) {
    const Sample made = sample({{90, 0}, {60, 0}, {30, 0}});
    const auto lines =
        block(table(made.plan, made.measurement), "smooth: p95 hit error in texels by elevation");
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_THAT(words_of(lines[0]),
                ::testing::ElementsAre("#", "technique", "knobs", "target", "90", "60", "30"));
    EXPECT_THAT(words_of(lines[1]),
                ::testing::ElementsAre("1", "none", "glsl_450", "1.000", "2.000", "3.000"));
}

// 30 degrees has azimuths 0 and 500, whose p95 are 3 and 3.5: neither their mean nor a percentile.
TEST(Table, WhatIsMergedIsALargestAndSaysSo) {
    const Sample made = sample({{60, 0}, {30, 0}, {30, 500}});
    const std::string text = table(made.plan, made.measurement);
    const auto lines =
        block(text, "smooth: largest p95 over azimuths and lights, in texels, by elevation");
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_THAT(words_of(lines[1]),
                ::testing::ElementsAre("1", "none", "glsl_450", "2.000", "3.500"));
    EXPECT_THAT(text, Not(HasSubstr("p95 hit error")));
}

TEST(Table, OneElevationNeedsNoOverview) {
    const Sample made = sample({{30, 0}, {30, 20}});
    EXPECT_THAT(table(made.plan, made.measurement), Not(HasSubstr("by elevation")));
}

TEST(Table, WhatWasNotMeasuredIsADash) {
    Sample made = sample();
    made.plan.rounds = 0;
    for (measure::CaseResult& result : made.measurement.cases) {
        result.nanoseconds = result.ratio = 0;
        if (result.row == 1) result.hits.invalid = result.hits.pixels;
    }
    const std::string text = table(made.plan, made.measurement);
    const auto lines = block(text, "bricks (32 x 8), seen from straight above");
    ASSERT_EQ(lines.size(), 4u);
    const std::vector<std::string> words = words_of(lines[2]);
    const std::vector<std::string> tail(words.end() - 9, words.end());
    EXPECT_THAT(tail, ::testing::ElementsAre("-", "-", "-", "-", "-", "-", "0.39", "0", "256/0"));
    EXPECT_THAT(words_of(block(text, "bricks: p95")[2]).back(), "-");
    EXPECT_THAT(text, HasSubstr("not taken"));
}

// An error that is not zero never looks like zero.
TEST(Table, OnlyZeroIsZero) {
    Sample made = sample({{90, 0}});
    made.measurement.cases[0].hits.median = 1e-6;
    made.measurement.cases[0].hits.p95 = 0;
    made.measurement.cases[0].hits.pixels = 1000000;
    made.measurement.cases[0].hits.missed = 1;
    const std::vector<std::string> words =
        words_of(block(table(made.plan, made.measurement), "bricks")[1]);
    const std::vector<std::string> tail(words.end() - 7, words.end());
    EXPECT_EQ(tail[0], "<0.001");
    EXPECT_EQ(tail[1], "0");
    EXPECT_EQ(tail[4], "<0.01");
}

TEST(Table, TheLegendSaysWhoMadeTheNumbers) {
    const Sample made = sample();
    const std::string text = table(made.plan, made.measurement);
    EXPECT_THAT(text, HasSubstr("SPIRV-Tools"));
    EXPECT_THAT(text, HasSubstr("median of 5 interleaved rounds"));
    EXPECT_THAT(text, HasSubstr("on llvmpipe, Mesa"));
    EXPECT_THAT(text, HasSubstr("double precision reference"));
    for (const std::string& line : lines_of(text)) EXPECT_LE(line.size(), table_width) << line;
}

// Slots in place of SPIR-V, and a block of their own with the error in each arithmetic.
TEST(Table, Direct3d9RowsHaveSlotsAndThreeArithmetics) {
    const Sample made = direct3d9_sample();
    const std::string text = table(made.plan, made.measurement);
    EXPECT_THAT(words_of(block(text, "bricks (32 x 8), seen from straight above")[2]),
                ::testing::Contains("41+9"));
    const auto lines = block(text, "Direct3D 9: bricks (32 x 8), seen from straight above");
    ASSERT_EQ(lines.size(), 2u);
    const std::vector<std::string> words = words_of(lines[1]);
    const std::vector<std::string> tail(words.end() - 12, words.end());
    EXPECT_THAT(tail, ::testing::ElementsAre("ps_2_0", "41", "9", "6", "2", "5.25", "1.100",
                                             "2.200", "330.0", "0.39", "0.39", "50.00"));
    for (const std::string& line : lines_of(text)) EXPECT_LE(line.size(), table_width) << line;
    const Sample without = sample();
    EXPECT_THAT(table(without.plan, without.measurement), ::testing::Not(HasSubstr("Direct3D 9")));
}

}  // namespace
}  // namespace intaglio::report

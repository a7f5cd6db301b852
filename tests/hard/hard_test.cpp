// The hard suite of the design: every technique on every case, on the device and in the evaluator
// in fp32, fp24 and fp16.  A case states what it expects (src/measure/hard_cases.cpp); here stands
// which of those expectations every technique must meet, and which are allowed to degrade.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

#include "src/measure/hard.h"
#include "src/report/hard_table.h"
#include "tests/exec/bench.h"

namespace intaglio::measure {

void PrintTo(const HardCase& hard_case, std::ostream* stream) { *stream << hard_case.name; }

namespace {

// Run once, for all tests.
const HardSuite& suite() {
    static const HardSuite made = exec::must(
        run_hard_suite(exec::device(), templates::all_techniques(), hard_rows(), hard_cases()));
    return made;
}

// One technique in one case, one way.
struct Place {
    const HardRow& row;
    const HardCase& hard_case;
    Way way;
    const HardCell& cell;
    Expect expect;

    std::string name() const {
        return row.name + ", " + hard_case.name + ", " + std::string(name_of(way)) + ": " +
               report::hard_words(row, hard_case, cell);
    }
};

// Everything that is asked in a case.
std::vector<Place> places_of(const HardCase& wanted) {
    const HardSuite& all = suite();
    const auto found = std::find_if(all.cases.begin(), all.cases.end(),
                                    [&](const HardCase& one) { return one.name == wanted.name; });
    const auto c = static_cast<std::size_t>(found - all.cases.begin());
    std::vector<Place> places;
    for (std::size_t r = 0; r < all.rows.size(); ++r)
        if (const auto expect = expected_of(all.rows[r], all.cases[c]))
            for (std::size_t w = 0; w < all_ways.size(); ++w)
                places.push_back(
                    {all.rows[r], all.cases[c], all_ways[w], all.cells[r][c][w], *expect});
    return places;
}

class Hard : public testing::TestWithParam<HardCase> {};

// No NaN, no Inf, no point off the ray, no negative light: anywhere.  And where an input is beyond
// a format, it is one of the two that are.
TEST_P(Hard, NothingIsBroken) {
    for (const Place& place : places_of(GetParam())) {
        EXPECT_NE(place.cell.verdict, Verdict::Broken) << place.name();
        EXPECT_EQ(place.cell.invalid, 0) << place.name();
        if (place.cell.verdict != Verdict::NoSuchNumber) continue;
        const bool huge = place.hard_case.name == "huge_vectors" && place.way != Way::Single;
        const bool far = place.hard_case.name == "uv_100000" && place.way == Way::Narrow16;
        EXPECT_TRUE(huge || far) << place.name();
    }
}

// Straight down, scale 0, below the horizon, a frame that is none: nothing that a technique or a
// format could excuse.  Visibility 1 and 0 likewise.
TEST_P(Hard, WhatIsDefinedIsMetByEveryTechniqueInEveryFormat) {
    for (const Place& place : places_of(GetParam())) {
        const bool defined = place.expect == Expect::Undisplaced ||
                             place.expect == Expect::OnFlattest || place.expect == Expect::Lit ||
                             place.expect == Expect::Dark;
        if (!defined || place.cell.verdict == Verdict::NoSuchNumber) continue;
        EXPECT_EQ(place.cell.verdict, Verdict::Fine) << place.name();
    }
}

// Flat maps leave nothing to search for; in 16 bits a sixteenth of a texel is two units in the
// last place.
TEST_P(Hard, FlatReliefIsMetByEveryTechnique) {
    for (const Place& place : places_of(GetParam()))
        if (place.expect == Expect::Within16th && place.way != Way::Narrow16) {
            EXPECT_EQ(place.cell.verdict, Verdict::Fine) << place.name();
        }
}

// A coordinate far from the origin costs what its last place says and no more, in every format.
TEST_P(Hard, FarCoordinatesCostTheirLastPlaceAlone) {
    for (const Place& place : places_of(GetParam()))
        if (place.row.part == HardPart::Search && place.expect == Expect::FormatsBest &&
            place.cell.verdict != Verdict::NoSuchNumber) {
            EXPECT_EQ(place.cell.verdict, Verdict::Fine) << place.name();
        }
}

// Of the safe class: never through a feature.  fp16 has 1/32 of a texel, which is a feature here.
TEST_P(Hard, SafeSearchesMissNothing) {
    for (const Place& place : places_of(GetParam()))
        if (place.row.safe && (place.way == Way::Device || place.way == Way::Single)) {
            EXPECT_EQ(place.cell.missed, 0) << place.name();
        }
}

// With cells enough for every ray the exact search is exact in every case, in fp32 and in fp24, and
// so is the exact shadow.
TEST_P(Hard, ExactIsExact) {
    for (const Place& place : places_of(GetParam())) {
        if (place.row.name != "exact, 3600 cells, no leaps" && place.row.name != "shadow exact")
            continue;
        if (place.way == Way::Narrow16 || place.cell.verdict == Verdict::NoSuchNumber) continue;
        // A squared length that overflows makes the zero vector of it, which is not lit.
        if (place.row.part == HardPart::Shadow && place.hard_case.name == "huge_vectors") continue;
        EXPECT_EQ(place.cell.verdict, Verdict::Fine) << place.name();
    }
}

// What shades is as good in fp32 as in real numbers.
TEST_P(Hard, ColoursAreThoseOfRealNumbers) {
    for (const Place& place : places_of(GetParam())) {
        if (place.row.part != HardPart::Colour) continue;
        if (place.way != Way::Device && place.way != Way::Single) continue;
        // Overflow, as above; at 100000 a texel is two units in the last place of the coordinate.
        if (place.hard_case.name == "huge_vectors" || place.hard_case.name == "uv_100000") continue;
        EXPECT_EQ(place.cell.verdict, Verdict::Fine) << place.name();
    }
}

INSTANTIATE_TEST_SUITE_P(Cases, Hard, testing::ValuesIn(hard_cases()),
                         [](const auto& one) { return one.param.name; });

// Techniques of the unsafe class do miss, so that a suite that sees no misses is not looking.
TEST(HardSuite, SeesWhatUnsafeSearchesMiss) {
    int misses = 0;
    for (const HardCase& hard_case : suite().cases)
        for (const Place& place : places_of(hard_case))
            misses += place.row.name == "parallax_occlusion" && place.cell.missed > 0.1;
    EXPECT_GE(misses, 8) << "grazing, walls, combs";
}

std::string without_device(const std::string& page) {
    const std::size_t begin = page.find("Device: ");
    const std::size_t end = page.find('\n', begin);
    return begin == std::string::npos ? page : page.substr(0, begin) + page.substr(end);
}

TEST(HardSuite, TheCommittedPageIsToday) {
    std::ifstream file(INTAGLIO_ROOT "/docs/hard-cases.md", std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_EQ(without_device(text.str()), without_device(report::hard_page(suite())))
        << "write it again: intaglio hard -o docs/hard-cases.md";
}

// NaN and Inf are no inputs: the runner refuses them by name.
class NotANumber : public testing::TestWithParam<float> {};

TEST_P(NotANumber, IsRefusedInUniformsVerticesAndTextures) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    const Variant variant =
        exec::must(make_variant(catalogue, exec::request("relief", "glsl_450")));
    const check::Program shaders = exec::must(link_variant(variant));
    Textures textures(hard_map("smooth"), Filtering::Float);
    const auto prepare = [&](const vulkan::Mesh& mesh) {
        return prepare_flat(exec::device(), shaders, textures, mesh, 0.08, 16, 16);
    };
    vulkan::Program program = exec::must(prepare(hard_mesh()));
    const Status refused = program.set_uniform("scale", {GetParam()});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, "bad-uniform");
    EXPECT_THAT(refused.error().message, testing::HasSubstr("'scale'"));

    vulkan::Mesh mesh = hard_mesh();
    mesh.vertices[5].normal[1] = GetParam();
    const Result<vulkan::Program> bent = prepare(mesh);
    ASSERT_FALSE(bent);
    EXPECT_EQ(bent.error().code, "bad-mesh");
    EXPECT_THAT(bent.error().message, testing::HasSubstr("vertex 5"));

    textures.height.levels[0][8] = GetParam();
    const Result<vulkan::Program> dirty = prepare(hard_mesh());
    ASSERT_FALSE(dirty);
    EXPECT_EQ(dirty.error().code, "bad-texture");
    EXPECT_THAT(dirty.error().message, testing::HasSubstr("height_map"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, NotANumber,
                         testing::Values(std::numeric_limits<float>::quiet_NaN(),
                                         std::numeric_limits<float>::infinity(),
                                         -std::numeric_limits<float>::infinity()));

}  // namespace
}  // namespace intaglio::measure

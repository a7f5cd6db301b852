// The stable forms against the published ones, and every guard taken out once: without it something
// breaks that does not with it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "generator/ir/verify.h"
#include "src/measure/guards.h"
#include "src/measure/hard.h"
#include "src/measure/stability.h"
#include "src/report/hard_table.h"
#include "src/report/stability_page.h"
#include "tests/exec/bench.h"

namespace intaglio::measure {
namespace {

std::string committed() {
    std::ifstream file(INTAGLIO_ROOT "/docs/stability.md", std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(Stability, TheCommittedCurvesAreToday) {
    EXPECT_THAT(committed(), testing::HasSubstr(
                                 report::stability_section(stability_curves(), "images/stability")))
        << "write it again: intaglio stability -o docs/stability.md";
}

// The guards of the two surfaces that are made quickest: a slot more or a case that breaks is seen.
TEST(Stability, TheCommittedGuardsAreToday) {
    std::vector<GuardRow> rows = guard_rows();
    std::erase_if(rows, [](const GuardRow& row) {
        return row.surface != "parallax" && row.surface != "search=none";
    });
    ASSERT_EQ(rows.size(), 2U);
    exec::must(measure_guards(exec::device(), templates::all_techniques(), rows));
    for (const GuardRow& row : rows)
        EXPECT_THAT(committed(), testing::HasSubstr(report::guard_line(row)))
            << "write it again: intaglio stability -o docs/stability.md";
}

TEST(Stability, TheCommittedFarPlacesAreToday) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    EXPECT_THAT(committed(),
                testing::HasSubstr(report::far_section(exec::must(far_rows(catalogue)),
                                                       exec::must(far_costs(catalogue)))))
        << "write it again: intaglio stability -o docs/stability.md";
}

TEST(Stability, EveryCurveHasItsPlot) {
    for (const StabilityCurve& curve : stability_curves()) {
        const std::string file =
            INTAGLIO_ROOT "/docs/images/stability/" + report::stability_plot(curve).name + ".svg";
        EXPECT_TRUE(std::ifstream(file).good()) << file;
    }
}

// Finite wherever the format holds the numbers.
TEST(Stability, OurFormsAreFinite) {
    for (const StabilityCurve& curve : stability_curves())
        for (const StabilityPoint& point : curve.points)
            for (double error : point.ours)
                EXPECT_TRUE(std::isfinite(error)) << curve.title << point.at;
}

// In fp32 ours errs nowhere more than the published form by a rounding or two, and somewhere less
// by a factor of a hundred or where the other is no number.
TEST(Stability, OurFormsAreNoWorseAndSomewhereFarBetter) {
    for (const StabilityCurve& curve : stability_curves()) {
        bool far_better = false;
        for (const StabilityPoint& point : curve.points) {
            const double published = point.published[0], ours = point.ours[0];
            const bool is_number = std::isfinite(published);
            if (is_number) {
                EXPECT_LE(ours, 2 * published + 4e-7) << curve.title << ", " << point.at;
            }
            far_better = far_better || !is_number || published > 30 * std::max(ours, 1e-9);
        }
        EXPECT_TRUE(far_better) << curve.title;
    }
}

class GuardTaken : public testing::TestWithParam<Guard> {};

// The technique and the case that show what the guard is for.
struct Witness {
    std::string technique, hard_case;
};
Witness witness_of(Guard guard) {
    switch (guard) {
        case Guard::FlattestRay: return {"parallax", "at_the_horizon"};
        case Guard::ZeroVector: return {"parallax", "zero_vectors"};
        case Guard::ZeroDivisor: return {"shadow horizon", "light_overhead"};
        case Guard::UnitInterval: break;  // no case needs it (docs/stability.md)
        case Guard::DarkLight: return {"shadow occlusion_profile", "light_below"};
    }
    return {};
}

TEST_P(GuardTaken, SomethingBreaks) {
    const Witness witness = witness_of(GetParam());
    HardRow row = *std::find_if(hard_rows().begin(), hard_rows().end(),
                                [&](const HardRow& one) { return one.name == witness.technique; });
    row.evaluated_only = true;
    HardRow bare = row;
    int places = 0;
    bare.rewrite = [&](ir::Module& module) {
        places += remove_guard(module, GetParam());
        const auto verified = ir::verify(module);
        EXPECT_TRUE(verified) << (verified ? "" : to_string(verified.error()));
    };
    const HardCase hard_case =
        *std::find_if(hard_cases().begin(), hard_cases().end(),
                      [&](const HardCase& one) { return one.name == witness.hard_case; });
    const HardSuite suite = exec::must(
        run_hard_suite(exec::device(), templates::all_techniques(), {row, bare}, {hard_case}));
    EXPECT_GT(places, 0);
    EXPECT_EQ(suite.cells[0][0][1].verdict, Verdict::Fine);
    EXPECT_NE(suite.cells[1][0][1].verdict, Verdict::Fine)
        << report::hard_words(bare, hard_case, suite.cells[1][0][1]);
}

INSTANTIATE_TEST_SUITE_P(Guards, GuardTaken,
                         testing::Values(Guard::FlattestRay, Guard::ZeroVector, Guard::ZeroDivisor,
                                         Guard::DarkLight),
                         [](const auto& one) { return std::to_string(one.index); });

}  // namespace
}  // namespace intaglio::measure

// What is left out is left out: each row costs what the surface costs that never had it.
#include <gtest/gtest.h>

#include <algorithm>

#include "src/measure/without.h"
#include "tests/unit/variant/requests.h"

namespace intaglio::measure {
namespace {

Omissions omissions_of(const VariantRequest& request) {
    const Result<Omissions> omissions = leave_out_each(catalogue(), request);
    EXPECT_TRUE(omissions.ok()) << to_string(omissions.error());
    return *omissions;
}

const Omission* row_of(const Omissions& omissions, std::string_view what) {
    const auto row = std::find_if(omissions.rows.begin(), omissions.rows.end(),
                                  [&](const Omission& one) { return one.what.starts_with(what); });
    return row == omissions.rows.end() ? nullptr : &*row;
}

TEST(Without, ARowIsTheSurfaceThatNeverHadIt) {
    for (const char* target : {"glsl_450", "ps_2_b"}) {
        const std::string surface = "search=none,shadow=fur_depth,shading=lambert,output=depth";
        const Omissions rows = omissions_of(request_of(
            surface, target, {{"lights", "2"}, {"clip_tile", "1"}, {"depth_range", "1"}}));
        const std::vector<std::pair<std::string, VariantRequest>> never = {
            {"shadow=none",
             request_of("search=none,shading=lambert,output=depth", target,
                        {{"lights", "2"}, {"clip_tile", "1"}, {"depth_range", "1"}})},
            {"output=colour", request_of("search=none,shadow=fur_depth,shading=lambert", target,
                                         {{"lights", "2"}, {"clip_tile", "1"}})},
            {"lights=1", request_of(surface, target, {{"clip_tile", "1"}, {"depth_range", "1"}})},
            {"clip_tile=0", request_of(surface, target, {{"lights", "2"}, {"depth_range", "1"}})}};
        for (const auto& [what, request] : never) {
            const Omission* row = row_of(rows, what);
            ASSERT_NE(row, nullptr) << what;
            const Result<ExplainedVariant> explained = explain_variant(catalogue(), request);
            ASSERT_TRUE(explained.ok()) << to_string(explained.error());
            const d3d9::Slots& slots = explained->stages.front().explanation.slots;
            EXPECT_EQ(row->without.slots.arithmetic, slots.arithmetic) << what << " on " << target;
            EXPECT_EQ(row->without.slots.texture, slots.texture) << what << " on " << target;
            EXPECT_LT(slots.total(), rows.with.slots.total()) << what << " on " << target;
        }
        EXPECT_EQ(row_of(rows, "normal=map"), nullptr) << "it is that";
        EXPECT_EQ(row_of(rows, "ray_per_vertex=0"), nullptr) << "it is that";
    }
}

TEST(Without, AGuardCostsWhereItStandsAndOnlyThere) {
    const Omissions marched =
        omissions_of(request_of("parallax_occlusion,output=displaced", "glsl_450"));
    for (const char* guard : {"flattest ray", "zero vector", "zero divisor", "unit interval"}) {
        const Omission* row = row_of(marched, guard);
        ASSERT_NE(row, nullptr) << guard;
        EXPECT_LT(row->without.slots.arithmetic, marched.with.slots.arithmetic) << guard;
        EXPECT_EQ(row->without.slots.texture, marched.with.slots.texture) << guard;
    }
    EXPECT_EQ(row_of(marched, "dark light"), nullptr) << "no shadow is there to be guarded";
}

TEST(Without, ARefusedVariantSaysWhatItWouldFitWithout) {
    const Omissions rows = omissions_of(request_of("bump", "ps_2_0", {{"lights", "4"}}));
    EXPECT_FALSE(rows.with.fits);
    EXPECT_NE(rows.with.limit.find(" of 64 arithmetic slots"), std::string::npos)
        << rows.with.limit;
    const Omission* row = row_of(rows, "lights=3");
    ASSERT_NE(row, nullptr);
    EXPECT_TRUE(row->without.fits);
    EXPECT_NE(row->without.limit.find(" of 64 arithmetic slots"), std::string::npos)
        << row->without.limit;
}

// What belongs to a part goes with it.
TEST(Without, KnobsAndLoopsOfWhatIsLeftOutAreNoError) {
    VariantRequest request = request_of("parallax_occlusion,shadow=march", "glsl_450",
                                        {{"taps", "4"}, {"shadow_max_steps", "9"}});
    request.loop_forms = {{"march", ir::LoopForm::Unrolled},
                          {"shadow_march", ir::LoopForm::Unrolled}};
    const Omissions rows = omissions_of(request);
    for (const char* what : {"search=none", "shadow=none", "shading=ambient_only", "lights=0"})
        EXPECT_NE(row_of(rows, what), nullptr) << what;
}

}  // namespace
}  // namespace intaglio::measure

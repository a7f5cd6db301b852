// How right the searches are, against the exact reference: the relations that the papers claim,
// with margin.
#include <algorithm>
#include <cmath>

#include "tests/exec/bench.h"

#include "src/measure/hits.h"

namespace intaglio::exec {
namespace {

measure::HitStatistics measure_hits(const std::string& surface, const Knobs& knobs,
                                    const measure::MapSet& set, measure::Direction view,
                                    measure::Direction light = {45, 130}) {
    constexpr int size = 128;
    const vulkan::Picture displaced =
        draw(request(dsl::with_part(surface, "output", "displaced"), "glsl_450", knobs), set, view,
             light, size)[0];
    const reference::HeightField field = set.height_field(reference::FilterWeights::Exact);
    const float scale = static_cast<float>(test_scale);
    const measure::ExactPicture exact = measure::trace_exact(field, view, light, scale, size, size);
    return measure::summarize(measure::compare_hits(displaced, exact, field, view, scale), size);
}

TEST(Accuracy, StraightDownEverySearchIsExact) {
    const measure::MapSet bricks = map_named("bricks");
    const dsl::Catalogue catalogue = templates::all_techniques();
    for (const auto& search : catalogue.searches) {
        const std::string surface = "search=" + search.name;
        const measure::HitStatistics hits = measure_hits(surface, {}, bricks, {90, 0});
        EXPECT_EQ(hits.max, 0) << surface << ": the coordinate must not move";
        EXPECT_EQ(hits.missed, 0) << surface;
    }
}

TEST(Accuracy, ParallaxOcclusionWith64TapsIsWithinHalfATexelOnTheSmoothMap) {
    const measure::HitStatistics hits =
        measure_hits("parallax_occlusion", {{"taps", "64"}}, map_named("smooth"), {45, 20});
    EXPECT_LT(hits.p95, 0.5);
    EXPECT_EQ(hits.invalid, 0);
}

TEST(Accuracy, TheErrorFallsAsTapsGrow) {
    const measure::MapSet smooth = map_named("smooth");
    double before = 1e9;
    for (const char* taps : {"4", "8", "16", "32", "64"}) {
        const measure::HitStatistics hits =
            measure_hits("parallax_occlusion", {{"taps", taps}}, smooth, {30, 20});
        EXPECT_LT(hits.p95, before * 0.7) << taps << " taps";
        before = hits.p95;
    }
}

TEST(Accuracy, SteepParallaxStepsAreSmallerTheMoreOfThem) {
    const measure::MapSet bricks = map_named("bricks");
    const auto p95 = [&](const char* steps) {
        return measure_hits("steep_parallax", {{"min_steps", steps}, {"max_steps", steps}}, bricks,
                            {30, 20})
            .p95;
    };
    EXPECT_LT(p95("64"), p95("16") * 0.6);
    EXPECT_LT(p95("256"), p95("64") * 0.6);
}

TEST(Accuracy, OneLastIntersectionBeatsNone) {
    // At equal reads: the secant of parallax occlusion against the bare first sample of steep
    // parallax.
    const measure::MapSet smooth = map_named("smooth");
    const measure::HitStatistics occlusion =
        measure_hits("parallax_occlusion", {{"taps", "32"}}, smooth, {30, 20});
    const measure::HitStatistics steep = measure_hits(
        "steep_parallax", {{"min_steps", "32"}, {"max_steps", "32"}}, smooth, {30, 20});
    // Measured 0.0011 texels against 0.53.
    EXPECT_LT(occlusion.p95, steep.p95 * 0.02);
}

TEST(Accuracy, OneTexelSpikesAreMissedAndSaidSo) {
    const measure::MapSet spikes = map_named("spikes");
    const measure::HitStatistics few =
        measure_hits("parallax_occlusion", {{"taps", "8"}}, spikes, {20, 20});
    const measure::HitStatistics many =
        measure_hits("parallax_occlusion", {{"taps", "256"}}, spikes, {20, 20});
    EXPECT_GT(few.missed, few.pixels / 100) << "8 taps at 20 degrees step over one-texel spikes";
    EXPECT_LT(many.missed, few.missed / 4) << "256 taps do not";
}

// Every search where it should be good: on a map without steep features, at 45 degrees.
TEST(Accuracy, EverySearchIsWithinItsBoundOnTheSmoothMap) {
    struct Bound {
        std::string surface;
        Knobs knobs;
        double p95;  // texels
    };
    const measure::MapSet smooth = map_named("smooth");
    for (const Bound& bound :
         {Bound{"parallax", {}, 1.5}, Bound{"parallax_limited", {}, 4},
          Bound{"parallax_iterative", {{"iterations", "16"}}, 0.01},
          Bound{"steep_parallax", {{"min_steps", "128"}, {"max_steps", "128"}}, 0.1},
          Bound{"steep_parallax", {{"stride", "1"}}, 1.42},
          Bound{"steep_parallax", {{"stride", "2"}}, 1.42},
          Bound{"steep_parallax", {{"stride", "3"}}, 0.2},
          Bound{"parallax_occlusion", {{"taps", "32"}}, 0.01}, Bound{"relief", {}, 0.02},
          Bound{"relief_secant", {}, 0.001}, Bound{"contact_refinement", {}, 0.06}}) {
        const measure::HitStatistics hits =
            measure_hits(bound.surface, bound.knobs, smooth, {45, 20});
        EXPECT_LT(hits.p95, bound.p95) << bound.surface;
        EXPECT_EQ(hits.invalid, 0) << bound.surface;
    }
}

// On the device too: the bound is float's for coordinates of the map and the path, but for the
// tangents of summits, where any rounding decides.
TEST(Accuracy, TheExactSearchMissesNothing) {
    for (const char* maker : {"bricks", "cobbles", "text", "spikes", "fur", "noise", "flat0"}) {
        const measure::MapSet set = map_named(maker);
        for (double elevation : {1.0, 5.0, 20.0, 45.0}) {
            const measure::HitStatistics hits =
                measure_hits("exact", {{"max_cells", "2048"}}, set, {elevation, 20});
            SCOPED_TRACE(testing::Message() << maker << " at " << elevation << " degrees");
            EXPECT_EQ(hits.missed, 0);
            EXPECT_EQ(hits.invalid, 0);
            const double path = 128 * test_scale / std::tan(elevation / 57.3);
            EXPECT_LT(hits.p99, (128 + path) * 0x1p-22);
        }
    }
}

TEST(Accuracy, NoRefinementBringsAMissedSpikeBack) {
    // The march that all begin with decides what is missed; more reads of it are the only help.
    const measure::MapSet spikes = map_named("spikes");
    const auto missed = [&](const char* surface, const Knobs& knobs) {
        return static_cast<double>(measure_hits(surface, knobs, spikes, {20, 20}).missed);
    };
    const double marched = missed("relief", {{"binary_steps", "0"}});
    EXPECT_GT(marched, 128 * 128 / 20);
    EXPECT_NEAR(missed("relief", {}), marched, marched * 0.1);
    EXPECT_NEAR(missed("relief_secant", {}), marched, marched * 0.1);
    EXPECT_NEAR(missed("contact_refinement", {{"coarse_steps", "15"}}), marched, marched * 0.1);
    EXPECT_LT(missed("steep_parallax", {{"stride", "2"}}), marched * 0.4);
}

TEST(Accuracy, BumpMappingStaysWhereItIs) {
    const measure::HitStatistics hits =
        measure_hits("search=none", {}, map_named("bricks"), {30, 20});
    EXPECT_GT(hits.p95, 2)
        << "plain bump mapping has no parallax, and the measurement must show it";
}

TEST(Accuracy, TheShadowMarchAgreesWithTheExactShadowMostly) {
    const measure::MapSet bricks = map_named("bricks");
    const Knobs fine = {{"min_steps", "256"},
                        {"max_steps", "256"},
                        {"shadow_min_steps", "256"},
                        {"shadow_max_steps", "256"},
                        {"shadow_start", "1"}};
    const measure::HitStatistics march =
        measure_hits("steep_parallax,shadow=march", fine, bricks, {60, 20}, {25, 130});
    const measure::HitStatistics none =
        measure_hits("steep_parallax", {{"min_steps", "256"}, {"max_steps", "256"}}, bricks,
                     {60, 20}, {25, 130});
    EXPECT_GT(none.shadow_wrong, none.pixels / 50) << "the scene has shadows";
    EXPECT_LT(march.shadow_wrong, none.shadow_wrong / 2) << "and the march finds most of them";
}

TEST(Accuracy, ALightAtOrBelowTheHorizonLightsNothing) {
    // Without its guard the march would follow a ray that goes down, or the flattest one, and find
    // it free.
    Drawing drawing(request("steep_parallax,shadow=march,output=displaced", "glsl_450"),
                    map_named("flat1"), 16);
    const auto lit = [&](double elevation) {
        const vulkan::Picture picture = drawing.at({60, 20}, {elevation, 130})[0];
        return std::count_if(picture.pixels.begin(), picture.pixels.end(),
                             [](const std::array<float, 4>& pixel) { return pixel[3] != 0; });
    };
    for (double elevation : {0.0, -30.0, -90.0}) EXPECT_EQ(lit(elevation), 0) << elevation;
    EXPECT_EQ(lit(30), 16 * 16);
}

}  // namespace
}  // namespace intaglio::exec

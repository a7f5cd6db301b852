// Errors split by source: three sources that are measured apart explain the error that is measured
// with all of them, on every kind of target and in every arithmetic; and the exact picture is the
// one that the exact search draws.
#include "tests/exec/bench.h"

#include <cmath>

#include "src/measure/evaluated.h"
#include "src/measure/laboratory.h"

namespace intaglio::exec {
namespace {

using measure::Arithmetic;

measure::CaseMap case_map(const std::string& maker) {
    measure::CaseMap map;
    map.set = map_named(maker);
    map.hash = measure::content_hash(map.set);
    return map;
}

measure::Laboratory& laboratory() {
    static const dsl::Catalogue catalogue = templates::all_techniques();
    static measure::Laboratory one = must(measure::Laboratory::create(catalogue, {{}, true, 0}));
    return one;
}

struct Example {
    const char *surface, *target;
    Knobs knobs;
    Arithmetic arithmetic;
};

// By construction; what is measured is that filter and arithmetic hardly depend on each other, so
// that the halves are no matter.  Below a step of the arithmetic's own coordinates the filter
// decides which way a coordinate is cut: no share of such an error says anything.
TEST(ErrorSplit, ThreeSourcesExplainTheTotal) {
    const std::vector<Example> examples = {
        {"parallax_occlusion", "ps_2_b", {{"taps", "8"}}, Arithmetic::Fp32},
        {"parallax_occlusion", "ps_2_b", {{"taps", "8"}}, Arithmetic::Fp24},
        {"parallax_occlusion", "ps_2_b", {{"taps", "8"}}, Arithmetic::Fp16},
        {"parallax", "ps_2_0", {}, Arithmetic::Fp16},
        {"steep_parallax",
         "glsl_450",
         {{"max_steps", "64"}, {"min_steps", "64"}},
         Arithmetic::Fp32},
        {"relief", "glsl_450", {}, Arithmetic::Fp24},
        {"relief", "hlsl_5_0", {}, Arithmetic::Fp16},
        {"relief_secant", "glsl_450", {}, Arithmetic::Fp32},
        {"relief_secant", "glsl_450", {}, Arithmetic::Fp24}};
    for (const char* maker : {"bricks", "smooth"}) {
        const measure::CaseMap map = case_map(maker);
        for (const Example& example : examples)
            for (double elevation : {60.0, 20.0}) {
                SCOPED_TRACE(testing::Message() << example.surface << " on " << example.target
                                                << " in " << name_of(example.arithmetic) << ", "
                                                << maker << " at " << elevation);
                const measure::Case what{request(example.surface, example.target, example.knobs),
                                         {elevation, 20},
                                         {45, 130},
                                         test_scale,
                                         16,
                                         measure::Filtering::Float,
                                         example.arithmetic,
                                         32};
                const measure::CaseMetrics metrics = must(laboratory().measure(what, map));
                ASSERT_FALSE(metrics.refusal) << to_string(*metrics.refusal);
                const measure::ErrorSplit& split = *metrics.split;
                EXPECT_EQ(split.invalid, 0);
                EXPECT_GT(split.total, 0);
                EXPECT_NEAR(split.technique + split.filter + split.arithmetic, split.total,
                            1e-9 * split.total);
                // Of coordinates from a half to 1, in texels: 16 bits behind the first.
                const double step = 0x1p-17 * map.set.heights.width;
                EXPECT_LE(std::abs(split.interaction),
                          example.arithmetic == Arithmetic::Fp24 && split.total < step
                              ? step
                              : 0.05 * split.total)
                    << "technique " << split.technique << ", filter " << split.filter
                    << ", arithmetic " << split.arithmetic;
            }
    }
}

TEST(ErrorSplit, NarrowArithmeticIsBlamedOnTheArithmetic) {
    const measure::CaseMap map = case_map("smooth");
    const auto split = [&](Arithmetic arithmetic) {
        const measure::Case what{request("parallax_occlusion", "ps_2_b", {{"taps", "8"}}),
                                 {45, 20},
                                 {45, 130},
                                 test_scale,
                                 16,
                                 measure::Filtering::Float,
                                 arithmetic,
                                 32};
        return *must(laboratory().measure(what, map)).split;
    };
    const measure::ErrorSplit wide = split(Arithmetic::Fp32), narrow = split(Arithmetic::Fp24),
                              half = split(Arithmetic::Fp16);
    EXPECT_EQ(wide.technique_alone, half.technique_alone) << "the technique is computed in double";
    EXPECT_LT(wide.arithmetic_alone, 1e-4) << "2^-24 of a path of some texels";
    EXPECT_GT(narrow.arithmetic_alone, 16 * wide.arithmetic_alone);
    EXPECT_GT(half.arithmetic_alone, 8 * narrow.arithmetic_alone);
}

TEST(ErrorSplit, TheEvaluatorFindsWhatTheDeviceFinds) {
    // Float textures are filtered exactly on the device, so that the evaluator in Single and the
    // device part at ties alone.
    const measure::MapSet set = map_named("bricks");
    const measure::Textures textures(set, measure::Filtering::Float);
    const Variant variant = must(make_variant(
        templates::all_techniques(), request("relief,shadow=march,output=displaced", "glsl_450")));
    constexpr int size = 32;
    const auto quad =
        must(measure::EvaluatedQuad::prepare(variant, textures, test_scale, size, size));
    EXPECT_TRUE(quad.sees_light());
    const vulkan::Picture evaluated =
        quad.draw({30, 20}, {45, 130}, ir::Precision::Single, ir::Texture::Weights::Exact)
            .picture();
    const vulkan::Picture drawn =
        Drawing(request("relief,shadow=march,output=displaced", "glsl_450"), set, size)
            .at({30, 20}, {45, 130})[0];
    int apart = 0;
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i)
        apart += std::hypot(drawn.pixels[i][0] - evaluated.pixels[i][0],
                            drawn.pixels[i][1] - evaluated.pixels[i][1]) *
                     128 >
                 0.01f;
    EXPECT_LE(apart, size * size / 100);
}

TEST(ExactPicture, IsWhatTheExactSearchDraws) {
    const measure::CaseMap map = case_map("bricks");
    const auto error = [&](const char* surface, const Knobs& knobs) {
        const measure::Case what{
            request(surface, "glsl_450", knobs), {40, 20},         {45, 130}, test_scale, 64,
            measure::Filtering::Float,           Arithmetic::Fp32, 0};
        return must(laboratory().measure(what, map)).picture;
    };
    for (const char* surface : {"exact", "exact,shadow=exact", "exact,shadow=fur_depth"}) {
        const measure::PictureError right = error(surface, {});
        EXPECT_LT(right.flip_mean, 2e-3) << surface << ": rounding, at the edges of bricks";
        EXPECT_GT(right.psnr, 40) << surface;
    }
    EXPECT_GT(error("exact,shadow=march", {}).flip_mean, error("exact,shadow=exact", {}).flip_mean);
    EXPECT_GT(error("parallax", {}).flip_mean, 0.02) << "and no search that is far off";
}

// What a scene fixes and bounds costs less and moves no hit, and nothing but the shader itself
// has to have a name for it: `ambient` is none of the hit's.
TEST(Laboratory, WhatAVariantKnowsChangesItsCostAlone) {
    const measure::CaseMap map = case_map("bricks");
    for (const char* target : {"ps_2_b", "glsl_450"}) {
        SCOPED_TRACE(target);
        measure::Case what{request("parallax_occlusion", target, {{"taps", "6"}}),
                           {50, 20},
                           {45, 130},
                           test_scale,
                           16,
                           measure::Filtering::Float,
                           Arithmetic::Fp32,
                           0};
        const measure::CaseMetrics plain = must(laboratory().measure(what, map));
        what.request.known.uniforms = {{"scale", {static_cast<float>(test_scale)}},
                                       {"ambient", {0.25f, 0.27f, 0.33f}}};
        what.request.known.ranges = {{"view.z", {0.5f, 1.0f}}};
        const measure::CaseMetrics known = must(laboratory().measure(what, map));
        ASSERT_FALSE(known.refusal);
        EXPECT_LT(known.spirv.total, plain.spirv.total);
        EXPECT_EQ(known.hits.max, plain.hits.max);
        EXPECT_EQ(known.hits.median, plain.hits.median);
        EXPECT_EQ(known.hits.missed, plain.hits.missed);
        // Direct3D 9 chooses its instructions anew, and sums of the shading may round otherwise.
        EXPECT_NEAR(known.picture.flip_mean, plain.picture.flip_mean, 1e-6);
        EXPECT_EQ(known.picture.invalid, 0);
        EXPECT_GT(plain.hits.max, 0);
    }
}

}  // namespace
}  // namespace intaglio::exec

// What does not fit ps_2_0 in one pass fits in several, each of which every witness accepts.
#include <gmock/gmock.h>

#include <algorithm>

#include "generator/target/d3d9/limits.h"
#include "generator/target/d3d9/resources.h"
#include "src/variant/variant.h"
#include "templates/all_techniques.h"

namespace intaglio {
namespace {

using testing::HasSubstr;
using Knobs = std::vector<std::pair<std::string, std::string>>;

struct Case {
    std::string surface;
    Knobs knobs;
    std::string split;
    Knobs whole;  // the knobs of the same number of steps in one pass
};

class TooLargeForOnePass : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(
    Surfaces, TooLargeForOnePass,
    testing::Values(
        Case{"parallax_occlusion", {{"taps", "8"}}, "sections=3,shading", {{"taps", "24"}}},
        Case{"steep_parallax",
             {{"min_steps", "12"}, {"max_steps", "12"}},
             "sections=2,shading",
             {{"min_steps", "24"}, {"max_steps", "24"}}},
        Case{"parallax_occlusion,shadow=march",
             {{"shadow_min_steps", "8"}, {"shadow_max_steps", "8"}},
             "shadow,shading",
             {{"shadow_min_steps", "8"}, {"shadow_max_steps", "8"}}}));

TEST_P(TooLargeForOnePass, FitsInSeveral) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    VariantRequest request;
    request.surface = GetParam().surface;
    request.target = "ps_2_0";
    request.knobs = GetParam().whole;
    const Result<Variant> whole = make_variant(catalogue, request);
    ASSERT_FALSE(whole.ok());
    EXPECT_TRUE(is_refusal(whole.error()));
    EXPECT_THAT(whole.error().message, HasSubstr("--split"));

    request.knobs = GetParam().knobs;
    request.split = *dsl::parse_split(GetParam().split);
    const d3d9::Limits& limits = d3d9::limits_of(d3d9::Profile::ps_2_0);
    for (request.pass = 1; request.pass <= dsl::pass_count(request.split); ++request.pass) {
        SCOPED_TRACE(dsl::pass_work(request.split, request.pass));
        const Result<Variant> pass = make_variant(catalogue, request);
        ASSERT_TRUE(pass.ok()) << to_string(pass.error());
        const Result<Judged> judged = judge_variant(*pass);
        ASSERT_TRUE(judged.ok()) << to_string(judged.error());
        ASSERT_EQ(judged->shaders.size(), 2u) << "both stages";
        for (const d3d9::Shader& shader : judged->shaders) {
            if (!is_pixel(shader.profile)) continue;
            const d3d9::Resources used = d3d9::count(shader);
            EXPECT_LE(used.arithmetic, limits.arithmetic_slots);
            EXPECT_LE(used.texture, limits.texture_slots);
            // A pass reads the one before at one place.
            const bool reads_before = std::any_of(
                pass->program.pixel.samplers.begin(), pass->program.pixel.samplers.end(),
                [](const ir::Sampler& s) { return s.name == "displaced_map"; });
            EXPECT_EQ(reads_before, request.pass > 1);
        }
    }
}

TEST(SplitVariant, APassMustBeNamed) {
    VariantRequest request;
    request.surface = "parallax_occlusion";
    request.target = "glsl_450";
    request.split = *dsl::parse_split("shading");
    for (const int pass : {0, 3}) {
        request.pass = pass;
        const Result<Variant> variant = make_variant(templates::all_techniques(), request);
        ASSERT_FALSE(variant.ok());
        EXPECT_EQ(variant.error().code, "split-pass");
    }
}

}  // namespace
}  // namespace intaglio

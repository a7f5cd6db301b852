// Every composition of techniques on every target, at the edges of its knobs, through every
// witness.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/check/cost.h"
#include "src/variant/variant.h"
#include "templates/all_techniques.h"

namespace intaglio {
namespace {

const dsl::Catalogue& catalogue() {
    static const dsl::Catalogue all = templates::all_techniques();
    return all;
}

std::vector<std::string> judged_targets() {
    std::vector<std::string> names;
    for (const Target* target : all_targets())
        if (language_of(*target)) names.emplace_back(target->name);
    return names;
}

Result<Variant> variant_of(const std::string& surface, const std::string& target,
                           const std::vector<std::pair<std::string, std::string>>& knobs = {}) {
    VariantRequest request;
    request.surface = surface;
    request.target = target;
    request.knobs = knobs;
    return make_variant(catalogue(), request);
}

TEST(Variant, EveryCompositionIsAcceptedOnEveryTarget) {
    ASSERT_THAT(
        judged_targets(),
        testing::IsSupersetOf({"glsl_450", "glsl_330", "glsl_120", "essl_300", "essl_100",
                               "hlsl_5_0", "hlsl_3_0", "hlsl_2_b", "hlsl_2_0", "spirv", "msl"}));
    int fit_in_2_0 = 0;
    for (const auto& search : catalogue().searches)
        for (const auto& shadow : catalogue().shadows)
            for (const auto& output : catalogue().outputs)
                for (const std::string& target : judged_targets()) {
                    const std::string surface = "search=" + search.name + ",shadow=" + shadow.name +
                                                ",output=" + output.name;
                    const Result<Variant> variant = variant_of(surface, target);
                    if (target == "hlsl_2_0" && !variant.ok()) {
                        // Its 32 texture reads are fewer than the loops of a march have iterations.
                        EXPECT_EQ(variant.error().code, "target-limit")
                            << surface << ": " << to_string(variant.error());
                        EXPECT_THAT(variant.error().message,
                                    testing::HasSubstr("reads textures more than 32 times"))
                            << surface;
                        continue;
                    }
                    fit_in_2_0 += target == "hlsl_2_0" ? 1 : 0;
                    ASSERT_TRUE(variant.ok())
                        << surface << " " << target << ": " << to_string(variant.error());
                    const Result<Judged> judged = judge_variant(*variant);
                    EXPECT_TRUE(judged.ok())
                        << surface << " " << target << ": " << to_string(judged.error());
                }
    EXPECT_GT(fit_in_2_0, 0);
}

TEST(Variant, LanguagesWithoutSpirvEndAfterTheFrontEnd) {
    for (const char* target : {"glsl_120", "essl_100"}) {
        const Result<Variant> variant = variant_of("steep_parallax,shadow=march", target);
        ASSERT_TRUE(variant.ok()) << to_string(variant.error());
        const Result<Judged> judged = judge_variant(*variant);
        ASSERT_TRUE(judged.ok()) << to_string(judged.error());
        EXPECT_EQ(judged->steps,
                  (std::vector<std::string>{std::string("vertex: glslang ") + target,
                                            std::string("pixel: glslang ") + target}));
        const Result<check::Program> linked = link_variant(*variant);
        ASSERT_FALSE(linked.ok());
        EXPECT_EQ(linked.error().code, "not-runnable");
    }
}

TEST(Variant, ShaderModel2KeepsNoLoopBranchOrGivenLevel) {
    for (const char* target : {"hlsl_2_0", "hlsl_2_b"}) {
        const Result<Variant> variant = variant_of("parallax_occlusion", target, {{"taps", "8"}});
        ASSERT_TRUE(variant.ok()) << to_string(variant.error());
        for (const char* absent : {"for (", "if (", "tex2Dlod", "tex2Dgrad", "ddx", "ddy"})
            EXPECT_THAT(variant->pixel.text, testing::Not(testing::HasSubstr(absent)));
        EXPECT_THAT(variant->pixel.notes,
                    testing::Contains(testing::HasSubstr("the hardware chooses the level")));
        const Result<Variant> coarse = variant_of("parallax_occlusion", target, {{"level", "1"}});
        ASSERT_FALSE(coarse.ok());
        EXPECT_THAT(coarse.error().message, testing::HasSubstr("a given level other than 0"));
        VariantRequest kept;
        kept.surface = "parallax_occlusion";
        kept.target = target;
        kept.loop_forms = {{"march", ir::LoopForm::Rolled}};
        const Result<Variant> rolled = make_variant(catalogue(), kept);
        ASSERT_FALSE(rolled.ok());
        EXPECT_EQ(rolled.error().message,
                  std::string("the loop march cannot stay a loop: ") + target + " has none");
    }
}

TEST(Variant, EveryKnobIsAcceptedAtBothEnds) {
    const std::string surface = "steep_parallax,shadow=march";
    for (const std::string& target : {std::string("glsl_450"), std::string("hlsl_3_0")})
        for (const auto& [knob, value] :
             std::vector<std::pair<std::string, std::string>>{{"packed", "1"},
                                                              {"level", "16"},
                                                              {"level", "0.5"},
                                                              {"nyquist", "1"},
                                                              {"max_steps", "512"},
                                                              {"min_steps", "1"},
                                                              {"shadow_max_steps", "512"},
                                                              {"shadow_start", "0"},
                                                              {"shadow_start", "1"},
                                                              {"shininess", "1"},
                                                              {"shininess", "256"}}) {
            const Result<Variant> variant = variant_of(surface, target, {{knob, value}});
            if (target == "hlsl_3_0" && value == "512") {
                // ps_3_0 repeats a loop at most 255 times, and its compiler stops there in silence.
                ASSERT_FALSE(variant.ok());
                EXPECT_EQ(variant.error().code, "target-limit");
                continue;
            }
            ASSERT_TRUE(variant.ok()) << knob << "=" << value << ": " << to_string(variant.error());
            const Result<check::Program> linked = link_variant(*variant);
            EXPECT_TRUE(linked.ok())
                << knob << "=" << value << " on " << target << ": " << to_string(linked.error());
        }
    for (const char* taps : {"1", "2", "256"}) {
        const Result<Variant> variant =
            variant_of("parallax_occlusion", "glsl_450", {{"taps", taps}});
        ASSERT_TRUE(variant.ok()) << to_string(variant.error());
        EXPECT_TRUE(judge_variant(*variant).ok()) << taps << " taps";
    }
}

TEST(Variant, EmissionIsDeterministic) {
    for (const std::string& target : judged_targets()) {
        // Short marches, which hlsl_2_0 can carry too.
        const std::vector<std::pair<std::string, std::string>> knobs = {
            {"max_steps", "8"}, {"min_steps", "8"}, {"shadow_max_steps", "8"}};
        const Result<Variant> first = variant_of("steep_parallax,shadow=march", target, knobs),
                              second = variant_of("steep_parallax,shadow=march", target, knobs);
        ASSERT_TRUE(first.ok() && second.ok()) << target;
        EXPECT_EQ(first->pixel.text, second->pixel.text) << target;
        EXPECT_EQ(product_of(*first, ir::Stage::Pixel)->bytes,
                  product_of(*second, ir::Stage::Pixel)->bytes)
            << target;
    }
}

TEST(Variant, UnrollingIsObeyedWhateverTheCount) {
    for (const char* taps : {"2", "8", "128"}) {
        VariantRequest request;
        request.surface = "parallax_occlusion,output=displaced";
        request.target = "glsl_450";
        request.knobs = {{"taps", taps}};
        request.loop_forms = {{"march", ir::LoopForm::Unrolled}};
        const Result<Variant> variant = make_variant(catalogue(), request);
        ASSERT_TRUE(variant.ok()) << to_string(variant.error());
        EXPECT_THAT(variant->pixel.text, testing::Not(testing::HasSubstr("for (")));
        EXPECT_TRUE(link_variant(*variant).ok());
    }
}

TEST(Variant, ThePaperFormHasAReadPerTap) {
    VariantRequest request;
    request.surface = "parallax_occlusion,output=displaced";
    request.target = "glsl_450";
    request.loop_forms = {{"march", ir::LoopForm::Unrolled}};
    const Result<Variant> variant = make_variant(catalogue(), request);
    ASSERT_TRUE(variant.ok());
    EXPECT_EQ(judge_variant(*variant)->pixel_cost.texture, 8);
}

TEST(Variant, NothingIsEmittedThatNobodyReads) {
    const Result<Variant> variant = variant_of("parallax_occlusion,output=displaced", "glsl_450");
    ASSERT_TRUE(variant.ok());
    for (const char* unread : {"normal_map", "colour_map", "to_light", "ambient", "map_size"}) {
        EXPECT_THAT(variant->pixel.text, testing::Not(testing::HasSubstr(unread)));
        EXPECT_THAT(variant->vertex.text, testing::Not(testing::HasSubstr(unread)));
    }
}

TEST(Variant, PerVertexMovesWorkAndSaysSo) {
    VariantRequest request;
    request.surface = "parallax_occlusion";
    request.target = "glsl_450";
    request.per_vertex = true;
    const Result<Variant> variant = make_variant(catalogue(), request);
    ASSERT_TRUE(variant.ok()) << to_string(variant.error());
    EXPECT_TRUE(judge_variant(*variant).ok());
}

}  // namespace
}  // namespace intaglio

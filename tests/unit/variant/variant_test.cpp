// Every composition of techniques on every target, at the edges of its knobs, through every witness.
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
    ASSERT_THAT(judged_targets(), testing::IsSupersetOf({"glsl_450", "glsl_330", "essl_300", "hlsl_5_0", "hlsl_3_0", "spirv", "msl"}));
    for (const auto& search : catalogue().searches)
        for (const auto& shadow : catalogue().shadows)
            for (const auto& output : catalogue().outputs)
                for (const std::string& target : judged_targets()) {
                    const std::string surface = "search=" + search.name + ",shadow=" + shadow.name + ",output=" + output.name;
                    const Result<Variant> variant = variant_of(surface, target);
                    ASSERT_TRUE(variant.ok()) << surface << " " << target << ": " << to_string(variant.error());
                    const Result<Judged> judged = judge_variant(*variant);
                    EXPECT_TRUE(judged.ok()) << surface << " " << target << ": " << to_string(judged.error());
                }
}

TEST(Variant, EveryKnobIsAcceptedAtBothEnds) {
    const std::string surface = "steep_parallax,shadow=march";
    for (const std::string& target : {std::string("glsl_450"), std::string("hlsl_3_0")})
        for (const auto& [knob, value] : std::vector<std::pair<std::string, std::string>>{
                 {"packed", "1"}, {"level", "16"}, {"level", "0.5"}, {"nyquist", "1"}, {"max_steps", "512"}, {"min_steps", "1"},
                 {"shadow_max_steps", "512"}, {"shadow_start", "0"}, {"shadow_start", "1"}, {"shininess", "1"}, {"shininess", "256"}}) {
            const Result<Variant> variant = variant_of(surface, target, {{knob, value}});
            if (target == "hlsl_3_0" && value == "512") {
                // ps_3_0 repeats a loop at most 255 times, and its compiler stops there in silence.
                ASSERT_FALSE(variant.ok());
                EXPECT_EQ(variant.error().code, "target-limit");
                continue;
            }
            ASSERT_TRUE(variant.ok()) << knob << "=" << value << ": " << to_string(variant.error());
            const Result<check::Program> linked = link_variant(*variant);
            EXPECT_TRUE(linked.ok()) << knob << "=" << value << " on " << target << ": " << to_string(linked.error());
        }
    for (const char* taps : {"1", "2", "256"}) {
        const Result<Variant> variant = variant_of("parallax_occlusion", "glsl_450", {{"taps", taps}});
        ASSERT_TRUE(variant.ok()) << to_string(variant.error());
        EXPECT_TRUE(judge_variant(*variant).ok()) << taps << " taps";
    }
}

TEST(Variant, EmissionIsDeterministic) {
    for (const std::string& target : judged_targets()) {
        const Result<Variant> first = variant_of("steep_parallax,shadow=march", target), second = variant_of("steep_parallax,shadow=march", target);
        EXPECT_EQ(first->pixel.text, second->pixel.text) << target;
        EXPECT_EQ(product_of(*first, ir::Stage::Pixel)->bytes, product_of(*second, ir::Stage::Pixel)->bytes) << target;
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

// What a variant is: its schedule is obeyed, it is always the same, and holds nothing unread.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "src/check/cost.h"
#include "src/check/reflect.h"
#include "tests/unit/variant/requests.h"

namespace intaglio {
namespace {

std::vector<std::string> judged_targets() {
    std::vector<std::string> names;
    for (const Target* target : all_targets())
        if (language_of(*target)) names.emplace_back(target->name);
    return names;
}

Result<Variant> variant_of(const std::string& surface, const std::string& target,
                           const std::vector<std::pair<std::string, std::string>>& knobs = {}) {
    return make_variant(catalogue(), request_of(surface, target, knobs));
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

// By the names in the text, of uniforms and interpolants.
std::set<std::string> names_of_lights(const std::string& lights, const std::string& shadowed) {
    VariantRequest request;
    request.surface = "parallax_occlusion,shadow=march";
    request.target = "glsl_450";
    request.knobs = {{"lights", lights}, {"shadowed_lights", shadowed}};
    const Result<Variant> variant = make_variant(catalogue(), request);
    EXPECT_TRUE(variant.ok()) << to_string(variant.error());
    const Result<check::Program> program = link_variant(*variant);
    EXPECT_TRUE(program.ok()) << to_string(program.error());
    std::set<std::string> names;
    for (const check::SpirvWords* words : {&program->vertex, &program->pixel}) {
        const Result<check::Reflection> reflection = check::reflect(*words);
        for (const check::Reflection::Block& block : reflection->blocks)
            for (const check::Reflection::Member& member : block.members)
                if (member.name.starts_with("light")) names.insert(member.name);
    }
    for (const ir::Declaration& input : variant->program.pixel.inputs)
        if (input.name.starts_with("to_light")) names.insert(input.name);
    for (const std::string* text : {&variant->vertex.text, &variant->pixel.text})
        for (const char* name : {"shadow_reach", "to_light", "to_light_1", "to_light_2"})
            if (text->find(name) != std::string::npos) names.insert(std::string("text: ") + name);
    return names;
}

TEST(Variant, ALightThatIsLeftOutLeavesNothingBehind) {
    const std::set<std::string> one = {"light", "light_colour", "to_light", "text: to_light",
                                       "text: shadow_reach"};
    EXPECT_EQ(names_of_lights("1", "4"), one);
    std::set<std::string> two = one, without_shadow = one;
    two.insert({"light_1", "light_colour_1", "to_light_1", "text: to_light_1"});
    EXPECT_EQ(names_of_lights("2", "4"), two);
    without_shadow.erase("text: shadow_reach");
    EXPECT_EQ(names_of_lights("1", "0"), without_shadow);
    EXPECT_EQ(names_of_lights("0", "4"), std::set<std::string>());
}

TEST(Variant, MoreLightsThanInterpolantsAreRefusedWithTheirNumber) {
    VariantRequest request;
    request.surface = "parallax_occlusion,output=depth";
    request.knobs = {{"taps", "2"}, {"lights", "4"}, {"ray_per_vertex", "1"}};
    request.split.sections = 2;
    request.pass = 2;
    for (const char* target : {"glsl_120", "essl_100", "hlsl_2_b", "glsl_450"}) {
        request.target = target;
        const bool fits = request.target == "glsl_450";
        const Result<Variant> variant = make_variant(catalogue(), request);
        EXPECT_EQ(variant.ok(), fits) << target;
        if (fits || variant.ok()) continue;
        EXPECT_TRUE(is_refusal(variant.error())) << to_string(variant.error());
        EXPECT_THAT(variant.error().message,
                    testing::HasSubstr("takes 9 values from the vertex stage"));
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

// Every composition of techniques on every target, at the edges of its knobs, through every
// witness.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

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

// "search=none,shadow=march": {"search=none", "shadow=march"}.
std::set<std::string> techniques_of(const std::string& composition) {
    std::set<std::string> all;
    std::istringstream items(composition);
    for (std::string item; std::getline(items, item, ',');) all.insert(item);
    return all;
}

// Compositions in which every two techniques of different parts meet at least once, beginning with
// every search under every shadow.
std::vector<std::string> compositions_of_all_pairs() {
    const auto names = [](const auto& table) {
        std::vector<std::string> all;
        for (const auto& row : table) all.push_back(row.name);
        return all;
    };
    const std::vector<std::pair<std::string, std::vector<std::string>>> parts = {
        {"search", names(catalogue().searches)},
        {"shadow", names(catalogue().shadows)},
        {"normal", names(catalogue().normals)},
        {"shading", names(catalogue().shadings)},
        {"output", names(catalogue().outputs)}};
    std::set<std::string> met;
    std::vector<std::string> compositions;
    const auto pairs_of = [&](const std::vector<std::size_t>& choice) {
        std::vector<std::string> pairs;
        for (std::size_t i = 0; i < parts.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                pairs.push_back(parts[i].second[choice[i]] + " " + parts[i].first + " " +
                                parts[j].second[choice[j]] + " " + parts[j].first);
        return pairs;
    };
    // Of all that share a search and a shadow, the one with the most pairs not met so far; then
    // again until nothing is new.
    for (bool any_new = true, first = true; any_new; first = false) {
        any_new = false;
        for (std::size_t search = 0; search < parts[0].second.size(); ++search)
            for (std::size_t shadow = 0; shadow < parts[1].second.size(); ++shadow) {
                std::vector<std::size_t> best, choice = {search, shadow, 0, 0, 0};
                long most = first ? -1 : 0;
                for (choice[2] = 0; choice[2] < parts[2].second.size(); ++choice[2])
                    for (choice[3] = 0; choice[3] < parts[3].second.size(); ++choice[3])
                        for (choice[4] = 0; choice[4] < parts[4].second.size(); ++choice[4]) {
                            const std::vector<std::string> pairs = pairs_of(choice);
                            const long fresh =
                                std::count_if(pairs.begin(), pairs.end(),
                                              [&](const auto& pair) { return !met.count(pair); });
                            if (fresh > most) most = fresh, best = choice;
                        }
                if (best.empty()) continue;
                any_new = true;
                std::string text;
                for (std::size_t i = 0; i < parts.size(); ++i)
                    text += (i ? "," : "") + parts[i].first + "=" + parts[i].second[best[i]];
                compositions.push_back(text);
                for (const std::string& pair : pairs_of(best)) met.insert(pair);
            }
    }
    return compositions;
}

TEST(Variant, EveryPairOfTechniquesIsAcceptedOnEveryTargetThatCanHoldIt) {
    ASSERT_THAT(
        judged_targets(),
        testing::IsSupersetOf({"glsl_450", "glsl_330", "glsl_120", "essl_300", "essl_100",
                               "hlsl_5_0", "hlsl_3_0", "hlsl_2_b", "hlsl_2_0", "spirv", "msl"}));
    // Those that have limits, and what they may say; the others take everything.
    const std::string levels = "no texture reads with a given level other than 0";
    const std::map<std::string, std::vector<std::string>> limits = {
        {"essl_100", {"essl_100 has no volume textures"}},
        {"hlsl_2_0", {"reads textures more than 32 times", levels}},
        {"hlsl_2_b", {"reads textures more than 512 times", levels}},
        {"hlsl_3_0", {"hlsl_3_0 can repeat one"}}};
    const std::vector<std::string> compositions = compositions_of_all_pairs();
    std::map<std::string, std::set<std::string>> accepted;  // techniques, by target
    const auto judge = [&](const std::string& surface, const std::string& target) {
        const Result<Variant> variant = variant_of(surface, target);
        if (const auto limit = limits.find(target); limit != limits.end() && !variant.ok()) {
            EXPECT_EQ(variant.error().code, "target-limit")
                << surface << ": " << to_string(variant.error());
            EXPECT_THAT(limit->second, testing::Contains(testing::ResultOf(
                                           [&](const std::string& sentence) {
                                               return variant.error().message.find(sentence) !=
                                                      std::string::npos;
                                           },
                                           true)))
                << surface << ": " << variant.error().message;
            return;
        }
        ASSERT_TRUE(variant.ok()) << surface << " " << target << ": " << to_string(variant.error());
        const Result<Judged> judged = judge_variant(*variant);
        EXPECT_TRUE(judged.ok()) << surface << " " << target << ": " << to_string(judged.error());
        accepted[target].merge(techniques_of(surface));
    };
    // Every pair on one target and on another in turn; every technique on every target, thrice
    // where what it is composed with may be too much.
    const std::vector<std::string> targets = judged_targets();
    std::map<std::pair<std::string, std::string>, int> tried;
    for (std::size_t i = 0; i < compositions.size(); ++i)
        for (std::size_t j = 0; j < targets.size(); ++j) {
            const std::set<std::string> techniques = techniques_of(compositions[i]);
            const int wanted = limits.count(targets[j]) ? 3 : 1;
            if (targets[j] != "glsl_450" && i % targets.size() != j &&
                std::all_of(techniques.begin(), techniques.end(), [&](const auto& technique) {
                    return tried[{targets[j], technique}] >= wanted;
                }))
                continue;
            for (const std::string& technique : techniques) ++tried[{targets[j], technique}];
            judge(compositions[i], targets[j]);
        }
    const std::set<std::string>& all = accepted["glsl_450"];
    for (const std::string& target : targets) {
        if (limits.count(target) == 0) {
            EXPECT_EQ(accepted[target], all) << target;
        }
        EXPECT_GT(accepted[target].size(), all.size() * 2 / 3) << target;
    }
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

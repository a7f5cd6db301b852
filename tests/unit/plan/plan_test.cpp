// Plans of small scenes: what is chosen is never beaten, what is dropped is gone, and the same plan
// comes of any number of threads and of what was kept.
#include "src/plan/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "src/plan/surface_work.h"
#include "templates/all_techniques.h"

namespace intaglio::plan {
namespace {

using testing::HasSubstr;

// Few searches, so that all of them can be tried in no time.
const dsl::Catalogue& small_catalogue() {
    static const dsl::Catalogue catalogue = [] {
        dsl::Catalogue all = templates::all_techniques();
        const auto keep = [](auto& table, std::vector<std::string> names) {
            std::erase_if(table, [&](const auto& entry) {
                return std::find(names.begin(), names.end(), entry.name) == names.end();
            });
        };
        keep(all.searches, {"none", "parallax", "parallax_occlusion", "exact"});
        keep(all.shadows, {"none", "occlusion_profile", "horizon"});
        all.presets.clear();
        return all;
    }();
    return catalogue;
}

scene::Scene small_scene(std::vector<std::string> targets) {
    scene::Scene scene;
    scene.name = "small";
    scene.size = 32;
    scene::SceneSurface surface;
    surface.name = "quay";
    surface.map.set = *measure::make_map_set("bricks", 32, 32, 0.06);
    surface.map.hash = measure::content_hash(surface.map.set);
    surface.scale = 0.06;
    surface.uniforms["scale"] = {0.06f};
    surface.elevation = {35, 90};
    surface.azimuth = {0, 360};
    surface.targets = std::move(targets);
    surface.tolerance = {{"p95", 0.5}, {"missed", 3}};
    surface.knobs = {{"max_cells", "64"}, {"max_leaps", "64"}};
    scene.surfaces.push_back(std::move(surface));
    return scene;
}

scene::SurfaceLight light(std::string name, double elevation) {
    scene::SurfaceLight made;
    made.name = std::move(name);
    made.elevation = {elevation, elevation};
    made.azimuth = {70, 70};
    return made;
}

Plan planned(const scene::Scene& scene, PlanOptions options = {}) {
    options.most_steps = 8;
    Result<Plan> plan = plan_scene(small_catalogue(), scene, options);
    EXPECT_TRUE(plan.ok()) << to_string(plan.error());
    return plan ? std::move(*plan) : Plan{};
}

const Candidate& chosen_of(const Plan& plan, std::size_t choice = 0) {
    return plan.choices.at(choice).candidates.at(plan.choices.at(choice).chosen.value());
}

bool has_dropped(const Choice& choice, const std::string& what) {
    return std::any_of(choice.dropped.begin(), choice.dropped.end(),
                       [&](const Dropped& dropped) { return dropped.what == what; });
}

// Every candidate there is, judged: none costs as little or less and errs less in all that counts.
TEST(Plan, ChoosesWhatNothingBeats) {
    scene::Scene scene = small_scene({"glsl_450", "ps_2_b"});
    const Plan quick = planned(scene);
    PlanOptions all;
    all.exhaustive = true;
    const Plan thorough = planned(scene, all);
    ASSERT_EQ(quick.choices.size(), 2u);
    ASSERT_EQ(thorough.choices.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        const Candidate& chosen = chosen_of(quick, i);
        int judged = 0;
        for (const Candidate& other : thorough.choices[i].candidates) {
            if (!other.judged || other.fate == Fate::Refused || other.text == chosen.text) continue;
            ++judged;
            bool as_right = true;
            for (const auto& [metric, limit] : scene.surfaces[0].tolerance)
                as_right = as_right && other.errors.at(metric) <= chosen.errors.at(metric);
            EXPECT_FALSE(other.cost < chosen.cost && as_right)
                << thorough.choices[i].target << ": " << other.text << " costs " << other.cost
                << ", the chosen " << chosen.text << " " << chosen.cost;
            if (other.fate != Fate::Dearer) continue;
            EXPECT_GE(other.cost, chosen.cost) << other.text;
        }
        EXPECT_GE(judged, 6) << thorough.choices[i].target;
        EXPECT_EQ(chosen.text, chosen_of(thorough, i).text);
    }
    EXPECT_LT(quick.tried, thorough.tried);
}

TEST(Plan, StaysWithinToleranceAndBudget) {
    scene::Scene scene = small_scene({"ps_2_b"});
    const Candidate free = chosen_of(planned(scene));
    for (const auto& [metric, limit] : scene.surfaces[0].tolerance)
        EXPECT_LE(free.errors.at(metric), limit);
    scene.surfaces[0].tolerance = {{"p95", 3}, {"missed", 30}};
    scene.surfaces[0].budget["*"]["arithmetic"] = free.costs.at("arithmetic") - 1;
    const Candidate bound = chosen_of(planned(scene));
    EXPECT_LT(bound.costs.at("arithmetic"), free.costs.at("arithmetic"));
    EXPECT_LE(bound.errors.at("p95"), 3);
}

TEST(Plan, NamesTheNearestTwoWhereNothingFits) {
    scene::Scene scene = small_scene({"ps_2_0"});
    scene.surfaces[0].elevation = {15, 20};
    scene.surfaces[0].tolerance = {{"p95", 0.01}, {"missed", 0}};
    const Plan plan = planned(scene);
    EXPECT_FALSE(plan.is_satisfied());
    const Choice& choice = plan.choices.front();
    EXPECT_FALSE(choice.order.has_value());
    ASSERT_TRUE(choice.best_that_fits && choice.cheapest_right);
    const Candidate& fits = choice.candidates[*choice.best_that_fits];
    EXPECT_EQ(fits.fate, Fate::Wrong);
    EXPECT_GT(fits.errors.at("p95"), 0.01);
    EXPECT_LE(fits.costs.at("arithmetic"), 64);
    const Candidate& right = choice.candidates[*choice.cheapest_right];
    EXPECT_LE(right.errors.at("p95"), 0.01);
    EXPECT_EQ(right.fate, Fate::Refused);
    const std::string people = to_people(plan);
    EXPECT_THAT(people, HasSubstr("the best that fits: " + fits.text));
    EXPECT_THAT(people, HasSubstr("the cheapest that is right: " + right.text));
}

// A surface that wants shadows which ps_2_0 has no room for: what is named still fits there.
TEST(Plan, NamesWhatFitsBesideManyThatDoNot) {
    scene::Scene scene = small_scene({"ps_2_0"});
    scene::SceneSurface& surface = scene.surfaces[0];
    surface.elevation = {12, 90};
    surface.lights = {light("sun", 8)};  // below the relief's steepest slope
    surface.features = {scene::Feature::Shadow};
    surface.tolerance = {{"p95", 0.05}, {"missed", 0.1}, {"shadow_wrong", 8}};
    const Plan plan = planned(scene);
    const Choice& choice = plan.choices.at(0);
    ASSERT_FALSE(choice.chosen);
    ASSERT_TRUE(choice.best_that_fits);
    EXPECT_LE(choice.candidates[*choice.best_that_fits].costs.at("arithmetic"), 64);
    // What is foreseen of the other says how wrong its shadow is, not that of its search alone.
    ASSERT_TRUE(choice.cheapest_right);
    EXPECT_LE(choice.candidates[*choice.cheapest_right].errors.at("shadow_wrong"), 8 * 1.25);
}

// Coarse hits would do, but the shadows that fall on them would not.
TEST(Plan, ClimbsOnWhereShadowsNeedBetterHits) {
    scene::Scene scene = small_scene({"glsl_450"});
    scene::SceneSurface& surface = scene.surfaces[0];
    surface.lights = {light("sun", 4)};
    surface.elevation = {20, 90};
    surface.features = {scene::Feature::Shadow};
    surface.tolerance = {{"p95", 100}, {"missed", 100}};
    const Candidate coarse = chosen_of(planned(scene));
    EXPECT_THAT(coarse.text, testing::StartsWith("none"));
    surface.tolerance["shadow_wrong"] = 21;
    const Candidate fine = chosen_of(planned(scene));
    EXPECT_LE(fine.errors.at("shadow_wrong"), 21);
    EXPECT_GT(fine.cost, coarse.cost) << fine.text;
}

// Where a ray hits is as wrong whether the pixel is shown or not.
TEST(Plan, WhatIsCutOffIsNoError) {
    scene::Scene scene = small_scene({"ps_2_b", "glsl_450"});
    const Plan whole = planned(scene);
    scene.surfaces[0].features = {scene::Feature::Silhouette};
    const Plan cut = planned(scene);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(chosen_of(cut, i).text, chosen_of(whole, i).text);
        EXPECT_EQ(chosen_of(cut, i).errors, chosen_of(whole, i).errors);
        EXPECT_GT(chosen_of(cut, i).cost, chosen_of(whole, i).cost);
    }
}

// Where the pixel stage alone is too long, the vertex stage does its part.
TEST(Plan, MovesWorkToTheVertexStageWhereNothingFitsWithout) {
    scene::Scene scene = small_scene({"ps_2_0"});
    scene.surfaces[0].parts["search"] = "parallax_occlusion";
    scene.surfaces[0].lights = {light("sun", 50)};
    scene.surfaces[0].knobs = {{"taps", "28"}};
    scene.surfaces[0].tolerance = {{"p95", 100}};
    const Candidate chosen = chosen_of(planned(scene));
    EXPECT_TRUE(chosen.request.per_vertex);
    EXPECT_THAT(chosen.text, testing::EndsWith(", per vertex"));
    VariantRequest alone = chosen.request;
    alone.per_vertex = false;
    const auto refused = make_variant(small_catalogue(), alone);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, "d3d9-limit");
}

TEST(Plan, IsTheSameOnAnyNumberOfThreads) {
    scene::Scene scene = small_scene({"glsl_450", "ps_2_b"});
    scene.surfaces[0].lights = {light("sun", 6)};
    scene.surfaces[0].features = {scene::Feature::Shadow};
    scene.surfaces[0].tolerance["shadow_wrong"] = 10;
    PlanOptions two;
    two.workers = 2;
    EXPECT_EQ(to_text(planned(scene)), to_text(planned(scene, two)));
}

TEST(Plan, MeasuresNothingTwice) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / "intaglio plan";
    std::filesystem::remove_all(folder);
    PlanOptions kept;
    kept.cache = folder;
    scene::Scene scene = small_scene({"glsl_450", "ps_2_0"});
    const Plan first = planned(scene, kept), second = planned(scene, kept);
    EXPECT_GT(first.tried, 0);
    EXPECT_EQ(first.kept, 0);
    EXPECT_EQ(second.tried, 0);
    EXPECT_EQ(to_text(first), to_text(second));
    // Another map is another matter.
    scene.surfaces[0].map.set = *measure::make_map_set("noise", 32, 32, 0.06);
    scene.surfaces[0].map.hash = measure::content_hash(scene.surfaces[0].map.set);
    EXPECT_EQ(planned(scene, kept).kept, 0);
    std::filesystem::remove_all(folder);
}

TEST(Plan, ShadowsOnlyWhereALightCanCastThem) {
    scene::Scene scene = small_scene({"glsl_450"});
    scene::SceneSurface& surface = scene.surfaces[0];
    surface.features = {scene::Feature::Shadow};
    surface.lights = {light("sun", 6), light("below", -10)};
    const auto text_of = [&](const Plan& plan) {
        const auto variant =
            make_variant(small_catalogue(), plan.choices.front().order.value().request);
        EXPECT_TRUE(variant.ok());
        return variant ? variant->pixel.text : std::string();
    };
    const Plan shadowed = planned(scene);
    EXPECT_TRUE(has_dropped(shadowed.choices[0], "light below"));
    EXPECT_THAT(chosen_of(shadowed).text, HasSubstr("shadow "));
    EXPECT_THAT(text_of(shadowed), HasSubstr("float visibility"));
    EXPECT_EQ(text_of(shadowed).find("to_light_1"), std::string::npos);
    EXPECT_THAT(shadowed.choices[0].order->lights, testing::ElementsAre("sun"));
    surface.lights[1] = light("lamp", 60);
    EXPECT_THAT(text_of(planned(scene)), HasSubstr("to_light_1"));

    // Steeper than the relief: by bound, whatever a measurement says.
    surface.lights = {light("noon", 89.9)};
    const Plan noon = planned(scene);
    EXPECT_TRUE(has_dropped(noon.choices[0], "shadow of noon"));
    EXPECT_EQ(chosen_of(noon).text.find("shadow"), std::string::npos);
    EXPECT_EQ(text_of(noon).find("float visibility"), std::string::npos);
    EXPECT_FALSE(chosen_of(noon).errors.contains("shadow_wrong"));
    EXPECT_TRUE(chosen_of(shadowed).errors.contains("shadow_wrong"));
}

// Every light that throws shadows is tried as the first: what only that one cannot do is forgotten.
TEST(Plan, OneLightStandsForAllThatThrowShadows) {
    VariantRequest request;
    request.known.ranges = {
        {"light.z", {0.5f, 0.6f}}, {"light_1.z", {0.1f, 0.2f}}, {"view.z", {0.3f, 1.0f}}};
    const auto known_with = [&](const char* shadowed) {
        request.knobs = {{"taps", "4"}, {"lights", "2"}, {"shadowed_lights", shadowed}};
        const VariantRequest one = SurfaceWork::one_light(request);
        EXPECT_THAT(one.knobs, testing::ElementsAre(testing::Pair("taps", "4")));
        std::vector<std::string> names;
        for (const auto& [name, range] : one.known.ranges) names.push_back(name);
        return names;
    };
    EXPECT_THAT(known_with("1"), testing::ElementsAre("light.z", "view.z"));
    EXPECT_THAT(known_with("2"), testing::ElementsAre("view.z"));
}

TEST(Plan, RefusesUnknownNames) {
    scene::Scene scene = small_scene({"glsl_450"});
    const auto code = [&](const PlanOptions& options = {}) {
        const Result<Plan> plan = plan_scene(small_catalogue(), scene, options);
        return plan ? std::string() : plan.error().code;
    };
    PlanOptions options;
    options.surface = "quays";
    EXPECT_EQ(code(options), "unknown-surface");
    options = {};
    options.target = "ps_2_0";
    EXPECT_EQ(code(options), "unknown-target");
    scene::SceneSurface& surface = scene.surfaces[0];
    const scene::SceneSurface plain = surface;
    surface.knobs = {{"tap", "3"}};
    EXPECT_EQ(code(), "unknown-knob");
    surface.knobs = {{"lights", "3"}};
    EXPECT_EQ(code(), "scene-conflict");
    surface.knobs = {{"clip_tile", "0"}};
    surface.features = {scene::Feature::Silhouette};
    EXPECT_EQ(code(), "scene-conflict");
    surface = plain;
    surface.uniforms["ambeint"] = {0, 0, 0};
    EXPECT_EQ(code(), "unknown-uniform");
    surface = plain;
    surface.loop_forms["marhc"] = ir::LoopForm::Rolled;
    EXPECT_EQ(code(), "unknown-loop");
    surface = plain;
    surface.features = {scene::Feature::Fur, scene::Feature::Shadow};
    EXPECT_EQ(code(), "scene-conflict");
    surface.features = {scene::Feature::Depth};
    surface.parts["output"] = "colour";
    EXPECT_EQ(code(), "scene-conflict");
    surface = plain;
    // Pinned for those searches that have the loop.
    surface.loop_forms["march"] = ir::LoopForm::Unrolled;
    EXPECT_EQ(code(), "");
    surface = plain;
    scene.surfaces[0].parts["search"] = "parallax_occlusion";
    scene.surfaces[0].knobs = {{"taps", "9000"}};
    EXPECT_EQ(code(), "knob-range");
    scene.surfaces[0].knobs = {};
    scene.surfaces[0].parts["search"] = "cones";
    EXPECT_EQ(code(), "unknown-technique");
}

}  // namespace
}  // namespace intaglio::plan

// The gate on real shaders: a technique is made worse, less accurate and better, and the gate says
// so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "generator/intaglio.h"
#include "src/budget/formats.h"
#include "src/budget/planned.h"
#include "src/budget/verdict.h"
#include "templates/all_techniques.h"

namespace intaglio::budget {
namespace {

using testing::HasSubstr;

// What `search=parallax` is; three more ways to write it.
class Wasteful : public dsl::Search {
  public:
    dsl::Hit find(const dsl::Relief& relief, const dsl::Ray& ray) const override {
        const dsl::float1 height = dsl::let("height", relief.height(ray.uv));
        const dsl::float1 rise =
            dsl::let("rise", (height - 1.0f + 0.5f) - 0.5f);  // the same, and slower
        return {dsl::let("displaced", ray.uv + ray.reach * rise), height};
    }
};

class Careless : public dsl::Search {
  public:
    dsl::Hit find(const dsl::Relief& relief, const dsl::Ray& ray) const override {
        return {dsl::let("displaced", ray.uv - ray.reach),
                relief.height(ray.uv)};  // always the floor
    }
};

template <typename Technique>
dsl::Catalogue with_parallax() {
    dsl::Catalogue catalogue = templates::all_techniques();
    for (auto& row : catalogue.searches)
        if (row.name == "parallax")
            row = dsl::entry<dsl::Search, Technique>(row.name, row.summary, row.source);
    return catalogue;
}

std::vector<Observation> observed(const dsl::Catalogue& catalogue) {
    scene::Measurement scene;
    for (const char* target : {"ps_2_0", "glsl_450"})
        scene.plan.rows.push_back({"parallax,output=displaced", target, {}, {}});
    scene.plan.maps.push_back(*measure::make_map_set("cobbles", 32, 32, scene.plan.scale));
    scene.plan.views = {{50, 20}};
    scene.plan.lights = {{45, 135}};
    scene.plan.size = 32;
    const auto made = observe(catalogue, scene);
    EXPECT_TRUE(made.ok()) << to_string(made.error());
    return made.ok() ? *made : std::vector<Observation>();
}

Budgets no_growth() {
    Budgets budgets;
    budgets.file = "budgets.toml";
    for (const char* metric : {"arithmetic", "spirv_alu", "p95", "missed"})
        budgets.rules.push_back({{}, metric, {{}, 0.0, 1}});
    return budgets;
}

TEST(Gate, ANewerSlowerShaderIsRedWithItsLineBeforeAndAfter) {
    const auto good = observed(templates::all_techniques());
    EXPECT_TRUE(
        judge(no_growth(), good, observed(templates::all_techniques()), "2026-01-01").passes());
    const Verdict verdict =
        judge(no_growth(), observed(with_parallax<Wasteful>()), good, "2026-01-01");
    EXPECT_FALSE(verdict.passes());
    const std::string text = to_text(verdict);
    EXPECT_THAT(text,
                HasSubstr("over: parallax,output=displaced on ps_2_0: arithmetic grew from "));
    EXPECT_THAT(text,
                HasSubstr("over: parallax,output=displaced on glsl_450: spirv_alu grew from "));
    const std::size_t first = text.find("  spent by search at tests/unit/budget/gate_test.cpp:");
    ASSERT_NE(first, std::string::npos);
    EXPECT_NE(text.find("  spent by search at tests/unit/budget/gate_test.cpp:", first + 1),
              std::string::npos)
        << text;
}

TEST(Gate, CheaperAndLessAccurateIsRedToo) {
    const auto good = observed(templates::all_techniques());
    const Verdict verdict =
        judge(no_growth(), observed(with_parallax<Careless>()), good, "2026-01-01");
    EXPECT_FALSE(verdict.passes());
    for (const Finding& finding : verdict.findings) {
        if (finding.metric == "arithmetic") {
            EXPECT_LE(*finding.after, *finding.before);
        }
        if (finding.fails()) {
            EXPECT_THAT(finding.metric, testing::AnyOf("p95", "missed"));
        }
    }
}

TEST(Gate, BetterIsGreenAndOffersTheUpdate) {
    const Verdict verdict = judge(no_growth(), observed(templates::all_techniques()),
                                  observed(with_parallax<Wasteful>()), "2026-01-01");
    EXPECT_TRUE(verdict.passes());
    EXPECT_THAT(to_text(verdict), HasSubstr("\nbetter:\n"));
    EXPECT_THAT(to_text(verdict),
                HasSubstr("intaglio check budgets.toml --update holds them to it"));
}

scene::Scene one_wall() {
    scene::SceneSurface wall;
    wall.name = "wall";
    wall.map.set = *measure::make_map_set("cobbles", 16, 16, wall.scale);
    wall.map.hash = measure::content_hash(wall.map.set);
    wall.elevation = {50, 50};
    wall.azimuth = {20, 20};
    wall.targets = {"ps_2_0", "glsl_450"};
    wall.tolerance = {{"p95", 1000}, {"missed", 100}};
    wall.parts = {{"search", "parallax"}};
    wall.uniforms["scale"] = {static_cast<float>(wall.scale)};
    scene::Scene scene;
    scene.name = "yard";
    scene.size = 17;
    scene.surfaces.push_back(std::move(wall));
    return scene;
}

std::vector<Observation> planned(const dsl::Catalogue& catalogue) {
    const scene::Scene scene = one_wall();
    const auto plan = plan::plan_scene(catalogue, scene, {});
    EXPECT_TRUE(plan.ok()) << to_string(plan.error());
    if (!plan) return {};
    const auto made = observe(catalogue, scene, *plan);
    EXPECT_TRUE(made.ok()) << to_string(made.error());
    if (!made) return {};
    // What the plan was judged by in the evaluator the device draws; six digits are kept.
    for (const plan::Choice& choice : plan->choices) {
        EXPECT_TRUE(choice.order);
        if (!choice.order) continue;
        for (const Observation& one : *made) {
            if (one.target != choice.target) continue;
            for (const plan::Figure& figure : choice.order->errors)
                EXPECT_NEAR(one.values.at(figure.metric), figure.value, 1e-4 * figure.value + 1e-6)
                    << one.name() << " " << figure.metric;
        }
    }
    return *made;
}

TEST(Gate, AScenesShadersAreHeldUnderTheirSurfacesNames) {
    const auto good = planned(templates::all_techniques());
    ASSERT_EQ(good.size(), 2u);
    EXPECT_EQ(good[0].name(), "wall on glsl_450");
    EXPECT_EQ(good[1].name(), "wall on ps_2_0");
    EXPECT_TRUE(good[1].values.contains("p95_fp24"));
    EXPECT_TRUE(judge(no_growth(), good, good, "2026-01-01").passes());
    const auto wasteful = planned(with_parallax<Wasteful>());
    const Verdict slower = judge(no_growth(), wasteful, good, "2026-01-01");
    EXPECT_THAT(to_text(slower), HasSubstr("over: wall on ps_2_0: arithmetic grew from "));
    EXPECT_TRUE(judge(no_growth(), good, wasteful, "2026-01-01").passes());
    EXPECT_FALSE(
        judge(no_growth(), planned(with_parallax<Careless>()), good, "2026-01-01").passes());
}

TEST(Gate, WhatAPlanCannotChooseIsRed) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    scene::Scene scene = one_wall();
    scene.surfaces[0].tolerance = {{"p95", 0}};
    const auto plan = plan::plan_scene(catalogue, scene, {});
    ASSERT_TRUE(plan.ok()) << to_string(plan.error());
    const auto made = observe(catalogue, scene, *plan);
    ASSERT_TRUE(made.ok()) << to_string(made.error());
    ASSERT_EQ(made->size(), 2u);
    EXPECT_FALSE(made->front().refusal.empty());
    EXPECT_FALSE(judge(no_growth(), *made, {}, "2026-01-01").passes());
    EXPECT_FALSE(judge(no_growth(), *made, *made, "2026-01-01").passes());
}

}  // namespace
}  // namespace intaglio::budget

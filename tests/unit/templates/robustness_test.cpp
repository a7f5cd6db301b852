// Every search of the table on what breaks searches: every edge of its knobs, the smallest maps,
// views along the polygon and from below it.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "generator/dsl/catalogue.h"
#include "templates/all_techniques.h"
#include "tests/unit/templates/bench.h"

namespace intaglio::templates {
namespace {

const dsl::Catalogue& catalogue() {
    static const dsl::Catalogue all = all_techniques();
    return all;
}

// The default, and each knob at both ends of its range; loops stay short enough to run, and
// max_steps above min_steps.
std::vector<Knobs> knob_edges(const std::string& search) {
    std::vector<Knobs> all = {{}};
    for (const auto& row : catalogue().searches) {
        if (row.name != search) continue;
        const std::unique_ptr<dsl::Search> technique = row.make();
        for (const dsl::KnobBase* knob : technique->knobs())
            for (double end : {knob->least(), knob->most()})
                all.push_back({{knob->name(), fmt::format("{}", std::min(end, 60.0))}});
    }
    return all;
}

TEST(Robustness, EveryAnswerIsFiniteAndWithinTheRay) {
    unsigned state = 31;
    const Map maps[] = {flat_map(0),         flat_map(1),         noise_map(1, 1, 5),
                        noise_map(1, 64, 6), noise_map(64, 1, 7), noise_map(3, 5, 8),
                        map_named("spikes")};
    const double coordinates[] = {0, 1, -3.7, 0.999999940395355224609375, 64.5, 1000.25};
    for (const auto& row : catalogue().searches)
        for (const Knobs& knobs : knob_edges(row.name)) {
            const Asked search(row.name, knobs);
            for (const Map& map : maps)
                for (double elevation : {90.0, 45.0, 3.0, 0.01, 0.0, -30.0, -90.0}) {
                    Ray ray = random_ray(state, elevation);
                    ray.uv = {coordinates[state % 6], coordinates[state / 8 % 6]};
                    ray.pixel = {0.01, 0.02};
                    const Answer answer = search(map, ray);
                    EXPECT_TRUE(answer.finite())
                        << row.name << (knobs.empty() ? "" : " " + knobs[0].first) << " at "
                        << elevation << " degrees";
                    // 4: the greatest parallax_scale and limited_scale.
                    const double reach = ray.scale * 4 / std::max(ray.view.z, 1.0 / 1024);
                    EXPECT_LE(std::hypot(answer.uv.x - ray.uv.x, answer.uv.y - ray.uv.y),
                              reach * (1 + 1e-5) + 1e-4)
                        << row.name << " at " << elevation << " degrees";
                }
        }
}

TEST(Robustness, StraightDownNothingMoves) {
    const Map map = map_named("bricks");
    for (const auto& row : catalogue().searches)
        for (double u : {0.0, 0.3, 0.5}) {
            const Answer answer = Asked(row.name)(map, {{u, 0.4}, {0, 0, 1}});
            EXPECT_EQ(answer.uv.x, static_cast<float>(u)) << row.name;
            EXPECT_EQ(answer.uv.y, 0.4f) << row.name;
        }
}

// What follows the ray says that it met the relief, on the floor too.
TEST(Robustness, TheFloorIsFound) {
    const Map floor = map_named("flat0");
    for (const auto& row : catalogue().searches)
        for (double elevation : {90.0, 40.0, 12.0}) {
            const Ray ray{{0.3, 0.7}, direction(elevation, 25)};
            const Answer answer = Asked(row.name)(floor, ray);
            EXPECT_NE(answer.found, 0) << row.name << " at " << elevation << " degrees";
        }
}

// n steps of float(1 / n) end a little above the floor for some n.
TEST(Robustness, TheFloorIsFoundWithEveryNumberOfSteps) {
    const Map floor = flat_map(0);
    const Ray ray{{0.3, 0.7}, direction(40, 25)};
    for (const auto& [search, knob] : {std::pair{"relief", "linear_steps"},
                                       {"relief_secant", "linear_steps"},
                                       {"contact_refinement", "coarse_steps"}})
        for (int steps = 1; steps <= 100; ++steps) {
            const Answer answer = Asked(search, {{knob, std::to_string(steps)}})(floor, ray);
            EXPECT_EQ(answer.found, 1) << search << " " << steps;
            EXPECT_NEAR(answer.height, 0, 1e-6) << search << " " << steps;
        }
}

}  // namespace
}  // namespace intaglio::templates

// Orders, case by case.
#include "src/budget/planned.h"

#include <algorithm>

#include "src/budget/observing.h"
#include "src/measure/command.h"
#include "src/measure/laboratory.h"
#include "src/plan/sweep.h"

namespace intaglio::budget {
namespace {

void add_case(Observation& into, const measure::Case& what, const measure::CaseMetrics& metrics,
              const std::vector<std::string>& map_arguments) {
    const std::string command = measure::run_command(what, map_arguments, "", {});
    if (what.arithmetic != measure::Arithmetic::Fp32) {
        add_hits(into, metrics.hits, "_" + std::string(name_of(what.arithmetic)), command);
        return;
    }
    if (metrics.slots)
        add_slots(into, *metrics.slots);
    else
        add_spirv(into, metrics.spirv);
    add_worst(into, "reads", metrics.executed.reads_mean, "");
    add_hits(into, metrics.hits, "", command);
    into.values["invalid"] += static_cast<double>(metrics.hits.invalid + metrics.picture.invalid);
}

}  // namespace

Result<std::vector<Observation>> observe(const dsl::Catalogue& catalogue, const scene::Scene& scene,
                                         const plan::Plan& plan,
                                         const std::function<void(int, int)>& progress) {
    std::vector<Observation> observations;
    std::vector<std::size_t> place;  // of each row of the sweep
    for (const scene::SceneSurface& surface : scene.surfaces)
        for (const plan::Choice& choice : plan.choices) {
            if (choice.surface != surface.name) continue;
            Observation observation{choice.surface, choice.target, "", {}, {}, {}, {}, true};
            if (choice.order) {
                place.push_back(observations.size());
                if (Status status = add_lines(observation, catalogue, choice.order->request);
                    !status)
                    return status.error();
            } else {
                observation.refusal =
                    "no variant is right enough within the scene's budget; see intaglio plan";
            }
            observations.push_back(std::move(observation));
        }
    Result<measure::Laboratory> laboratory = measure::Laboratory::create(catalogue, {});
    if (!laboratory) return laboratory.error();
    const measure::SweepPlan sweep = plan::sweep_of(scene, plan, true);
    int done = 0;
    for (const measure::SweepCase& one : sweep.cases) {
        const measure::CaseMap& map = sweep.maps[one.map];
        const Result<measure::CaseMetrics> metrics = laboratory->measure(one.what, map);
        if (!metrics) return metrics.error();
        Observation& into = observations[place[one.row]];
        if (metrics->refusal)
            into.refusal = metrics->refusal->message;
        else
            add_case(into, one.what, *metrics, map.arguments);
        if (progress) progress(++done, static_cast<int>(sweep.cases.size()));
    }
    std::sort(observations.begin(), observations.end());
    return observations;
}

}  // namespace intaglio::budget

// Scenes under a budget: what a plan chose, measured.
#pragma once

#include <functional>
#include <vector>

#include "generator/dsl/catalogue.h"
#include "src/budget/observation.h"
#include "src/plan/plan.h"

namespace intaglio::budget {

// One observation for each surface and target of the plan, under the surface's name and without
// settings: a plan that chooses otherwise than before is held against what it chose then.  Where it
// could not choose there is a refusal.  Errors: those of measure::Laboratory.
Result<std::vector<Observation>> observe(
    const dsl::Catalogue& catalogue, const scene::Scene& scene, const plan::Plan& plan,
    const std::function<void(int done, int all)>& progress = {});

}  // namespace intaglio::budget

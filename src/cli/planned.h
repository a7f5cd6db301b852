// Scenes with surfaces where a command measures: they are planned first, as `intaglio plan` would.
#pragma once

#include <functional>
#include <string>

#include "generator/dsl/catalogue.h"
#include "src/plan/plan.h"

namespace intaglio::cli {

struct PlannedScene {
    scene::Scene scene;
    plan::Plan plan;
};
// With what earlier plans measured.  What cannot be satisfied has no order.  Errors: those of
// read_scene and plan_scene.
Result<PlannedScene> planned_scene(const dsl::Catalogue& catalogue, const std::string& file);

// On a terminal one line of stderr that says what is planned; else nothing.
std::function<void(const std::string& what, int done, int all)> planning_line();

// Error "plan-unsatisfied", with the names of what has no order.
Status check_satisfied(const plan::Plan& plan, const std::string& scene);

}  // namespace intaglio::cli

// What a plan chose, as a sweep: every order on its surface's own map, from its own views and
// lights, on the device.  Planning judged them in the evaluator; this is the second witness.
#pragma once

#include "src/measure/sweep.h"
#include "src/plan/plan.h"

namespace intaglio::plan {

// Rows are the plan's orders in its order, maps the scene's surfaces under their names.  The cases
// of a row are the shots of rays.h with the shader's first light; with `narrow` a Direct3D 9 row
// has them in 24 and 16 bits as well.  What could not be chosen is left out.
measure::SweepPlan sweep_of(const scene::Scene& scene, const Plan& plan, bool narrow = false);

}  // namespace intaglio::plan

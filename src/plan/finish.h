// From the chosen candidate to its order, and what was left out of it with the cost of each.
#pragma once

#include "src/plan/surface_work.h"

namespace intaglio::plan {

// `choice.chosen` is set.
Status finish(const SurfaceWork& work, Choice& choice);

}  // namespace intaglio::plan

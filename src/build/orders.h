// The orders of a scene: what each surface becomes on each of its targets.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"
#include "src/plan/order.h"
#include "src/scene/scene.h"

namespace intaglio::build {

// By surface, in the order of the scene; of each by target.
using Orders = std::vector<std::vector<plan::Order>>;

struct PlannerOptions {
    std::filesystem::path cache;  // of what was measured; empty: nothing is kept
    int jobs = 0;                 // 0: as the machine has cores
    // What is worked on; may be empty.
    std::function<void(const std::string& what, int done, int all)> progress = {};
};
using Planner = std::function<Result<Orders>(
    const dsl::Catalogue& catalogue, const scene::Scene& scene, const PlannerOptions& options)>;

// src/plan.  Error plan::unsatisfied: a surface has no variant that is right and within its budget,
// with the nearest two in notes; those of plan_scene.
Result<Orders> planned_orders(const dsl::Catalogue& catalogue, const scene::Scene& scene,
                              const PlannerOptions& options);

// Every surface as its file pins it, nothing measured and nothing left out.  Error "not-pinned": a
// surface names no search.
Result<Orders> pinned_orders(const dsl::Catalogue& catalogue, const scene::Scene& scene,
                             const PlannerOptions& options);

}  // namespace intaglio::build

// Reads and plans.
#include "src/cli/planned.h"

#include <algorithm>
#include <thread>

namespace intaglio::cli {

Result<PlannedScene> planned_scene(const dsl::Catalogue& catalogue, const std::string& file) {
    Result<scene::Scene> scene = scene::read_scene(file, &catalogue);
    if (!scene) return scene.error();
    plan::PlanOptions options;
    options.workers = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    options.cache = plan::default_cache();
    Result<plan::Plan> plan = plan::plan_scene(catalogue, *scene, options);
    if (!plan) return plan.error();
    return PlannedScene{std::move(*scene), std::move(*plan)};
}

}  // namespace intaglio::cli

// Reads and plans.
#include "src/cli/planned.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include <fmt/format.h>

namespace intaglio::cli {

std::function<void(const std::string&, int, int)> planning_line() {
    if (!isatty(STDERR_FILENO)) return {};
    return [](const std::string& what, int done, int all) {
        fmt::print(stderr, "\r\033[K");
        if (done < all) fmt::print(stderr, "planning {} ({} of {})", what, done + 1, all);
        std::fflush(stderr);
    };
}

Status check_satisfied(const plan::Plan& plan, const std::string& scene) {
    if (plan.is_satisfied()) return Done{};
    std::size_t left = 0;
    std::string names;
    for (const plan::Choice& choice : plan.choices) {
        if (choice.order) continue;
        ++left;
        names +=
            fmt::format("{}{} on {}", names.empty() ? "" : ", ", choice.surface, choice.target);
    }
    Diagnostic error =
        input_error(std::string(plan::unsatisfied),
                    fmt::format("{} of {} cannot be right enough within target and budget: {}",
                                left, plan.choices.size(), names),
                    scene);
    error.notes.push_back(
        "hint: the plan names the best that fits and the cheapest that is right; allow more "
        "error, a greater budget or another target");
    return error;
}

Result<PlannedScene> planned_scene(const dsl::Catalogue& catalogue, const std::string& file) {
    Result<scene::Scene> scene = scene::read_scene(file, &catalogue);
    if (!scene) return scene.error();
    plan::PlanOptions options;
    options.workers = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    options.cache = plan::default_cache();
    options.progress = planning_line();
    Result<plan::Plan> plan = plan::plan_scene(catalogue, *scene, options);
    if (!plan) return plan.error();
    return PlannedScene{std::move(*scene), std::move(*plan)};
}

}  // namespace intaglio::cli

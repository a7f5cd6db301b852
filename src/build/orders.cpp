// A surface whose file names its search is taken at its word.
#include "src/build/orders.h"

#include <fmt/format.h>

#include "src/build/parallel.h"
#include "src/plan/plan.h"

namespace intaglio::build {
namespace {

std::string composition_of(const scene::SceneSurface& surface) {
    std::string text;
    for (const auto& [part, technique] : surface.parts)
        text += fmt::format("{}{}={}", text.empty() ? "" : ",", part, technique);
    return text;
}

plan::Order pinned_order(const scene::SceneSurface& surface, const std::string& target) {
    plan::Order order;
    order.surface = surface.name;
    order.request.surface = composition_of(surface);
    order.request.target = target;
    order.request.knobs = surface.knobs;
    order.request.loop_forms = surface.loop_forms;
    order.request.known.uniforms = surface.uniforms;
    order.request.known.uniforms["scale"] = {static_cast<float>(surface.scale)};
    return order;
}

// What a person reads where a surface has no order.
Diagnostic no_order(const scene::Scene& scene, const scene::SceneSurface& surface,
                    const plan::Choice& choice) {
    Diagnostic error =
        input_error(std::string(plan::unsatisfied),
                    fmt::format("no variant of {} on {} is right enough and within its budget",
                                choice.surface, choice.target),
                    scene.file.string(), surface.line, surface.column);
    const auto note = [&](const char* what, const std::optional<std::size_t>& index) {
        if (index)
            error.notes.push_back(fmt::format("{}: {}: {}", what, choice.candidates[*index].text,
                                              choice.candidates[*index].why));
    };
    note("the best that fits", choice.best_that_fits);
    note("the cheapest that is right", choice.cheapest_right);
    error.notes.push_back(fmt::format("hint: intaglio plan {} --surface {} says more",
                                      scene.file.string(), choice.surface));
    return error;
}

}  // namespace

Result<Orders> planned_orders(const dsl::Catalogue& catalogue, const scene::Scene& scene,
                              const PlannerOptions& options) {
    plan::PlanOptions wanted;
    wanted.workers = thread_count(options.jobs);
    // Where `intaglio plan` keeps it too.
    if (!options.cache.empty()) wanted.cache = options.cache / "measured";
    wanted.progress = options.progress;
    Result<plan::Plan> plan = plan::plan_scene(catalogue, scene, wanted);
    if (!plan) return plan.error();
    Orders orders;
    std::size_t next = 0;
    for (const scene::SceneSurface& surface : scene.surfaces) {
        orders.emplace_back();
        for (std::size_t i = 0; i < surface.targets.size(); ++i) {
            plan::Choice& choice = plan->choices[next++];
            if (!choice.order) return no_order(scene, surface, choice);
            orders.back().push_back(std::move(*choice.order));
        }
    }
    return orders;
}

Result<Orders> pinned_orders(const dsl::Catalogue&, const scene::Scene& scene,
                             const PlannerOptions&) {
    Orders orders;
    for (const scene::SceneSurface& surface : scene.surfaces) {
        if (!surface.parts.contains("search"))
            return input_error("not-pinned",
                               fmt::format("the surface {} names no search: pin one", surface.name),
                               scene.file.string(), surface.line, surface.column);
        orders.emplace_back();
        for (const std::string& target : surface.targets)
            orders.back().push_back(pinned_order(surface, target));
    }
    return orders;
}

}  // namespace intaglio::build

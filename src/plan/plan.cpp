// Scenes to plans, surface by surface.
#include "src/plan/plan.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "src/plan/surface_work.h"

namespace intaglio::plan {
namespace {

Status check_names(const scene::Scene& scene, const PlanOptions& options) {
    std::vector<std::string> surfaces, targets;
    for (const scene::SceneSurface& surface : scene.surfaces) {
        surfaces.push_back(surface.name);
        for (const std::string& target : surface.targets)
            if (std::find(targets.begin(), targets.end(), target) == targets.end())
                targets.push_back(target);
    }
    const auto unknown = [](const std::vector<std::string>& all, const std::string& name) {
        return !name.empty() && std::find(all.begin(), all.end(), name) == all.end();
    };
    if (unknown(surfaces, options.surface))
        return input_error("unknown-surface",
                           unknown_name_sentence("surface of the scene", options.surface, surfaces),
                           scene.file.string());
    if (unknown(targets, options.target))
        return input_error("unknown-target",
                           unknown_name_sentence("target of the scene", options.target, targets),
                           scene.file.string());
    return Done{};
}

bool is_asked_for(const std::string& option, const std::string& name) {
    return option.empty() || option == name;
}

// Its errors point at the surface.
Status plan_surface(const dsl::Catalogue& catalogue, const scene::Scene& scene,
                    const scene::SceneSurface& surface, const PlanOptions& options, Kept& kept,
                    const std::function<void(const std::string&, bool)>& step, Plan& plan) {
    Site site(catalogue, surface);
    SurfaceWork work{catalogue, surface, scene.read_weight, options, kept, site};
    if (Status status = derive(work); !status) return status;
    for (std::size_t i = 1; i < work.common.lights.size(); ++i)
        site.aim(i, lowest_of(surface.lights[work.common.lights[i]]));
    work.hit_rays = views_alone(rays_of(surface, work.common.lights, scene.size));
    work.shadow_rays = rays_of(surface, work.common.shadowing, scene.size);
    step(fmt::format("searches and shadows of {}", surface.name), false);
    if (Status status = climb_ladders(work); !status) return status;
    for (const std::string& target : surface.targets) {
        if (!is_asked_for(options.target, target)) continue;
        step(fmt::format("{} on {}", surface.name, target), true);
        Result<Choice> choice = choose(work, target);
        if (!choice) return choice.error();
        plan.choices.push_back(std::move(*choice));
    }
    return Done{};
}

}  // namespace

std::string_view name_of(Fate fate) {
    switch (fate) {
        case Fate::Chosen: return "chosen";
        case Fate::Dearer: return "dearer";
        case Fate::Wrong: return "wrong";
        case Fate::OverBudget: return "over budget";
        case Fate::Refused: return "refused";
        case Fate::NotTried: break;
    }
    return "not tried";
}

std::string_view name_of(Dropped::By by) {
    switch (by) {
        case Dropped::By::Bound: return "bound";
        case Dropped::By::Measured: return "measured";
        case Dropped::By::Fixed: break;
    }
    return "fixed";
}

bool Plan::is_satisfied() const {
    return std::all_of(choices.begin(), choices.end(),
                       [](const Choice& choice) { return choice.chosen.has_value(); });
}

std::filesystem::path default_cache() {
    const auto set = [](const char* name) -> std::filesystem::path {
        const char* value = std::getenv(name);
        return value == nullptr ? "" : value;
    };
    if (const auto own = set("INTAGLIO_CACHE"); !own.empty()) return own / "measured";
    if (const auto xdg = set("XDG_CACHE_HOME"); !xdg.empty()) return xdg / "intaglio" / "measured";
    if (const auto home = set("HOME"); !home.empty())
        return home / ".cache" / "intaglio" / "measured";
    return {};
}

Result<Plan> plan_scene(const dsl::Catalogue& catalogue, const scene::Scene& scene,
                        const PlanOptions& options) {
    if (Status status = check_names(scene, options); !status) return status.error();
    Plan plan;
    plan.scene = scene.name;
    int all = 0, done = 0;
    for (const scene::SceneSurface& surface : scene.surfaces)
        if (is_asked_for(options.surface, surface.name))
            for (const std::string& target : surface.targets)
                all += is_asked_for(options.target, target) ? 1 : 0;
    const auto step = [&](const std::string& what, bool is_choice) {
        if (options.progress) options.progress(what, done, all);
        done += is_choice ? 1 : 0;
    };
    Kept kept(options.cache);
    for (const scene::SceneSurface& surface : scene.surfaces) {
        if (!is_asked_for(options.surface, surface.name)) continue;
        const Status status = plan_surface(catalogue, scene, surface, options, kept, step, plan);
        if (status) continue;
        Diagnostic error = status.error();
        if (error.file.empty() && error.fault == Fault::Input) {
            error.file = scene.file.string();
            error.line = surface.line;
            error.column = surface.column;
        }
        return error;
    }
    if (options.progress) options.progress("", done, all);
    plan.tried = kept.tried();
    plan.kept = kept.found();
    return plan;
}

}  // namespace intaglio::plan

// From orders to cases.
#include "src/plan/sweep.h"

#include "src/plan/rays.h"

namespace intaglio::plan {
namespace {

using measure::Arithmetic;

// The light that is aimed: the shader's first.
std::vector<std::size_t> first_light(const scene::SceneSurface& surface, const Order& order) {
    for (std::size_t i = 0; i < surface.lights.size(); ++i)
        if (!order.lights.empty() && surface.lights[i].name == order.lights.front()) return {i};
    return {};
}

std::vector<Arithmetic> arithmetics_of(const std::string& target_name, bool narrow) {
    const Target* target = find_target(target_name);
    if (!narrow || target == nullptr || !profile_of(*target)) return {Arithmetic::Fp32};
    return {Arithmetic::Fp32, Arithmetic::Fp24, Arithmetic::Fp16};
}

}  // namespace

measure::SweepPlan sweep_of(const scene::Scene& scene, const Plan& plan, bool narrow) {
    measure::SweepPlan sweep;
    for (std::size_t index = 0; index < scene.surfaces.size(); ++index) {
        const scene::SceneSurface& surface = scene.surfaces[index];
        measure::CaseMap map = surface.map;
        map.map_class = map.set.name = surface.name;
        sweep.maps.push_back(std::move(map));
        for (const Choice& choice : plan.choices) {
            if (choice.surface != surface.name || !choice.order) continue;
            const VariantRequest& request = choice.order->request;
            const Rays rays = rays_of(surface, first_light(surface, *choice.order), scene.size);
            for (const Arithmetic arithmetic : arithmetics_of(request.target, narrow))
                for (const Shot& shot : rays.shots)
                    sweep.cases.push_back(
                        {sweep.rows.size(), index,
                         measure::Case{request, shot.view, shot.towards, surface.scale, rays.size,
                                       measure::Filtering::Float, arithmetic, 0, surface.name}});
            sweep.rows.push_back({request, scene.file.string(), surface.line, surface.column});
        }
    }
    return sweep;
}

}  // namespace intaglio::plan

// Orders.
#include "src/plan/finish.h"

#include <algorithm>

#include <fmt/format.h>

#include "generator/passes/pipeline.h"
#include "src/measure/baked_maps.h"
#include "src/measure/named_metric.h"

namespace intaglio::plan {
namespace {

// "relaxed_cone_map" is of kind "relaxed-cone"; two textures may come from one bake.
std::string kind_of(std::string sampler) {
    if (sampler.ends_with("_map")) sampler.resize(sampler.size() - 4);
    std::replace(sampler.begin(), sampler.end(), '_', '-');
    if (sampler == "height" || sampler == "normal" || sampler == "colour") return sampler;
    for (std::string kind = sampler;; kind.resize(kind.rfind('-'))) {
        if (measure::wanted_bake(kind, "", "")) return kind;
        if (kind.rfind('-') == std::string::npos) return "height";
    }
}

Result<std::vector<MapOrder>> maps_of(const SurfaceWork& work, const VariantRequest& request) {
    Result<Recorded> recorded = record_variant(work.catalogue, request);
    if (!recorded) return recorded.error();
    const auto notes = passes::optimize_program(recorded->program, {});
    if (!notes) return notes.error();
    std::vector<MapOrder> maps;
    for (const ir::Module* stage : {&recorded->program.vertex, &recorded->program.pixel})
        for (const ir::Sampler& sampler : stage->samplers) {
            const std::string kind = kind_of(sampler.name);
            maps.push_back({sampler.name, kind, fmt::format("{}.{}.png", work.surface.name, kind)});
        }
    std::sort(maps.begin(), maps.end(),
              [](const MapOrder& a, const MapOrder& b) { return a.uniform < b.uniform; });
    return maps;
}

// A knob with another value.
VariantRequest with_knob(VariantRequest request, const std::string& name, std::size_t value) {
    std::erase_if(request.knobs, [&](const auto& knob) { return knob.first == name; });
    request.knobs.emplace_back(name, fmt::format("{}", value));
    return request;
}

// What the variant would cost with the thing that was left out of it.
Status price_without(const SurfaceWork& work, const Candidate& chosen, VariantRequest with,
                     Dropped& dropped) {
    if (work.optimized(with) == work.optimized(chosen.request)) return Done{};
    const Result<Trial> price = work.price(with);
    if (!price) return price.error();
    dropped.cost_after = chosen.cost;
    if (price->refusal.empty())
        dropped.cost_before = work.cost(*price);
    else
        dropped.why += "; with it its target refuses the variant";
    return Done{};
}

Status price_lights(const SurfaceWork& work, const Candidate& chosen,
                    std::vector<Dropped>& dropped) {
    const std::size_t lights = work.common.lights.size();
    for (Dropped& each : dropped) {
        if (!each.what.starts_with("light ") || lights >= dsl::most_lights) continue;
        if (Status status = price_without(
                work, chosen,
                work.knowing(with_knob(chosen.request, "lights", lights + 1), chosen.request.known),
                each);
            !status)
            return status;
    }
    return Done{};
}

Status price_known(const SurfaceWork& work, const Candidate& chosen,
                   std::vector<Dropped>& dropped) {
    const passes::Known& known = chosen.request.known;
    if (!known.uniforms.empty()) {
        std::string names;
        for (const auto& [name, value] : known.uniforms)
            names += (names.empty() ? "" : ", ") + name;
        passes::Known without = known;
        without.uniforms.clear();
        Dropped fixed{"uniforms " + names,
                      Dropped::By::Fixed,
                      "the scene says what they are: folded into constants",
                      {},
                      {}};
        VariantRequest with = chosen.request;
        with.known = without;
        if (Status status = price_without(work, chosen, with, fixed); !status) return status;
        if (fixed.cost_after) dropped.push_back(std::move(fixed));
    }
    passes::Known without = known;
    without.ranges.clear();
    Dropped guards{"guards and iterations",
                   Dropped::By::Bound,
                   "the ranges of views, lights and heights decide them",
                   {},
                   {}};
    VariantRequest with = chosen.request;
    with.known = without;
    if (Status status = price_without(work, chosen, with, guards); !status) return status;
    if (guards.cost_after) dropped.push_back(std::move(guards));
    return Done{};
}

}  // namespace

Status finish(const SurfaceWork& work, Choice& choice) {
    const Candidate& chosen = choice.candidates[*choice.chosen];
    const Target& target = *find_target(choice.target);
    const bool bytecode = profile_of(target).has_value();
    const std::string run_by = bytecode ? "the interpreter of bytecode" : "the evaluator of IR";
    const std::string charge = "Direct3D 9's charge";
    const std::string counted = bytecode && !target.capabilities.loops ? charge : run_by;

    Order order;
    order.surface = choice.surface;
    order.request = chosen.request;
    order.costs = {
        {"cost", chosen.cost, fmt::format("operations + {:g} x reads", work.read_weight)},
        {"operations", chosen.operations, counted},
        {"reads_shaded", chosen.reads, counted}};
    for (const auto& [metric, value] : chosen.costs) {
        const measure::Metric* known = measure::find_metric(metric);
        const bool of_spirv = known != nullptr && known->of == measure::Metric::Of::Spirv;
        const bool of_run = metric == "reads";
        order.costs.push_back({metric, value,
                               of_run     ? run_by
                               : of_spirv ? "SPIRV-Tools' optimiser"
                                          : charge});
    }
    for (const auto& [metric, value] : chosen.errors)
        order.errors.push_back({metric, value, run_by});
    Result<std::vector<MapOrder>> maps = maps_of(work, chosen.request);
    if (!maps) return maps.error();
    order.maps = std::move(*maps);
    for (const std::size_t light : work.common.lights)
        order.lights.push_back(work.surface.lights[light].name);
    choice.order = std::move(order);

    if (work.wants_shadow() && chosen.text.find(", shadow none") != std::string::npos) {
        const double wrong = chosen.errors.at("shadow_wrong");
        Dropped shadow{
            "shadow",
            Dropped::By::Measured,
            fmt::format("shadow_wrong is {:.3g} % of pixels without, which is tolerated", wrong),
            {},
            {}};
        choice.dropped.push_back(std::move(shadow));
    }
    if (Status status = price_lights(work, chosen, choice.dropped); !status) return status;
    if (Status status = price_known(work, chosen, choice.dropped); !status) return status;
    return Done{};
}

}  // namespace intaglio::plan

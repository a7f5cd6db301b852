// What the scene decides before anything is tried: parts, knobs, lights, and what shaders may know.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "generator/ir/print.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/rewrite.h"
#include "src/plan/surface_work.h"

namespace intaglio::plan {
namespace {

bool has(const scene::SceneSurface& surface, scene::Feature feature) {
    return surface.features.contains(feature);
}

std::string part(const scene::SceneSurface& surface, const std::string& name) {
    const auto found = surface.parts.find(name);
    return found == surface.parts.end() ? std::string() : found->second;
}

void derive_parts(SurfaceWork& work) {
    const scene::SceneSurface& surface = work.surface;
    Common& common = work.common;
    common.search = part(surface, "search");
    common.shadow = part(surface, "shadow");
    if (common.shadow.empty() && has(surface, scene::Feature::Fur)) common.shadow = "fur_depth";
    std::string output = part(surface, "output");
    if (output.empty() && has(surface, scene::Feature::Depth)) output = "depth";
    for (const auto& [name, technique] : std::initializer_list<std::pair<std::string, std::string>>{
             {"normal", part(surface, "normal")},
             {"shading", part(surface, "shading")},
             {"output", output},
             {"vertex", part(surface, "vertex")}})
        if (!technique.empty()) common.rest += fmt::format(",{}={}", name, technique);
    common.loop_forms = surface.loop_forms;
    common.knobs = surface.knobs;
    const auto add = [&](const char* knob, const char* value) {
        for (const auto& [name, pinned] : common.knobs)
            if (name == knob) return;
        common.knobs.emplace_back(knob, value);
    };
    // Surfaces of a scene are flat: there the ray's reach is interpolated without loss.
    add("ray_per_vertex", "1");
    if (has(surface, scene::Feature::Silhouette)) add("clip_tile", "1");
}

void derive_lights(SurfaceWork& work) {
    const scene::SceneSurface& surface = work.surface;
    const bool wanted = has(surface, scene::Feature::Shadow);
    std::vector<std::size_t> others;
    const auto drop = [&](const std::string& what, Dropped::By by, std::string why) {
        work.dropped.push_back({what, by, std::move(why), {}, {}});
    };
    for (std::size_t i = 0; i < surface.lights.size(); ++i) {
        const scene::SurfaceLight& light = surface.lights[i];
        const measure::Directions directions = directions_of(light);
        const bool free = wanted && light.shadows && can_reach(light) &&
                          light.elevation.least > 0 &&
                          measure::casts_no_shadow(work.site.field(), surface.scale, directions);
        if (!can_reach(light)) {
            drop("light " + light.name, Dropped::By::Bound,
                 fmt::format("it is never above the polygon: at most at {:.3g} degrees",
                             light.elevation.most));
            continue;
        }
        if (wanted && light.shadows && !free) {
            work.common.shadowing.push_back(i);
            continue;
        }
        others.push_back(i);
        if (free)
            drop("shadow of " + light.name, Dropped::By::Bound,
                 fmt::format("it is never below {:.3g} degrees, and towards it the relief rises "
                             "by at most {:.3g}",
                             light.elevation.least,
                             std::atan(measure::steepest_slope(work.site.field(), surface.scale,
                                                               directions)) *
                                 180 / std::numbers::pi));
        else if (wanted)
            drop("shadow of " + light.name, Dropped::By::Fixed,
                 "the scene says that it casts none");
    }
    work.common.lights = work.common.shadowing;
    work.common.lights.insert(work.common.lights.end(), others.begin(), others.end());
    if (wanted && surface.lights.empty())
        drop("shadow", Dropped::By::Bound, "there is no light to cast one");
}

void derive_known(SurfaceWork& work) {
    const scene::SceneSurface& surface = work.surface;
    passes::Known& known = work.common.known;
    known.uniforms = surface.uniforms;
    known.uniforms["scale"] = {static_cast<float>(surface.scale)};
    known.uniforms["map_size"] = {static_cast<float>(work.facts.width),
                                  static_cast<float>(work.facts.height)};
    const auto add = [&](const std::string& name, const measure::Directions& directions) {
        const std::array<passes::Interval, 3> ranges = measure::vector_ranges(directions);
        const char* components[] = {".x", ".y", ".z"};
        for (std::size_t i = 0; i < 3; ++i) known.ranges[name + components[i]] = ranges[i];
    };
    add("view", work.views);
    for (std::size_t i = 0; i < work.common.lights.size(); ++i) {
        const scene::SurfaceLight& light = surface.lights[work.common.lights[i]];
        // One that sets is not kept above the horizon.
        if (light.elevation.least > 0)
            add(dsl::name_of_light("light", static_cast<int>(i)),
                {light.elevation.least, light.elevation.most, light.azimuth.least,
                 light.azimuth.most});
    }
    const vulkan::Texture heights =
        measure::height_texture(surface.map.set, measure::Filtering::Native);
    known.ranges["height_map.x"] = measure::channel_range(heights, 0);
}

}  // namespace

Status derive(SurfaceWork& work) {
    for (const std::string& target : work.surface.targets)
        for (const auto& [metric, limit] : work.surface.tolerance_on(target)) {
            const auto [place, is_new] = work.strictest.try_emplace(metric, limit);
            if (!is_new) place->second = std::min(place->second, limit);
            const auto [loose, first] = work.loosest.try_emplace(metric, limit);
            if (!first) loose->second = std::max(loose->second, limit);
        }
    derive_parts(work);
    if (Status status = check_pinned(work); !status) return status;
    work.facts = measure::relief_facts(work.site.field());
    const scene::SceneSurface& of = work.surface;
    work.views = {of.elevation.least, of.elevation.most, of.azimuth.least, of.azimuth.most};
    derive_lights(work);
    if (work.common.lights.size() > static_cast<std::size_t>(dsl::most_lights))
        return input_error("too-many-lights",
                           fmt::format("{} lights reach the surface {}, of at most {} in one draw; "
                                       "name those that matter: lights = [...]",
                                       work.common.lights.size(), of.name, dsl::most_lights));
    derive_known(work);
    return Done{};
}

// What is pinned is for the techniques that have it.
static std::map<std::string, ir::LoopForm> with_those_loops(
    const dsl::Catalogue& catalogue, VariantRequest request,
    std::map<std::string, ir::LoopForm> pinned) {
    std::erase_if(pinned, [&](const auto& loop) {
        request.loop_forms = {loop};
        const Result<Recorded> recorded = record_variant(catalogue, request);
        return !recorded && recorded.error().code == "unknown-loop";
    });
    return pinned;
}

VariantRequest SurfaceWork::request(const std::string& target, const Rung& search,
                                    const Rung* shadow, const Schedule& schedule) const {
    VariantRequest request;
    request.surface =
        fmt::format("search={},shadow={}{}", search.technique,
                    shadow                                               ? shadow->technique
                    : common.shadow.empty() || !common.shadowing.empty() ? "none"
                                                                         : common.shadow,
                    common.rest);
    request.target = target;
    request.loop_forms = with_those_loops(catalogue, request, common.loop_forms);
    request.per_vertex = schedule.per_vertex;
    const Result<dsl::Surface> composed = dsl::make_surface(catalogue, request.surface);
    if (!composed) return request;
    const auto add = [&](const Knobs& knobs) {
        for (const auto& [name, value] : knobs)
            for (const dsl::KnobBase* knob : composed->knobs())
                if (knob->name() == name) request.knobs.emplace_back(name, value);
    };
    add(common.knobs);
    add(search.knobs);
    if (shadow) add(shadow->knobs);
    if (!common.shadow.empty() || !common.shadowing.empty())
        add({{"shadowed_lights", fmt::format("{}", common.shadowing.size())}});
    add({{"lights", fmt::format("{}", common.lights.size())}});
    request = knowing(std::move(request), common.known);
    if (schedule.unrolled) {
        const Result<Recorded> recorded = record_variant(catalogue, request);
        if (recorded)
            passes::for_each_instruction(recorded->program.pixel.body,
                                         [&](const ir::Instruction& instruction) {
                                             if (instruction.op == ir::Op::Loop)
                                                 request.loop_forms.try_emplace(
                                                     instruction.loop.name, ir::LoopForm::Unrolled);
                                         });
    }
    return request;
}

std::string SurfaceWork::like(const VariantRequest& request, Ask ask) const {
    const Target* target = find_target(request.target);
    const std::string_view stand_in = "glsl_450";
    if (target == nullptr || profile_of(*target) || target->name == stand_in ||
        (ask == Ask::Cost && !target->capabilities.loops))
        return request.target;
    const auto text = [&](std::string_view on) {
        VariantRequest other = request;
        other.target = on;
        other.known = {};
        Result<Recorded> recorded = record_variant(catalogue, other);
        return recorded ? ir::print(recorded->program.vertex) + ir::print(recorded->program.pixel)
                        : std::string();
    };
    const std::string own = text(request.target);
    return !own.empty() && own == text(stand_in) ? std::string(stand_in) : request.target;
}

Result<Trial> SurfaceWork::written_out(const Rung& search, const Rung* shadow) const {
    const std::string key = search.text() + "," + (shadow ? shadow->text() : "");
    return *sizes.get(key, [&] {
        return kept.run(site, request("glsl_450", search, shadow), hit_rays, Ask::Size);
    });
}

std::string SurfaceWork::optimized(const VariantRequest& request) const {
    Result<Recorded> recorded = record_variant(catalogue, request);
    if (!recorded) return {};
    const auto notes = passes::optimize_program(recorded->program, {});
    if (!notes) return {};
    return ir::print(recorded->program.vertex) + ir::print(recorded->program.pixel);
}

VariantRequest SurfaceWork::knowing(VariantRequest request, const passes::Known& known) const {
    request.known = {};
    const Result<Recorded> recorded = record_variant(catalogue, request);
    if (recorded) request.known = passes::part_of(known, recorded->program);
    return request;
}

VariantRequest SurfaceWork::one_light(VariantRequest request) {
    // The one stands wherever any that throws shadows does, so what is known of the first holds for
    // it only where that is the only one.
    const bool has_others =
        std::any_of(request.knobs.begin(), request.knobs.end(), [](const auto& knob) {
            return knob.first == "shadowed_lights" && std::atoi(knob.second.c_str()) > 1;
        });
    std::erase_if(request.knobs, [](const auto& knob) {
        return knob.first == "lights" || knob.first == "shadowed_lights";
    });
    const auto of_others = [&](const auto& entry) {
        const bool numbered = entry.first.starts_with("light_") && entry.first.size() > 6 &&
                              std::isdigit(static_cast<unsigned char>(entry.first[6])) != 0;
        return numbered || (has_others && entry.first.starts_with("light."));
    };
    std::erase_if(request.known.uniforms,
                  [](const auto& entry) { return entry.first.find("light") != std::string::npos; });
    std::erase_if(request.known.ranges, of_others);
    return request;
}

VariantRequest SurfaceWork::unpruned(VariantRequest request) {
    request.known = {};
    return one_light(std::move(request));
}

Result<Trial> SurfaceWork::price(const VariantRequest& request) const {
    Result<Trial> fit = kept.run(site, request, rays(), Ask::Fit);
    const Target* target = find_target(request.target);
    if (!fit || !fit->refusal.empty() || profile_of(*target)) return fit;
    VariantRequest same = request;
    same.target = like(request, Ask::Cost);
    Result<Trial> cost = kept.run(site, same, rays(), Ask::Cost);
    if (cost) cost->costs = fit->costs;
    return cost;
}

}  // namespace intaglio::plan

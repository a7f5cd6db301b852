// What a scene pins, held against the techniques that there are and against the scene itself.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "generator/passes/rewrite.h"
#include "src/plan/surface_work.h"

namespace intaglio::plan {
namespace {

Status check_knobs_and_parts(const SurfaceWork& work) {
    std::vector<std::string> names;
    std::map<std::string, Status> taken;  // by knob, what a technique says that has it
    const auto look_at = [&](const std::vector<dsl::KnobBase*>& knobs) {
        for (dsl::KnobBase* knob : knobs) {
            names.push_back(knob->name());
            for (const auto& [name, value] : work.surface.knobs) {
                if (name != knob->name()) continue;
                const auto [place, is_new] = taken.try_emplace(name, knob->set(value));
                // One technique that takes the value is enough.
                if (!is_new && !place->second) place->second = knob->set(value);
            }
        }
    };
    const auto add = [&](const auto& technique) { look_at(technique->knobs()); };
    for (const auto& entry : work.catalogue.searches) add(entry.make());
    for (const auto& entry : work.catalogue.shadows) add(entry.make());
    const Result<dsl::Surface> surface = dsl::make_surface(
        work.catalogue, "search=" + work.catalogue.searches.front().name + work.common.rest);
    if (!surface) return surface.error();
    look_at(surface->knobs());
    for (const auto& [knob, value] : work.surface.knobs) {
        if (std::find(names.begin(), names.end(), knob) == names.end())
            return input_error("unknown-knob", unknown_name_sentence("knob", knob, names));
        if (!taken.at(knob)) return taken.at(knob).error();
    }
    const auto check = [&](const auto& table, const char* kind, const std::string& pinned) {
        std::vector<std::string> all;
        for (const auto& entry : table) all.push_back(entry.name);
        if (pinned.empty() || std::find(all.begin(), all.end(), pinned) != all.end())
            return Status(Done{});
        return Status(input_error("unknown-technique", unknown_name_sentence(kind, pinned, all)));
    };
    if (Status status = check(work.catalogue.searches, "search", work.common.search); !status)
        return status;
    return check(work.catalogue.shadows, "shadow", work.common.shadow);
}

// All names that a composition of the surface may have.
struct Names {
    std::set<std::string> uniforms, loops;
    static std::vector<std::string> listed(const std::set<std::string>& names) {
        return {names.begin(), names.end()};
    }
    void add(const ir::Program& program) {
        for (const ir::Module* stage : {&program.vertex, &program.pixel}) {
            for (const ir::Uniform& uniform : stage->uniforms) uniforms.insert(uniform.name);
            passes::for_each_instruction(stage->body, [&](const ir::Instruction& instruction) {
                if (instruction.op == ir::Op::Loop) loops.insert(instruction.loop.name);
            });
        }
    }
};

Names names_of(const SurfaceWork& work) {
    Names names;
    const auto add = [&](const std::string& search, const std::string& shadow) {
        VariantRequest request;
        request.target = "glsl_450";
        request.surface = fmt::format("search={},shadow={}{}", search, shadow, work.common.rest);
        request.knobs = {{"lights", fmt::format("{}", dsl::most_lights)}};
        if (const Result<Recorded> recorded = record_variant(work.catalogue, request))
            names.add(recorded->program);
    };
    const std::string& pinned = work.common.search;
    for (const auto& entry : work.catalogue.searches)
        if (pinned.empty() || entry.name == pinned)
            add(entry.name, work.catalogue.shadows.front().name);
    for (const auto& entry : work.catalogue.shadows)
        add(pinned.empty() ? work.catalogue.searches.front().name : pinned, entry.name);
    return names;
}

// A value for what no shader has would be left out without a word.
Status check_uniforms_and_loops(const SurfaceWork& work) {
    const scene::SceneSurface& surface = work.surface;
    if (surface.uniforms.size() <= 1 && surface.loop_forms.empty()) return Done{};
    const Names names = names_of(work);
    for (const auto& [uniform, value] : surface.uniforms)
        if (uniform != "scale" && !names.uniforms.contains(uniform))
            return input_error(
                "unknown-uniform",
                unknown_name_sentence("uniform", uniform, Names::listed(names.uniforms)));
    for (const auto& [loop, form] : surface.loop_forms)
        if (!names.loops.contains(loop))
            return input_error("unknown-loop",
                               unknown_name_sentence("loop", loop, Names::listed(names.loops)));
    return Done{};
}

// Where a feature or the scene's lights say one thing and a pinned part or knob another.
Status check_conflicts(const SurfaceWork& work) {
    const scene::SceneSurface& surface = work.surface;
    const auto refused = [](std::string sentence) {
        return input_error("scene-conflict", std::move(sentence));
    };
    const auto has = [&](scene::Feature feature) { return surface.features.contains(feature); };
    for (const auto& [knob, value] : surface.knobs) {
        if (knob == "lights" || knob == "shadowed_lights")
            return refused(fmt::format("the knob {} follows from the lights of the scene", knob));
        if (knob == "clip_tile" && value != "1" && has(scene::Feature::Silhouette))
            return refused(
                "the feature silhouette sets clip_tile to 1, and the knob is pinned to " + value);
    }
    if (surface.uniforms.contains("map_size"))
        return refused("map_size is the size of the surface's own map, in texels");
    const auto pinned = surface.parts.find("output");
    if (has(scene::Feature::Depth) && pinned != surface.parts.end())
        for (const auto& entry : work.catalogue.outputs)
            if (entry.name == pinned->second && !entry.make()->writes_depth())
                return refused(fmt::format(
                    "the feature depth needs an output that writes depth, and output={} is pinned",
                    entry.name));
    if (has(scene::Feature::Fur) && has(scene::Feature::Shadow) &&
        !surface.parts.contains("shadow"))
        return refused(
            "the feature fur lights hairs by their depth in place of a shadow: leave out fur or "
            "shadow, or pin a shadow");
    return Done{};
}

}  // namespace

Status check_pinned(const SurfaceWork& work) {
    if (Status status = check_conflicts(work); !status) return status;
    if (Status status = check_knobs_and_parts(work); !status) return status;
    return check_uniforms_and_loops(work);
}

}  // namespace intaglio::plan

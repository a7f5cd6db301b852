// Recording a surface: the composition of its techniques, stage by stage.
#include "generator/dsl/surface.h"

#include <fmt/format.h>

#include "generator/base/nearest.h"

namespace intaglio::dsl {
namespace {

// Both vectors arrive interpolated or from a caller, so neither is unit.
float3 unit_input(std::string_view name, std::string_view unit_name) {
    return let(unit_name, normalize(input<3>(name)));
}

float1 relief_scale() { return uniform<1>("scale", "depth of the relief in texture units"); }

Relief make_relief(const Surface& surface) {
    const bool packed = surface.relief->packed == 1;
    const sampler2D map =
        packed ? sampler2D("normal_map", "tangent-space normal in rgb, height in alpha")
               : sampler2D("height_map", "height in red: 1 is the polygon, 0 the deepest");
    const float2 map_size = uniform<2>("map_size", "size of the height map in texels");
    return {map, packed, relief_scale(), map_size, float1(surface.relief->level.value())};
}

Ray make_ray(const Surface& surface, const Relief& relief, float2 uv, float3 view) {
    if (surface.relief->ray_per_vertex == 0) return Ray::through(relief, uv, view);
    return {uv, view, input<2>("reach")};
}

Status check_techniques(const Surface& surface) {
    for (const Technique* technique : surface.techniques())
        if (Status status = technique->check(); !status) return status;
    return Done{};
}

// Applies schedules and the caller's overrides; gives whether any schedule moves work to the vertex
// stage.
bool apply_schedules(const Surface& surface, const RecordOptions& options, Recorder& recorder) {
    Schedule schedule(options.target);
    for (const Technique* technique : surface.techniques()) technique->schedule(schedule);
    schedule.apply(recorder);
    for (const auto& [loop, form] : options.loop_forms) recorder.override_loop_form(loop, form);
    return schedule.moves_to_vertex() || options.per_vertex;
}

float3 shade(const Surface& surface, const Relief& relief, const Hit& hit, float2 uv, float3 view,
             float3 light, float1 visibility) {
    Step step("shading",
              "Shade the point with its own normal and colour, read where the ray met the relief.");
    const Footprint footprint{let("ddx_uv", ddx(uv)), let("ddy_uv", ddy(uv))};
    const float3 normal = let("normal", surface.normal->normal(relief, hit, footprint));
    const sampler2D colour_map("colour_map", "albedo");
    const float3 albedo =
        let("albedo", colour_map.sample_grad(hit.uv, footprint.ddx_uv, footprint.ddy_uv).xyz());
    return surface.shading->shade({normal, view, light, albedo, visibility});
}

Status record_pixel(const Surface& surface, const RecordOptions& options, ir::Program& program) {
    Recorder recorder(program.pixel);
    program.per_vertex = apply_schedules(surface, options, recorder);

    const float2 uv = input<2>("uv");
    const float3 view = unit_input("to_eye", "view");
    const Relief relief = make_relief(surface);
    const auto search = [&] {
        Step step("search", "Where does the view ray meet the relief first?");
        return surface.search->find(relief, make_ray(surface, relief, uv, view));
    };
    const Hit hit = search();
    const float3 light = unit_input("to_light", "light");
    const auto shadow = [&] {
        Step step("shadow", "How much of the light reaches the point we see?");
        return let("visibility", surface.shadow->visibility(relief, hit, light));
    };
    const float1 visibility = shadow();
    const float3 colour = surface.output->shaded()
                              ? shade(surface, relief, hit, uv, view, light, visibility)
                              : float3(0.0f);
    const float4 value =
        let(surface.output->name(), surface.output->write(hit, visibility, colour));
    program.pixel.outputs = {{surface.output->name(), ir::float4, ir::Semantic::Target}};
    return recorder.finish({value.id()});
}

Status record_vertex(const Surface& surface, ir::Program& program) {
    Recorder recorder(program.vertex);
    const Vertex vertex = surface.vertex->transform();
    program.vertex.outputs = {{"position", ir::float4, ir::Semantic::Position},
                              {"uv", ir::float2, ir::Semantic::Interpolant},
                              {"to_eye", ir::float3, ir::Semantic::Interpolant},
                              {"to_light", ir::float3, ir::Semantic::Interpolant}};
    std::vector<ir::ValueId> values = {vertex.position.id(), vertex.uv.id(), vertex.to_eye.id(),
                                       vertex.to_light.id()};
    if (surface.relief->ray_per_vertex == 1) {
        program.vertex.outputs.push_back({"reach", ir::float2, ir::Semantic::Interpolant});
        const float3 view = let("view", normalize(vertex.to_eye));
        values.push_back(Ray::reach_of(relief_scale(), view).id());
    }
    return recorder.finish(values);
}

}  // namespace

std::vector<Technique*> Surface::techniques() const {
    std::vector<Technique*> all = {vertex.get(), relief.get(), search.get(), shadow.get()};
    if (output->shaded()) {
        all.push_back(normal.get());
        all.push_back(shading.get());
    }
    all.push_back(output.get());
    return all;
}

std::vector<KnobBase*> Surface::knobs() const {
    std::vector<KnobBase*> all;
    for (const Technique* technique : std::initializer_list<const Technique*>{
             relief.get(), search.get(), shadow.get(), normal.get(), shading.get(), output.get(),
             vertex.get()})
        all.insert(all.end(), technique->knobs().begin(), technique->knobs().end());
    return all;
}

Status Surface::set_knob(std::string_view knob_name, std::string_view value) {
    std::vector<std::string> names;
    for (KnobBase* knob : knobs()) {
        if (knob->name() == knob_name) return knob->set(value);
        names.push_back(knob->name());
    }
    return input_error("unknown-knob",
                       unknown_name_sentence(fmt::format("knob of {}", name), knob_name, names));
}

std::vector<std::string> Surface::settings() const {
    std::vector<std::string> all;
    for (const Technique* technique : techniques())
        for (const KnobBase* knob : technique->knobs()) all.push_back(knob->setting());
    return all;
}

Result<ir::Program> record_surface(const Surface& surface, const RecordOptions& options) {
    if (Status status = check_techniques(surface); !status) return status.error();
    ir::Program program;
    program.name = surface.name;
    program.description = surface.description;
    program.settings = surface.settings();
    program.vertex.name = program.pixel.name = surface.name;
    program.vertex.stage = ir::Stage::Vertex;
    program.pixel.stage = ir::Stage::Pixel;
    if (Status status = record_pixel(surface, options, program); !status) return status.error();
    if (Status status = record_vertex(surface, program); !status) return status.error();
    return program;
}

Result<ir::Program> record_function(const Surface& surface, FunctionPart part,
                                    const RecordOptions& options) {
    if (Status status = check_techniques(surface); !status) return status.error();
    ir::Program program;
    program.name = surface.name;
    program.description = surface.description;
    const Technique& technique = part == FunctionPart::Search
                                     ? static_cast<const Technique&>(*surface.search)
                                     : *surface.shadow;
    for (const Technique* used : {static_cast<const Technique*>(surface.relief.get()), &technique})
        for (const KnobBase* knob : used->knobs()) program.settings.push_back(knob->setting());
    ir::Module& module = program.pixel;
    module.stage = ir::Stage::Function;
    module.name = part == FunctionPart::Search ? "find" : "visibility";
    Recorder recorder(module);
    apply_schedules(surface, options, recorder);
    const float2 uv = input<2>("uv");
    if (part == FunctionPart::Search) {
        const float3 view = unit_input("view", "unit_view");
        const Relief relief = make_relief(surface);
        const Hit hit = surface.search->find(relief, make_ray(surface, relief, uv, view));
        const float3 result = let("result", float3(hit.uv, hit.height));
        module.outputs = {{"result", ir::float3, ir::Semantic::Result}};
        if (Status status = recorder.finish({result.id()}); !status) return status.error();
    } else {
        const float1 height = input<1>("height");
        const float3 light = unit_input("light", "unit_light");
        const Relief relief = make_relief(surface);
        const float1 result =
            let("result", surface.shadow->visibility(relief, {uv, height}, light));
        module.outputs = {{"result", ir::float1, ir::Semantic::Result}};
        if (Status status = recorder.finish({result.id()}); !status) return status.error();
    }
    return program;
}

}  // namespace intaglio::dsl

// A surface's techniques and knobs, and its parts as functions.
#include "generator/dsl/surface.h"

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "generator/dsl/surface_parts.h"

namespace intaglio::dsl {

std::vector<Technique*> Surface::techniques() const {
    std::vector<Technique*> all = {vertex.get(), relief.get(), lighting.get(), search.get(),
                                   shadow.get()};
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
             relief.get(), lighting.get(), search.get(), shadow.get(), normal.get(), shading.get(),
             output.get(), vertex.get()})
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
    for (const Technique* technique : techniques()) add_settings(*this, *technique, all);
    return all;
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
    const PolygonPoint from = polygon_point(surface, input<2>("uv"));
    if (part == FunctionPart::Search) {
        const float3 view = unit_input("view", "unit_view");
        const Relief relief = make_relief(surface);
        const Hit hit = surface.search->find(relief, make_ray(surface, relief, from, view));
        const float3 result = let("result", float3(from.continuous(hit).uv, hit.height));
        module.outputs = {{"result", ir::float3, ir::Semantic::Result}};
        if (Status status = recorder.finish({result.id()}); !status) return status.error();
    } else {
        const float1 height = input<1>("height");
        const float3 light = unit_input("light", "unit_light");
        const Relief relief = make_relief(surface);
        const float1 result =
            let("result", surface.shadow->visibility(relief, {from.local, height}, light));
        module.outputs = {{"result", ir::float1, ir::Semantic::Result}};
        if (Status status = recorder.finish({result.id()}); !status) return status.error();
    }
    return program;
}

}  // namespace intaglio::dsl

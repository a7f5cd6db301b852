// The vertex stage goes the pixel stage's way but for what its operands and outputs are.
#include "generator/target/d3d9/generate/vertex.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "generator/passes/pipeline.h"
#include "generator/passes/remove_dead_code.h"
#include "generator/passes/rewrite.h"
#include "generator/target/d3d9/generate/lower.h"

namespace intaglio::d3d9 {
namespace {

// Vertex shaders of model 2 read no textures, those of model 3 only at a level of their choice.
Status check_reads(const ir::Module& module, Profile profile) {
    Status status = Done{};
    passes::for_each_instruction(module.body, [&](const ir::Instruction& instruction) {
        if (!status || !ir::is_sample(instruction.op)) return;
        if (profile == Profile::vs_3_0 && instruction.op == ir::Op::SampleLevel) return;
        const std::string place = passes::place_of(module, instruction.origin);
        status = input_error(
            "d3d9-texture",
            fmt::format("{}{}{} cannot read {} {}", place, place.empty() ? "" : ": ",
                        name_of(profile),
                        module.samplers[static_cast<std::size_t>(instruction.slot)].name,
                        profile == Profile::vs_3_0
                            ? "without naming the level: vertices have no derivatives"
                            : "in the vertex stage: read it in the pixel stage, or use vs_3_0"));
    });
    return status;
}

// Attribute i is v#i; what nothing reads may be gone, and changes nobody's usage.
void name_attributes(const ir::Module& module, const ir::Module& recorded, Graph& graph) {
    const std::vector<AttributeUsage> usages = attribute_usages(recorded);
    for (const ir::Declaration& input : module.inputs) {
        const auto same = [&](const ir::Declaration& other) { return other.name == input.name; };
        const auto found = std::find_if(recorded.inputs.begin(), recorded.inputs.end(), same);
        graph.attributes.push_back(
            usages[static_cast<std::size_t>(found - recorded.inputs.begin())]);
        graph.inputs.push_back(
            {static_cast<int>(graph.inputs.size()), input.type.width, {0, 1, 2, 3}});
    }
}

// The outputs that are needed, one operand a register where signs agree.
class Outputs {
  public:
    Outputs(const ir::Module& module, const Graph& graph) : module_(module), from_(graph.outputs) {}

    void add_position() {
        for (std::size_t i = 0; i < from_.size(); ++i)
            if (module_.outputs[i].semantic == ir::Semantic::Position)
                add(from_[i], {position_output, 4, {0, 1, 2, 3}});
    }
    void add_interpolant(const Interpolant& interpolant) {
        for (std::size_t i = 0; i < from_.size(); ++i)
            if (module_.outputs[i].semantic == ir::Semantic::Interpolant &&
                module_.outputs[i].name == interpolant.name)
                add(from_[i], interpolant.place);
    }
    void give(Graph& graph) {
        graph.outputs = std::move(outputs_);
        graph.output_places = std::move(places_);
    }

  private:
    void add(const Operand& operand, const InterpolantPlace& place) {
        for (std::size_t k = 0; k < outputs_.size(); ++k) {
            if (places_[k].index != place.index || outputs_[k].negate != operand.negate) continue;
            for (std::size_t c = 0; c < operand.lanes.size(); ++c) {
                outputs_[k].lanes.push_back(operand.lanes[c]);
                places_[k].lanes[static_cast<std::size_t>(places_[k].width++)] = place.lanes[c];
            }
            return;
        }
        outputs_.push_back(operand);
        places_.push_back(place);
    }

    const ir::Module& module_;
    std::vector<Operand> from_, outputs_;
    std::vector<InterpolantPlace> places_;
};

}  // namespace

std::vector<AttributeUsage> attribute_usages(const ir::Module& vertex) {
    static const std::map<std::string, Usage, std::less<>> known = {
        {"position", Usage::Position},  {"normal", Usage::Normal}, {"tangent", Usage::Tangent},
        {"bitangent", Usage::Binormal}, {"color", Usage::Color},   {"colour", Usage::Color}};
    std::vector<AttributeUsage> usages;
    int texture_coordinates = 0;
    for (const ir::Declaration& input : vertex.inputs) {
        const auto found = known.find(input.name);
        if (found != known.end())
            usages.push_back({found->second, 0});
        else
            usages.push_back({Usage::Texcoord, texture_coordinates++});
    }
    return usages;
}

Result<Candidate> vertex_stage(const ir::Program& program, const ir::Module& recorded,
                               const std::vector<Interpolant>& interpolants, Profile profile) {
    ir::Module module = program.vertex;
    passes::PipelineOptions options;
    options.unroll_all = true;
    options.flatten_all = true;
    auto notes = passes::optimize(module, options);
    if (!notes) return notes.error();
    if (const Status status = check_reads(module, profile); !status) return status.error();
    auto graph = lower(module, profile, *notes);
    if (!graph) return graph.error();
    name_attributes(module, recorded, *graph);
    Outputs outputs(module, *graph);
    outputs.add_position();
    for (const Interpolant& interpolant : interpolants) outputs.add_interpolant(interpolant);
    outputs.give(*graph);
    legalize_for_vertex(*graph, profile);
    Candidate candidate = best_of(module, *graph, profile);
    if (!candidate.fits()) return refuse(program.name, candidate);
    candidate.notes = std::move(*notes);
    return candidate;
}

}  // namespace intaglio::d3d9

// Which packing and order of a block is best shows only when its registers have met those of the
// other blocks, so each block's alternatives are tried within the whole.
#include "generator/target/d3d9/generate/flow.h"

#include <algorithm>

#include "generator/target/d3d9/generate/finish.h"
#include "generator/target/d3d9/generate/flow_blocks.h"
#include "generator/target/d3d9/generate/flow_code.h"
#include "generator/target/d3d9/generate/least.h"
#include "generator/target/d3d9/generate/loop_rewrites.h"
#include "generator/target/d3d9/generate/lower.h"
#include "generator/target/d3d9/generate/pack.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

// How many placements the packing of one block may try.
int evaluations_for(const Graph& graph) {
    return static_cast<int>(5'000'000 / (graph.nodes.size() * graph.nodes.size() / 8 + 1000));
}

// One block's instructions, and what becomes of its outputs.
using Alternatives = std::vector<Code>;

class Joining {
  public:
    Joining(const ir::Module& module, Flow flow, Profile profile)
        : module_(module), flow_(std::move(flow)), profile_(profile) {}

    Result<Candidate> run(std::vector<std::string>& notes) {
        for (const FlowBlock& block : flow_.blocks) {
            auto graph = lower(block.module, profile_, notes);
            if (!graph) return graph.error();
            bind_variables(*graph, block);
            graphs_.push_back(std::move(*graph));
        }
        const Graph all = together();
        uniforms_ = assign_uniforms(module_, all, next_constant_);
        const Slots least = least_slots(graphs_, true);
        if (is_far_too_long(least, profile_)) return unpacked(module_, graphs_, profile_, least);
        for (const Graph& graph : graphs_) alternatives_.push_back(alternatives_of(graph));
        FlowCode best = best_choice();
        Candidate candidate;
        candidate.inputs = all.inputs;
        const bool fits = !is_hopeless(best) && assign_registers(best, limits_of(profile_).temps);
        candidate.shader = numbered(all, std::move(best));
        if (fits)
            candidate.violations = check(candidate.shader);
        else
            candidate.failure = AllocationFailure::Temps;
        return candidate;
    }

  private:
    void bind_variables(Graph& graph, const FlowBlock& block) const {
        graph.variables = static_cast<int>(flow_.widths.size());
        for (Node& node : graph.nodes)
            if (node.kind == Node::Kind::Input && node.slot >= flow_.inputs) {
                node.kind = Node::Kind::Variable;
                node.slot -= flow_.inputs;
            }
        graph.inputs = interpolant_places(module_, profile_);
        for (std::size_t k = 0; k < graph.outputs.size(); ++k) {
            InterpolantPlace place;
            place.index = static_cast<int>(k);
            place.width = static_cast<int>(graph.outputs[k].lanes.size());
            if (block.targets[k] >= 0)
                place.width = flow_.widths[static_cast<std::size_t>(block.targets[k])];
            graph.outputs[k].lanes.resize(static_cast<std::size_t>(place.width));
            graph.output_places.push_back(place);
        }
    }

    // All blocks as one graph: for what only asks which leaves there are.
    Graph together() const {
        Graph all;
        all.inputs = interpolant_places(module_, profile_);
        all.output_kinds = output_kinds_of(module_);
        for (const Graph& graph : graphs_) {
            const int shift = static_cast<int>(all.nodes.size());
            const auto shifted = [&](Operand operand) {
                for (Lane& lane : operand.lanes) lane.node += shift;
                return operand;
            };
            for (Node node : graph.nodes) {
                for (Operand& operand : node.operands) operand = shifted(operand);
                all.nodes.push_back(std::move(node));
            }
            for (const Operand& output : graph.outputs) all.outputs.push_back(shifted(output));
        }
        return all;
    }

    Alternatives alternatives_of(const Graph& graph) const {
        const Limits& limits = limits_of(profile_);
        std::vector<Graph> packings = {graph};
        for (std::vector<Graph>& plan : pack(graph, limits, uniforms_, evaluations_for(graph)))
            packings.push_back(std::move(plan.back()));
        Alternatives result;
        for (const Graph& packing : packings)
            for (const Order order : all_orders)
                result.push_back(place(packing, order_of(packing, order), limits, uniforms_));
        // The packed ones first: the start of the search.
        std::rotate(result.begin(), result.begin() + std::size(all_orders), result.end());
        Alternatives distinct;
        for (Code& code : result)
            if (std::none_of(distinct.begin(), distinct.end(),
                             [&](const Code& other) { return other == code; }))
                distinct.push_back(std::move(code));
        return distinct;
    }

    FlowCode best_choice() const {
        std::vector<std::size_t> choice(alternatives_.size());
        FlowCode best = joined(choice);
        if (is_hopeless(best)) return best;
        tidy(best);
        int trials = trials_for(best);
        for (bool improved = true; improved && trials > 0;) {
            improved = false;
            for (std::size_t b = 0; b < choice.size(); ++b)
                for (std::size_t k = 0; k < alternatives_[b].size() && trials-- > 0; ++k) {
                    std::vector<std::size_t> trial = choice;
                    trial[b] = k;
                    FlowCode code = joined(trial);
                    tidy(code);
                    if (slots_of(code) >= slots_of(best)) continue;
                    best = std::move(code);
                    choice = std::move(trial);
                    improved = true;
                }
        }
        return best;
    }
    // So long that nothing brings it within the limit.
    bool is_hopeless(const FlowCode& code) const {
        return slots_of(code) > 2 * limits_of(profile_).total_slots;
    }
    // How often the whole may be tidied: about a second's worth.
    static int trials_for(const FlowCode& code) {
        const std::size_t length = code.instructions.size() + 1;
        return static_cast<int>(2'000'000 / (length * length));
    }

    FlowCode joined(const std::vector<std::size_t>& choice) const {
        FlowCode code;
        code.outputs = static_cast<int>(module_.outputs.size());
        code.registers = code.outputs + static_cast<int>(flow_.widths.size());
        for (const ir::Sampler& sampler : module_.samplers)
            code.samplers.push_back(sampler.dimension == 3 ? SamplerKind::Volume
                                                           : SamplerKind::Texture2D);
        for (const FlowStep& step : flow_.steps) append(code, step, choice);
        return code;
    }

    void append(FlowCode& code, const FlowStep& step,
                const std::vector<std::size_t>& choice) const {
        VirtualInstruction flow;
        flow.origin = step.origin;
        switch (step.kind) {
            case FlowStep::Kind::Block: {
                const auto b = static_cast<std::size_t>(step.block);
                append_block(code, flow_.blocks[b], alternatives_[b][choice[b]]);
                return;
            }
            case FlowStep::Kind::Rep:
                flow.op = Opcode::Rep;
                flow.repeats = step.repeats;
                break;
            case FlowStep::Kind::EndRep: flow.op = Opcode::EndRep; break;
            case FlowStep::Kind::Break:
                flow.op = Opcode::BreakComp;
                flow.comparison = step.comparison;
                for (const int side : {step.left, step.right}) {
                    VirtualSource source;
                    source.index = code.outputs + side;
                    source.swizzle = replicate(0);
                    flow.sources.push_back(source);
                }
                break;
        }
        code.instructions.push_back(std::move(flow));
    }

    void append_block(FlowCode& code, const FlowBlock& block, const Code& placed) const {
        const int variables = static_cast<int>(flow_.widths.size());
        const int base = code.registers - variables;
        const auto renumber = [&](int index) {
            return index + (index < variables ? code.outputs : base);
        };
        code.registers += static_cast<int>(placed.lanes.size()) - variables;
        std::vector<VirtualInstruction> assignments;
        for (VirtualInstruction instruction : placed.instructions) {
            for (VirtualSource& source : instruction.sources)
                if (source.kind == VirtualSource::Kind::Temp) source.index = renumber(source.index);
            if (instruction.target >= 0) instruction.target = renumber(instruction.target);
            if (instruction.output >= 0) {
                const int target = block.targets[static_cast<std::size_t>(instruction.output)];
                instruction.output = -1;
                if (target < 0) {  // of the shader
                    instruction.target = -1 - target;
                } else {
                    // All at once: what one assignment overwrites another may read.
                    const int width = flow_.widths[static_cast<std::size_t>(target)];
                    instruction.mask = static_cast<Mask>((1 << width) - 1);
                    instruction.target = code.registers++;
                    VirtualInstruction assignment = instruction;
                    assignment.target = code.outputs + target;
                    assignment.sources = {VirtualSource{}};
                    assignment.sources[0].index = instruction.target;
                    assignments.push_back(std::move(assignment));
                }
            }
            code.instructions.push_back(std::move(instruction));
        }
        code.instructions.insert(code.instructions.end(), assignments.begin(), assignments.end());
    }

    // Registers are r# already, after the outputs.
    Shader numbered(const Graph& all, FlowCode from) const {
        Code code;
        code.lanes.assign(static_cast<std::size_t>(from.registers - from.outputs), full_mask);
        for (VirtualInstruction& instruction : from.instructions) {
            for (VirtualSource& source : instruction.sources)
                if (source.kind == VirtualSource::Kind::Temp) source.index -= from.outputs;
            if (instruction.target >= 0 && instruction.target < from.outputs)
                instruction.output = instruction.target;
            instruction.target -= from.outputs;
            code.instructions.push_back(std::move(instruction));
        }
        return finish_flow(module_, all, code, uniforms_, next_constant_, profile_);
    }

    const ir::Module& module_;
    Flow flow_;
    Profile profile_;
    std::vector<Graph> graphs_;
    std::vector<Alternatives> alternatives_;
    std::vector<int> uniforms_;
    int next_constant_ = 0;
};

}  // namespace

Result<Candidate> generate_flow(const ir::Module& module, Profile profile,
                                std::vector<std::string>& notes) {
    ir::Module split = module;
    form_saturations(split);
    rotate_loops(split);
    split_long_loops(split);
    auto flow = cut_into_blocks(split);
    if (!flow) return flow.error();
    return Joining(split, std::move(*flow), profile).run(notes);
}

}  // namespace intaglio::d3d9

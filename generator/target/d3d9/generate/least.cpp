// Common addends may leave a maximum, copies go, and in code with loops what only scales and shifts
// is fused: all that is not counted.
#include "generator/target/d3d9/generate/least.h"

namespace intaglio::d3d9 {
namespace {

bool may_vanish(const Node& node, bool tidied) {
    switch (node.op) {
        case Opcode::Mov: return !node.saturate || tidied;
        case Opcode::Add:
        case Opcode::Min:
        case Opcode::Max:
        case Opcode::Abs: return true;
        case Opcode::Mul:
        case Opcode::Mad: return tidied;
        default: return false;
    }
}

template <typename Visit>
void for_each_live(const Graph& graph, Visit&& visit) {
    for (const int index : order_of(graph, Order::Depth))
        visit(graph.nodes[static_cast<std::size_t>(index)]);
}

}  // namespace

Slots least_slots(const std::vector<Graph>& graphs, bool tidied) {
    Slots least;
    int lanes = 0;
    for (const Graph& graph : graphs)
        for_each_live(graph, [&](const Node& node) {
            if (!is_componentwise(node.op)) {
                least.arithmetic += info(node.op).arithmetic_slots;
                least.texture += info(node.op).texture_slots;
            } else if (!may_vanish(node, tidied)) {
                lanes += node.width;
            }
        });
    least.arithmetic += (lanes + 3) / 4;
    return least;
}

bool is_far_too_long(const Slots& least, Profile profile) {
    const Limits& limits = limits_of(profile);
    const auto far = [](int needed, int limit) { return needed / 3 * 2 > limit; };
    return far(least.arithmetic, limits.arithmetic_slots) ||
           far(least.texture, limits.texture_slots) || far(least.total(), limits.total_slots);
}

Candidate unpacked(const ir::Module& module, const std::vector<Graph>& graphs, Profile profile,
                   const Slots& least) {
    Candidate candidate;
    candidate.at_least = least;
    candidate.failure = AllocationFailure::Temps;
    Shader& shader = candidate.shader;
    shader.profile = profile;
    shader.files = module.files;
    shader.steps = module.steps;
    for (std::size_t i = 0; i < module.samplers.size(); ++i) {
        Constant sampler;
        sampler.name = module.samplers[i].name;
        sampler.set = Constant::Set::Sampler;
        sampler.index = static_cast<int>(i);
        shader.constants.push_back(sampler);
    }
    for (const Graph& graph : graphs)
        for_each_live(graph, [&](const Node& node) {
            Instruction instruction;
            instruction.op = node.op;
            instruction.origin = node.origin;
            instruction.destination = Destination{};
            instruction.sources.resize(static_cast<std::size_t>(info(node.op).sources));
            if (is_texture_read(node.op)) {
                instruction.sources[1].file = File::Sampler;
                instruction.sources[1].index = node.slot;
            }
            shader.instructions.push_back(std::move(instruction));
        });
    return candidate;
}

}  // namespace intaglio::d3d9

// A join is worth what placement says it is: whether operands fall into place or need moves depends
// on everything around them, so each candidate is placed and counted ("superword level
// parallelism", Larsen and Amarasinghe 2000, with measured in place of estimated gains).
#include "generator/target/d3d9/generate/pack.h"

#include <algorithm>

#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

bool commutes(Opcode op) {
    return op == Opcode::Add || op == Opcode::Mul || op == Opcode::Mad || op == Opcode::Min ||
           op == Opcode::Max;
}

bool may_join(const Node& a, const Node& b) {
    return a.kind == Node::Kind::Op && b.kind == Node::Kind::Op && !a.operands.empty() &&
           !b.operands.empty() && a.op == b.op && a.saturate == b.saturate &&
           is_componentwise(a.op) && a.width + b.width <= 4;
}

// Appends b to a; false if signs do not agree.
bool join(Graph& graph, int a, int b, bool swapped) {
    Node second = graph.nodes[static_cast<std::size_t>(b)];
    Node& first = graph.nodes[static_cast<std::size_t>(a)];
    if (swapped) std::swap(second.operands[0], second.operands[1]);
    for (std::size_t k = 0; k < first.operands.size(); ++k) {
        Operand& into = first.operands[k];
        Operand& from = second.operands[k];
        if (into.negate != from.negate) return false;
        into.lanes.insert(into.lanes.end(), from.lanes.begin(), from.lanes.end());
    }
    const int shift = first.width;
    first.width += second.width;
    graph.nodes[static_cast<std::size_t>(b)].operands.clear();
    const auto apply = [&](Operand& operand) {
        for (Lane& lane : operand.lanes)
            if (lane.node == b) lane = {a, lane.component + shift};
    };
    for (Node& node : graph.nodes)
        for (Operand& operand : node.operands) apply(operand);
    for (Operand& output : graph.outputs) apply(output);
    return true;
}

}  // namespace

int cost_of(const Graph& graph, const Limits& limits, const std::vector<int>& uniform_registers) {
    const std::vector<int> order = order_of(graph, Order::Heavy);
    if (order.empty()) return 1 << 20;
    int slots = 0;
    for (const VirtualInstruction& instruction :
         place(graph, order, limits, uniform_registers).instructions)
        slots += info(instruction.op).arithmetic_slots;
    return slots;
}

std::vector<Graph> pack(const Graph& graph, const Limits& limits,
                        const std::vector<int>& uniform_registers, int evaluations) {
    std::vector<Graph> steps = {graph};
    int cost = cost_of(graph, limits, uniform_registers);
    for (bool changed = true; changed && evaluations > 0;) {
        changed = false;
        const int count = static_cast<int>(graph.nodes.size());
        for (int a = 0; a < count; ++a)
            for (int b = 0; b < count; ++b) {
                const Graph& current = steps.back();
                if (a == b || evaluations <= 0) continue;
                const Node& first = current.nodes[static_cast<std::size_t>(a)];
                if (!may_join(first, current.nodes[static_cast<std::size_t>(b)])) continue;
                for (int swapped = 0; swapped < (commutes(first.op) ? 2 : 1); ++swapped) {
                    Graph trial = current;
                    if (!join(trial, a, b, swapped != 0)) continue;
                    --evaluations;
                    const int price = cost_of(trial, limits, uniform_registers);
                    if (price >= cost) continue;
                    cost = price;
                    steps.push_back(std::move(trial));
                    changed = true;
                    break;
                }
            }
    }
    return steps;
}

}  // namespace intaglio::d3d9

// A join is worth what placement says it is: whether operands fall into place or need moves depends
// on everything around them, so each candidate is placed and counted ("superword level
// parallelism", Larsen and Amarasinghe 2000, with measured in place of estimated gains).
#include "generator/target/d3d9/generate/pack.h"

#include <algorithm>

#include "generator/target/d3d9/generate/lower.h"
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

// Where a component is bound to lie, whatever placement does: texels, inputs and uniforms.
bool is_bound(const Node& node) {
    return node.kind == Node::Kind::Input || node.kind == Node::Kind::Uniform ||
           (node.kind == Node::Kind::Op && is_texture_read(node.op));
}
// Joined operands from two such places would have to be moved together, which saves nothing.
bool is_hopeless(const Graph& graph, const Operand& a, const Operand& b) {
    for (const Lane x : a.lanes)
        for (const Lane y : b.lanes)
            if (x.node != y.node && is_bound(graph.node(x)) && is_bound(graph.node(y))) return true;
    return false;
}

// Appends b to a; false if signs do not agree.
bool join(Graph& graph, int a, int b, bool swapped) {
    Node second = graph.nodes[static_cast<std::size_t>(b)];
    Node& first = graph.nodes[static_cast<std::size_t>(a)];
    if (swapped) std::swap(second.operands[0], second.operands[1]);
    for (std::size_t k = 0; k < first.operands.size(); ++k) {
        Operand& into = first.operands[k];
        Operand& from = second.operands[k];
        if (into.negate != from.negate || is_hopeless(graph, into, from)) return false;
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
    Code code = place(graph, order, limits, uniform_registers);
    if (limits.pixel()) coalesce(code);
    for (const VirtualInstruction& instruction : code.instructions)
        slots += info(instruction.op).arithmetic_slots;
    return slots;
}

namespace {

// Which instructions one sweep joins, and in which order it looks at them.
struct Sweep {
    std::uint64_t ops;  // bit: Opcode
    bool backwards = false;
};
constexpr std::uint64_t op_bit(Opcode op) { return std::uint64_t{1} << static_cast<unsigned>(op); }
constexpr std::uint64_t choices = op_bit(Opcode::Cmp);
constexpr std::uint64_t extremes = op_bit(Opcode::Max) | op_bit(Opcode::Min);
constexpr std::uint64_t everything = ~std::uint64_t{0};

class Packing {
  public:
    Packing(const Graph& graph, const Limits& limits, const std::vector<int>& uniform_registers,
            int evaluations)
        : limits_(limits),
          uniforms_(uniform_registers),
          most_(evaluations),
          steps_{graph},
          cost_(cost_of(graph, limits, uniform_registers)) {}

    void sweep(const Sweep& how) {
        evaluations_ = most_;
        const int count = static_cast<int>(steps_.back().nodes.size());
        for (bool changed = true; changed;) {
            changed = false;
            for (int a = 0; a < count; ++a)
                for (int b = a + 1; b < count; ++b)
                    changed = try_pair(how.backwards ? count - 1 - a : a,
                                       how.backwards ? count - 1 - b : b, how.ops) ||
                              changed;
        }
    }
    std::vector<Graph> take() { return std::move(steps_); }

  private:
    bool try_pair(int a, int b, std::uint64_t ops) {
        const Node& first = steps_.back().nodes[static_cast<std::size_t>(a)];
        if (a == b || evaluations_ <= 0 || (ops & op_bit(first.op)) == 0 ||
            !may_join(first, steps_.back().nodes[static_cast<std::size_t>(b)]))
            return false;
        for (int swapped = 0; swapped < (commutes(first.op) ? 2 : 1); ++swapped) {
            Graph trial = steps_.back();
            if (!join(trial, a, b, swapped != 0)) continue;
            --evaluations_;
            const int price = cost_of(trial, limits_, uniforms_);
            if (price >= cost_) continue;
            cost_ = price;
            steps_.push_back(std::move(trial));
            return true;
        }
        return false;
    }

    const Limits& limits_;
    const std::vector<int>& uniforms_;
    int most_, evaluations_ = 0;
    std::vector<Graph> steps_;
    int cost_;
};

// Greedy joining depends on its order: which comes first decides what still fits together.
const std::vector<Sweep> plans[] = {
    {{choices}, {extremes}, {everything}},
    {{choices, true}, {extremes, true}, {everything, true}},
    {{everything}},
};

// The cheapest of the graph and what rewriting it whole gives.
Graph best_start(const Graph& graph, const Limits& limits,
                 const std::vector<int>& uniform_registers) {
    std::vector<Graph> starts = {graph};
    for (Graph& wide : with_wide_output(graph)) starts.push_back(std::move(wide));
    const std::size_t count = starts.size();
    for (std::size_t i = 0; i < count; ++i) starts.push_back(with_wide_reductions(starts[i]));
    std::size_t best = 0;
    int least = 0;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const int cost = cost_of(starts[i], limits, uniform_registers);
        if (i > 0 && cost >= least) continue;
        least = cost;
        best = i;
    }
    return std::move(starts[best]);
}

}  // namespace

std::vector<std::vector<Graph>> pack(const Graph& graph, const Limits& limits,
                                     const std::vector<int>& uniform_registers, int evaluations) {
    const Graph start = best_start(graph, limits, uniform_registers);
    std::vector<std::vector<Graph>> result;
    for (const std::vector<Sweep>& plan : plans) {
        Packing packing(start, limits, uniform_registers, evaluations);
        for (const Sweep& sweep : plan) packing.sweep(sweep);
        result.push_back(packing.take());
    }
    return result;
}

}  // namespace intaglio::d3d9

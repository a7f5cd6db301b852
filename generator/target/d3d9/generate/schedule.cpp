// Orders in which a graph's instructions may be written.  Few registers are live if each value is
// computed just before its use, the operand that needs more registers first (Sethi and Ullman, "The
// Generation of Optimal Code for Arithmetic Expressions", 1970).
#include <algorithm>

#include "generator/target/d3d9/generate/graph.h"

namespace intaglio::d3d9 {

bool is_scalar(Opcode op) {
    return op == Opcode::Rcp || op == Opcode::Rsq || op == Opcode::Exp || op == Opcode::Log;
}
bool is_dot(Opcode op) { return op == Opcode::Dp3 || op == Opcode::Dp4; }
bool is_texture_read(Opcode op) {
    return op == Opcode::Texld || op == Opcode::Texldd || op == Opcode::Texldl;
}
bool is_componentwise(Opcode op) {
    switch (op) {
        case Opcode::Mov:
        case Opcode::Add:
        case Opcode::Mul:
        case Opcode::Mad:
        case Opcode::Min:
        case Opcode::Max:
        case Opcode::Cmp:
        case Opcode::Slt:
        case Opcode::Sge:
        case Opcode::Frc:
        case Opcode::Abs: return true;
        default: return false;
    }
}

std::vector<int> count_users(const Graph& graph) {
    std::vector<int> users(graph.nodes.size());
    const auto count = [&](const Operand& operand) {
        std::vector<int> seen;
        for (const Lane lane : operand.lanes) {
            if (std::find(seen.begin(), seen.end(), lane.node) != seen.end()) continue;
            seen.push_back(lane.node);
            ++users[static_cast<std::size_t>(lane.node)];
        }
    };
    for (const Node& node : graph.nodes)
        for (const Operand& operand : node.operands) count(operand);
    for (const Operand& output : graph.outputs) count(output);
    return users;
}

namespace {

class Sort {
  public:
    Sort(const Graph& graph, Order order)
        : graph_(graph), order_(order), state_(graph.nodes.size()), weight_(graph.nodes.size()) {}

    std::vector<int> run() {
        // Weighing what is cyclic takes long.
        if (order_ == Order::Heavy && Sort(graph_, Order::Depth).run().empty()) return {};
        for (const Operand& output : graph_.outputs) visit_all(output);
        if (cyclic_) return {};
        if (order_ == Order::Source) return by_source();
        return sorted_;
    }

  private:
    enum : char { New, Open, Done };

    void visit_all(const Operand& operand) {
        for (const Lane lane : operand.lanes) visit(lane.node);
    }

    void visit(int index) {
        const auto i = static_cast<std::size_t>(index);
        const Node& node = graph_.nodes[i];
        if (node.kind != Node::Kind::Op || state_[i] == Done || cyclic_) return;
        if (state_[i] == Open) {
            cyclic_ = true;
            return;
        }
        state_[i] = Open;
        for (const int child : children(node)) visit(child);
        state_[i] = Done;
        sorted_.push_back(index);
    }

    std::vector<int> children(const Node& node) {
        std::vector<int> list;
        for (const Operand& operand : node.operands)
            for (const Lane lane : operand.lanes)
                if (graph_.node(lane).kind == Node::Kind::Op &&
                    std::find(list.begin(), list.end(), lane.node) == list.end())
                    list.push_back(lane.node);
        if (order_ == Order::DepthReverse) std::reverse(list.begin(), list.end());
        if (order_ == Order::Heavy)
            std::stable_sort(list.begin(), list.end(),
                             [&](int a, int b) { return weight(a) > weight(b); });
        return list;
    }

    // Registers that a tree of this root would need; shared nodes count as trees.
    int weight(int index, int depth = 0) {
        const auto i = static_cast<std::size_t>(index);
        if (weight_[i] != 0) return weight_[i];
        if (depth > 2000) return 1;  // a cycle, found by visit()
        std::vector<int> needs;
        for (const Operand& operand : graph_.nodes[i].operands)
            for (const Lane lane : operand.lanes)
                if (graph_.node(lane).kind == Node::Kind::Op)
                    needs.push_back(weight(lane.node, depth + 1));
        std::sort(needs.rbegin(), needs.rend());
        int result = 1;
        for (std::size_t k = 0; k < needs.size(); ++k)
            result = std::max(result, needs[k] + (k < 2 ? static_cast<int>(k) : 1));
        return weight_[i] = result;
    }

    // Smallest index first among those whose operands are done.
    std::vector<int> by_source() {
        std::vector<int> rest = sorted_, result;
        std::sort(rest.begin(), rest.end());
        std::vector<char> done(graph_.nodes.size());
        while (!rest.empty()) {
            const auto ready = std::find_if(rest.begin(), rest.end(), [&](int index) {
                for (const Operand& operand :
                     graph_.nodes[static_cast<std::size_t>(index)].operands)
                    for (const Lane lane : operand.lanes)
                        if (graph_.node(lane).kind == Node::Kind::Op &&
                            done[static_cast<std::size_t>(lane.node)] == 0)
                            return false;
                return true;
            });
            if (ready == rest.end()) return {};
            done[static_cast<std::size_t>(*ready)] = 1;
            result.push_back(*ready);
            rest.erase(ready);
        }
        return result;
    }

    const Graph& graph_;
    Order order_;
    std::vector<char> state_;
    std::vector<int> weight_;
    std::vector<int> sorted_;
    bool cyclic_ = false;
};

}  // namespace

std::vector<int> order_of(const Graph& graph, Order order) { return Sort(graph, order).run(); }

}  // namespace intaglio::d3d9

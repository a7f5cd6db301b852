// Algebra that saves slots where its pattern occurs; each rule changes rounding alone.
#include <algorithm>
#include <optional>

#include "generator/target/d3d9/generate/lower.h"

namespace intaglio::d3d9 {
namespace {

class Rules {
  public:
    explicit Rules(Graph& graph) : graph_(graph), users_(count_users(graph)) {}

    void run() {
        // Nodes that rules add are done already.
        const std::size_t count = graph_.nodes.size();
        for (std::size_t i = 0; i < count; ++i) {
            constant_difference(static_cast<int>(i));
            constant_last(static_cast<int>(i));
            common_term_of_choice(static_cast<int>(i));
            difference_to_choice(static_cast<int>(i));
            common_factor(static_cast<int>(i));
        }
    }

  private:
    Node& at(int index) { return graph_.nodes[static_cast<std::size_t>(index)]; }
    int add(Node node) {
        graph_.nodes.push_back(std::move(node));
        users_.push_back(1);
        return static_cast<int>(graph_.nodes.size()) - 1;
    }
    bool is_op(int index, Opcode op) {
        const Node& node = at(index);
        return node.kind == Node::Kind::Op && node.op == op && !node.saturate &&
               !node.operands.empty();
    }
    // The node that alone gives the operand, component for component; of own() nothing else reads
    // it.
    int own(const Operand& operand, Opcode op) {
        const int index = whole(operand, op);
        return index >= 0 && users_[static_cast<std::size_t>(index)] == 1 ? index : -1;
    }
    int whole(const Operand& operand, Opcode op) {
        const int index = operand.lanes[0].node;
        if (!is_op(index, op)) return -1;
        if (at(index).width != static_cast<int>(operand.lanes.size())) return -1;
        for (std::size_t k = 0; k < operand.lanes.size(); ++k)
            if (operand.lanes[k] != Lane{index, static_cast<int>(k)}) return -1;
        return index;
    }
    bool is_constant(const Operand& operand) const {
        return std::all_of(operand.lanes.begin(), operand.lanes.end(), [&](Lane lane) {
            return graph_.node(lane).kind == Node::Kind::Constant;
        });
    }
    bool is_uniform(const Operand& operand) const {
        return std::all_of(operand.lanes.begin(), operand.lanes.end(), [&](Lane lane) {
            return graph_.node(lane).kind == Node::Kind::Uniform;
        });
    }
    // With the other sign, if so; constants take theirs in.
    Operand signed_by(Operand operand, bool flip) {
        operand.negate = operand.negate != flip;
        if (!operand.negate || !is_constant(operand)) return operand;
        operand.negate = false;
        for (Lane& lane : operand.lanes) lane = {constant(graph_.node(lane).bits ^ 0x80000000u), 0};
        return operand;
    }
    int constant(std::uint32_t bits) {
        for (std::size_t i = 0; i < graph_.nodes.size(); ++i)
            if (graph_.nodes[i].kind == Node::Kind::Constant && graph_.nodes[i].bits == bits)
                return static_cast<int>(i);
        Node node;
        node.kind = Node::Kind::Constant;
        node.bits = bits;
        return add(std::move(node));
    }

    // x - (x + c) = -c
    void constant_difference(int index) {
        if (!is_op(index, Opcode::Add) || at(index).width != 1) return;
        for (std::size_t side = 0; side < 2; ++side) {
            const Operand inner = at(index).operands[side], x = at(index).operands[1 - side];
            const int sum = whole(inner, Opcode::Add);
            if (sum < 0 || inner.negate == x.negate) continue;
            for (std::size_t k = 0; k < 2; ++k) {
                const Operand c = at(sum).operands[k], y = at(sum).operands[1 - k];
                if (!is_constant(c) || y.lanes != x.lanes || y.negate) continue;
                replace(index, signed_by(c, inner.negate).lanes[0]);
                return;
            }
        }
    }
    // Everything that reads the node reads the other instead.
    void replace(int index, Lane other) {
        const auto apply = [&](Operand& operand) {
            for (Lane& lane : operand.lanes)
                if (lane.node == index) lane = other;
        };
        for (Node& node : graph_.nodes)
            for (Operand& operand : node.operands) apply(operand);
        for (Operand& output : graph_.outputs) apply(output);
    }

    // x + s (y + c) = (x + s y) + s c: the constant moves out, to meet others.
    void constant_last(int index) {
        if (!is_op(index, Opcode::Add)) return;
        for (std::size_t side = 0; side < 2; ++side) {
            const Operand inner = at(index).operands[side], x = at(index).operands[1 - side];
            const int sum = own(inner, Opcode::Add);
            if (sum < 0 || is_constant(x)) continue;
            for (std::size_t k = 0; k < 2; ++k) {
                const Operand c = at(sum).operands[k], y = at(sum).operands[1 - k];
                if (!is_constant(c) || is_constant(y)) continue;
                at(sum).operands = {x, signed_by(y, inner.negate)};
                at(index).operands = {{inner.lanes, false}, signed_by(c, inner.negate)};
                return;
            }
        }
    }

    // g >= 0 ? x + c : y + c  =  (g >= 0 ? x : y) + c
    void common_term_of_choice(int index) {
        if (!is_op(index, Opcode::Cmp)) return;
        const Node choice = at(index);
        if (choice.operands[1].negate || choice.operands[2].negate) return;
        const int a = own(choice.operands[1], Opcode::Add),
                  b = own(choice.operands[2], Opcode::Add);
        if (a < 0 || b < 0) return;
        for (std::size_t i = 0; i < 2; ++i)
            for (std::size_t k = 0; k < 2; ++k) {
                const Operand c = at(a).operands[i];
                if (!is_constant(c) || c != at(b).operands[k]) continue;
                Node inner = choice;
                inner.operands[1] = at(a).operands[1 - i];
                inner.operands[2] = at(b).operands[1 - k];
                Operand chosen;
                const int made = add(std::move(inner));
                for (int j = 0; j < choice.width; ++j) chosen.lanes.push_back({made, j});
                at(index).op = Opcode::Add;
                at(index).operands = {chosen, c};
                return;
            }
    }

    // x - (g >= 0 ? x : y) = g >= 0 ? 0 : a - b for x = a + c and y = b + c
    void difference_to_choice(int index) {
        if (!is_op(index, Opcode::Add)) return;
        for (std::size_t side = 0; side < 2; ++side) {
            const Operand chosen = at(index).operands[side], x = at(index).operands[1 - side];
            const int choice = own(chosen, Opcode::Cmp);
            if (choice < 0 || !chosen.negate || x.negate) continue;
            for (std::size_t same : {1u, 2u}) {
                if (at(choice).operands[same] != x) continue;
                const Operand y = at(choice).operands[3 - same];
                const auto difference = difference_of_sums(x, y);
                if (!difference) continue;
                const Operand zero{std::vector<Lane>(x.lanes.size(), Lane{constant(0), 0}), false};
                Node result = at(choice);
                result.operands[same] = zero;
                result.operands[3 - same] = *difference;
                at(index).op = Opcode::Cmp;
                at(index).operands = result.operands;
                return;
            }
        }
    }
    // x - y where both are sums with a term in common, y read here alone.
    std::optional<Operand> difference_of_sums(const Operand& x, const Operand& y) {
        const int first = whole(x, Opcode::Add), second = own(y, Opcode::Add);
        if (first < 0 || second < 0 || y.negate) return std::nullopt;
        for (std::size_t i = 0; i < 2; ++i)
            for (std::size_t k = 0; k < 2; ++k) {
                if (at(first).operands[i] != at(second).operands[k]) continue;
                Node difference = at(second);
                difference.operands = {at(first).operands[1 - i],
                                       signed_by(at(second).operands[1 - k], true)};
                const int made = add(std::move(difference));
                Operand result;
                for (int j = 0; j < at(made).width; ++j) result.lanes.push_back({made, j});
                return result;
            }
        return std::nullopt;
    }

    // x (u d + v) + u s = u (x d + s) + x v for uniforms u and v, which no instruction may read
    // both.
    void common_factor(int index) {
        if (!is_op(index, Opcode::Mad)) return;
        const Node outer = at(index);
        const int tail = own(outer.operands[2], Opcode::Mul);
        if (tail < 0 || outer.operands[2].negate) return;
        for (std::size_t side = 0; side < 2; ++side) {
            const Operand factor = outer.operands[side], x = outer.operands[1 - side];
            const int inner = own(factor, Opcode::Mad);
            if (inner < 0 || factor.negate || !is_uniform(at(inner).operands[2])) continue;
            for (std::size_t i = 0; i < 2; ++i)
                for (std::size_t k = 0; k < 2; ++k) {
                    const Operand u = at(inner).operands[i];
                    if (!is_uniform(u) || u != at(tail).operands[k]) continue;
                    const Operand d = at(inner).operands[1 - i], v = at(inner).operands[2];
                    const Operand s = at(tail).operands[1 - k];
                    at(inner).operands = {x, d, s};
                    at(tail).operands = {x, v};
                    at(index).operands = {u, {factor.lanes, false}, outer.operands[2]};
                    return;
                }
        }
    }

    Graph& graph_;
    std::vector<int> users_;
};

}  // namespace

void reassociate(Graph& graph) { Rules(graph).run(); }

}  // namespace intaglio::d3d9

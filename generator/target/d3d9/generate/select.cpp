// Peepholes on the graph: a product that is added becomes part of a mad, a clamp becomes _sat.
#include <algorithm>

#include "generator/target/d3d9/generate/lower.h"

namespace intaglio::d3d9 {
namespace {

// Every operand that reads `from` reads `to` instead: component k of the one is components[k] of
// the other.
void redirect(Graph& graph, int from, int to, const std::vector<int>& components) {
    const auto apply = [&](Operand& operand) {
        for (Lane& lane : operand.lanes)
            if (lane.node == from)
                lane = {to, components[static_cast<std::size_t>(lane.component)]};
    };
    for (Node& node : graph.nodes)
        for (Operand& operand : node.operands) apply(operand);
    for (Operand& output : graph.outputs) apply(output);
}

// The one node that all components come from, or -1.
int single_source(const Operand& operand) {
    for (const Lane lane : operand.lanes)
        if (lane.node != operand.lanes[0].node) return -1;
    return operand.lanes[0].node;
}

bool takes_sign(Opcode op) {
    return op == Opcode::Mul || op == Opcode::Add || op == Opcode::Mad || op == Opcode::Mov;
}
void negate_result(Node& node) {
    const auto flip = [&](std::size_t k) { node.operands[k].negate = !node.operands[k].negate; };
    flip(0);
    if (node.op == Opcode::Add) flip(1);
    if (node.op == Opcode::Mad) flip(2);
}

void form_saturations(Graph& graph) {
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
        const Node node = graph.nodes[i];
        if (node.kind != Node::Kind::Op || node.op != Opcode::Mov || !node.saturate) continue;
        const int source = single_source(node.operands[0]);
        if (source < 0) continue;
        Node& computed = graph.nodes[static_cast<std::size_t>(source)];
        if (computed.kind != Node::Kind::Op || is_texture_read(computed.op) || computed.saturate)
            continue;
        if (count_users(graph)[static_cast<std::size_t>(source)] != 1) continue;
        if (node.operands[0].negate) {
            if (!takes_sign(computed.op)) continue;
            negate_result(computed);
        }
        computed.saturate = true;
        std::vector<int> components;
        for (const Lane lane : node.operands[0].lanes) components.push_back(lane.component);
        graph.nodes[i].operands.clear();
        redirect(graph, static_cast<int>(i), source, components);
    }
}

void form_mads(Graph& graph) {
    const std::vector<int> users = count_users(graph);
    for (Node& node : graph.nodes) {
        if (node.kind != Node::Kind::Op || node.op != Opcode::Add) continue;
        int chosen = -1;
        for (int side = 0; side < 2; ++side) {
            const int source = single_source(node.operands[static_cast<std::size_t>(side)]);
            if (source < 0) continue;
            const Node& product = graph.nodes[static_cast<std::size_t>(source)];
            if (product.kind != Node::Kind::Op || product.op != Opcode::Mul || product.saturate)
                continue;
            // The product that fewer read is the likelier to vanish.
            if (chosen >= 0 &&
                users[static_cast<std::size_t>(source)] >=
                    users[static_cast<std::size_t>(
                        node.operands[static_cast<std::size_t>(chosen)].lanes[0].node)])
                continue;
            chosen = side;
        }
        if (chosen < 0) continue;
        const Operand product = node.operands[static_cast<std::size_t>(chosen)];
        const Operand other = node.operands[static_cast<std::size_t>(1 - chosen)];
        const Node& mul = graph.node(product.lanes[0]);
        Operand a{{}, mul.operands[0].negate != product.negate}, b{{}, mul.operands[1].negate};
        for (const Lane lane : product.lanes) {
            a.lanes.push_back(mul.operands[0].lanes[static_cast<std::size_t>(lane.component)]);
            b.lanes.push_back(mul.operands[1].lanes[static_cast<std::size_t>(lane.component)]);
        }
        node.op = Opcode::Mad;
        node.operands = {a, b, other};
    }
}

}  // namespace

void drop_dead(Graph& graph) {
    std::vector<char> live(graph.nodes.size());
    for (const int index : order_of(graph, Order::Depth)) live[static_cast<std::size_t>(index)] = 1;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i)
        if (live[i] == 0) graph.nodes[i].operands.clear();
}

void simplify(Graph& graph) {
    form_mads(graph);
    drop_dead(graph);
    // A second time for what the first brings together.
    for (int round = 0; round < 2; ++round) {
        reassociate(graph);
        drop_dead(graph);
    }
    form_saturations(graph);
    drop_dead(graph);
}

}  // namespace intaglio::d3d9

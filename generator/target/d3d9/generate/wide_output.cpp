// Components of an output that are factor * x + term for one x, as one instruction: the value
// itself is 1 x + 0, a constant is 0 x + c.
#include <algorithm>
#include <bit>
#include <optional>

#include "generator/target/d3d9/generate/lower.h"

namespace intaglio::d3d9 {
namespace {

struct Affine {
    Lane x;
    float factor = 1, term = 0;
};

class Widening {
  public:
    explicit Widening(Graph& graph) : graph_(graph), users_(count_users(graph)) {}

    // Each x that gives two components or more.
    std::vector<Lane> sources(const Operand& output) const {
        std::vector<Lane> found;
        for (const Lane lane : output.lanes)
            for (const Affine& form : forms_of(lane))
                if (std::find(found.begin(), found.end(), form.x) == found.end() &&
                    components_of(output, form.x).size() >= 2)
                    found.push_back(form.x);
        return found;
    }
    void compute(Operand& output, Lane x) { compute(output, components_of(output, x), x); }

  private:
    std::optional<float> number_of(const Operand& operand) const {
        const Node& node = graph_.node(operand.lanes[0]);
        if (node.kind != Node::Kind::Constant) return std::nullopt;
        const float number = std::bit_cast<float>(node.bits);
        return operand.negate ? -number : number;
    }
    static Affine signed_form(const Operand& x, float factor, float term) {
        return {x.lanes[0], x.negate ? -factor : factor, term};
    }

    // What the component is of what it is computed from, and of itself.
    std::vector<Affine> forms_of(Lane lane) const {
        const Node& node = graph_.node(lane);
        if (node.kind == Node::Kind::Constant) return {};
        std::vector<Affine> forms = {{lane, 1, 0}};
        if (node.kind != Node::Kind::Op || node.width != 1 || node.saturate ||
            users_[static_cast<std::size_t>(lane.node)] != 1)
            return forms;
        for (std::size_t side = 0; side < 2 && node.operands.size() >= 2; ++side) {
            const Operand& x = node.operands[side];
            const auto number = number_of(node.operands[1 - side]);
            if (!number || number_of(x)) continue;
            if (node.op == Opcode::Add) forms.push_back(signed_form(x, 1, *number));
            if (node.op == Opcode::Mul) forms.push_back(signed_form(x, *number, 0));
            if (node.op != Opcode::Mad) continue;
            if (const auto term = number_of(node.operands[2]))
                forms.push_back(signed_form(x, *number, *term));
        }
        return forms;
    }
    std::optional<Affine> form_of(Lane lane, Lane x) const {
        const Node& node = graph_.node(lane);
        if (node.kind == Node::Kind::Constant) return Affine{x, 0, std::bit_cast<float>(node.bits)};
        for (const Affine& form : forms_of(lane))
            if (form.x == x) return form;
        return std::nullopt;
    }
    std::vector<std::size_t> components_of(const Operand& output, Lane x) const {
        std::vector<std::size_t> components;
        for (std::size_t k = 0; k < output.lanes.size(); ++k)
            if (form_of(output.lanes[k], x)) components.push_back(k);
        return components;
    }

    Lane constant(float number) {
        Node node;
        node.kind = Node::Kind::Constant;
        node.bits = std::bit_cast<std::uint32_t>(number);
        const auto same = [&](const Node& other) {
            return other.kind == Node::Kind::Constant && other.bits == node.bits;
        };
        const auto found = std::find_if(graph_.nodes.begin(), graph_.nodes.end(), same);
        const auto index = static_cast<int>(found - graph_.nodes.begin());
        if (found == graph_.nodes.end()) graph_.nodes.push_back(node);
        return {index, 0};
    }

    void compute(Operand& output, const std::vector<std::size_t>& components, Lane x) {
        Node node;
        node.op = Opcode::Mad;
        node.width = static_cast<int>(components.size());
        node.operands.resize(3);
        for (const std::size_t k : components) {
            const Lane lane = output.lanes[k];
            const Affine form = *form_of(lane, x);
            node.operands[0].lanes.push_back(x);
            node.operands[1].lanes.push_back(constant(form.factor));
            node.operands[2].lanes.push_back(constant(form.term));
            if (graph_.node(lane).kind == Node::Kind::Op && lane != x)
                node.origin = graph_.node(lane).origin;
        }
        if (node.origin.file < 0) node.origin = graph_.node(x).origin;
        graph_.nodes.push_back(std::move(node));
        const int index = static_cast<int>(graph_.nodes.size()) - 1;
        for (std::size_t i = 0; i < components.size(); ++i)
            output.lanes[components[i]] = {index, static_cast<int>(i)};
    }

    Graph& graph_;
    const std::vector<int> users_;
};

}  // namespace

std::vector<Graph> with_wide_output(const Graph& graph) {
    std::vector<Graph> results;
    for (std::size_t k = 0; k < graph.outputs.size(); ++k) {
        if (graph.outputs[k].negate) continue;
        Graph trial = graph;
        for (const Lane x : Widening(trial).sources(graph.outputs[k])) {
            Graph result = graph;
            Widening(result).compute(result.outputs[k], x);
            drop_dead(result);
            results.push_back(std::move(result));
        }
    }
    return results;
}

}  // namespace intaglio::d3d9

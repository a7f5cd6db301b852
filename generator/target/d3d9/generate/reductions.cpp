// A maximum of many scalars is the maximum of a few vectors, then of one vector's components: n
// alike terms take n / 4 instructions, n / 4 - 1 maxima of vectors and two within the last one.
// The pairwise joining of pack() finds this only for few terms.
#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "generator/target/d3d9/generate/lower.h"
#include "generator/target/d3d9/generate/pack.h"

namespace intaglio::d3d9 {
namespace {

constexpr std::size_t register_width = 4;

using Lanes = std::vector<Lane>;

class Reduction {
  public:
    Reduction(Graph& graph, const std::vector<int>& users, int root)
        : graph_(graph), users_(users), op_(at(root).op), origin_(at(root).origin) {
        collect(root);
        if (terms_.size() < register_width) return;
        Lanes total;
        for (Lanes& part : parts()) total = total.empty() ? part : joined(total, part);
        for (const Lane lane : constants_) total = joined(total, {lane});
        while (total.size() > 1) total = halved(total);
        at(root).operands = std::vector<Operand>(graph_.node(total[0]).operands);
    }

  private:
    Node& at(int index) { return graph_.nodes[static_cast<std::size_t>(index)]; }
    bool is_own(int index) const { return users_[static_cast<std::size_t>(index)] == 1; }

    // The tree's leaves.
    void collect(int index) {
        for (const Operand& operand : std::vector<Operand>(at(index).operands)) {
            const Lane lane = operand.lanes[0];
            const Node& node = graph_.node(lane);
            const bool inner = node.kind == Node::Kind::Op && node.op == op_ && node.width == 1 &&
                               !node.saturate && is_own(lane.node);
            if (operand.negate) {
                Node mov;
                mov.operands = {operand};
                mov.origin = node.origin;
                terms_.push_back({add(std::move(mov)), 0});
            } else if (inner) {
                collect(lane.node);
            } else {
                (node.kind == Node::Kind::Constant ? constants_ : terms_).push_back(lane);
            }
        }
    }

    // What instructions must have in common to become one.
    using Shape = std::tuple<bool, Opcode, bool, std::vector<bool>>;
    Shape shape_of(Lane lane) const {
        const Node& node = graph_.node(lane);
        std::vector<bool> signs;
        if (!can_widen(lane)) return {false, Opcode::Mov, false, signs};
        for (const Operand& operand : node.operands) signs.push_back(operand.negate);
        return {true, node.op, node.saturate, signs};
    }
    bool can_widen(Lane lane) const {
        const Node& node = graph_.node(lane);
        return node.kind == Node::Kind::Op && node.width == 1 && is_componentwise(node.op) &&
               lane.node < static_cast<int>(users_.size()) && is_own(lane.node) &&
               std::none_of(node.operands.begin(), node.operands.end(), [&](const Operand& read) {
                   const Node& source = graph_.node(read.lanes[0]);
                   return source.kind == Node::Kind::Op && is_texture_read(source.op);
               });
    }

    // The terms by fours, alike ones as one instruction each; the widest first.
    std::vector<Lanes> parts() {
        std::map<Shape, Lanes> alike;
        for (const Lane term : terms_) alike[shape_of(term)].push_back(term);
        std::vector<Lanes> result;
        for (auto& [shape, lanes] : alike) {
            std::sort(lanes.begin(), lanes.end());
            for (std::size_t first = 0; first < lanes.size(); first += register_width) {
                const std::size_t last = std::min(first + register_width, lanes.size());
                Lanes part(lanes.begin() + static_cast<std::ptrdiff_t>(first),
                           lanes.begin() + static_cast<std::ptrdiff_t>(last));
                if (part.size() == 3 && first > 0) part.push_back(part.back());
                result.push_back(std::get<0>(shape) ? as_one(part) : gathered(part));
            }
        }
        std::stable_sort(result.begin(), result.end(),
                         [](const Lanes& a, const Lanes& b) { return a.size() > b.size(); });
        return result;
    }

    Lanes as_one(const Lanes& part) {
        Node wide = graph_.node(part[0]);
        wide.width = static_cast<int>(part.size());
        for (std::size_t k = 0; k < wide.operands.size(); ++k) {
            Lanes lanes;
            for (const Lane lane : part) lanes.push_back(graph_.node(lane).operands[k].lanes[0]);
            wide.operands[k].lanes = gathered(lanes);
        }
        return lanes_of(add(std::move(wide)));
    }
    // A component that is there twice is computed twice by one instruction: then nothing moves it.
    Lanes gathered(Lanes lanes) {
        if (lanes.size() < 2 || lanes[lanes.size() - 1] != lanes[lanes.size() - 2]) return lanes;
        const int index = lanes.back().node;
        Node& node = at(index);
        if (node.kind != Node::Kind::Op || !is_componentwise(node.op)) return lanes;
        if (node.width == 1) {
            for (Operand& operand : node.operands) operand.lanes.push_back(operand.lanes[0]);
            node.width = 2;
            doubled_.insert(index);
        }
        if (doubled_.contains(index)) lanes.back().component = 1;
        return lanes;
    }

    int add(Node node) {
        graph_.nodes.push_back(std::move(node));
        return static_cast<int>(graph_.nodes.size()) - 1;
    }
    Lanes lanes_of(int index) {
        Lanes lanes;
        for (int k = 0; k < at(index).width; ++k) lanes.push_back({index, k});
        return lanes;
    }
    Lanes extreme(const Lanes& a, const Lanes& b) {
        Node node;
        node.op = op_;
        node.width = static_cast<int>(a.size());
        node.origin = origin_;
        node.operands = {{a, false}, {b, false}};
        return lanes_of(add(std::move(node)));
    }
    Lanes joined(Lanes a, Lanes b) {
        while (a.size() != b.size()) (a.size() > b.size() ? a : b) = halved(std::max(a, b, wider));
        return extreme(a, b);
    }
    static bool wider(const Lanes& a, const Lanes& b) { return a.size() < b.size(); }
    // x with w and y with z; of three, the one in the middle stays.
    Lanes halved(const Lanes& lanes) {
        const auto half = static_cast<std::ptrdiff_t>(lanes.size() / 2);
        Lanes result =
            extreme({lanes.begin(), lanes.begin() + half}, {lanes.rbegin(), lanes.rbegin() + half});
        if (lanes.size() == 3) result.push_back(lanes[1]);
        return result;
    }

    Graph& graph_;
    const std::vector<int>& users_;
    const Opcode op_;
    const ir::Origin origin_;
    Lanes terms_, constants_;
    std::set<int> doubled_;
};

bool is_extreme(const Node& node) {
    return node.kind == Node::Kind::Op && (node.op == Opcode::Max || node.op == Opcode::Min) &&
           node.width == 1 && !node.operands.empty();
}

}  // namespace

Graph with_wide_reductions(const Graph& graph) {
    Graph result = graph;
    const std::vector<int> users = count_users(graph);
    std::set<int> inner;
    for (const Node& node : graph.nodes) {
        if (!is_extreme(node)) continue;
        for (const Operand& operand : node.operands) {
            const Node& read = graph.node(operand.lanes[0]);
            if (is_extreme(read) && read.op == node.op && !read.saturate &&
                users[static_cast<std::size_t>(operand.lanes[0].node)] == 1 && !operand.negate)
                inner.insert(operand.lanes[0].node);
        }
    }
    for (std::size_t i = 0; i < graph.nodes.size(); ++i)
        if (is_extreme(graph.nodes[i]) && !inner.contains(static_cast<int>(i)))
            Reduction(result, users, static_cast<int>(i));
    drop_dead(result);
    return result;
}

}  // namespace intaglio::d3d9

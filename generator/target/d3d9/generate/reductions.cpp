// A maximum of many scalars is the maximum of a few vectors, then of one vector's components: n
// alike terms take n / 4 instructions, n / 4 - 1 maxima of vectors and two within the last one.
// The pairwise joining of pack() finds this only for few terms.
#include <algorithm>
#include <bit>
#include <map>
#include <optional>
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
    // `sign_only`: whether the result is below zero is all that is asked.
    Reduction(Graph& graph, const std::vector<int>& users, int root, bool sign_only)
        : graph_(graph), users_(users), op_(at(root).op), origin_(at(root).origin) {
        collect(root);
        if (sign_only && op_ == Opcode::Max) drop_negative_constants();
        if (terms_.size() < register_width) return;
        const std::optional<Operand> common = take_common_addend();
        Lanes total;
        for (Lanes& part : parts()) total = total.empty() ? part : joined(total, part);
        if (common) total = {last_add(total, *common)};
        for (const Lane lane : constants_) total = joined(total, {lane});
        while (total.size() > 1) total = halved(total);
        for (const Operand& operand : negated_) {
            Node node;
            node.op = op_;
            node.origin = origin_;
            node.operands = {{total, false}, operand};
            total = lanes_of(add(std::move(node)));
        }
        const Node last = graph_.node(total[0]);
        at(root).op = last.op;
        at(root).operands = last.operands;
    }

  private:
    Node& at(int index) { return graph_.nodes[static_cast<std::size_t>(index)]; }
    bool is_own(int index) const {
        const auto i = static_cast<std::size_t>(index);
        return i < users_.size() && users_[i] == 1;
    }

    // The tree's leaves.
    void collect(int index) {
        for (const Operand& operand : std::vector<Operand>(at(index).operands)) {
            const Lane lane = operand.lanes[0];
            const Node& node = graph_.node(lane);
            const bool inner = node.kind == Node::Kind::Op && node.op == op_ && node.width == 1 &&
                               !node.saturate && is_own(lane.node);
            if (operand.negate) {
                negated_.push_back(operand);
            } else if (inner) {
                collect(lane.node);
            } else {
                (node.kind == Node::Kind::Constant ? constants_ : terms_).push_back(lane);
            }
        }
    }

    // What a term is the sum of.
    std::vector<Operand> addends_of(const Operand& sum) const {
        const Lane lane = sum.lanes[0];
        const Node& node = graph_.node(lane);
        if (sum.negate || node.kind != Node::Kind::Op || node.op != Opcode::Add ||
            node.width != 1 || node.saturate || !is_own(lane.node))
            return {sum};
        std::vector<Operand> addends;
        for (const Operand& operand : node.operands)
            for (Operand& addend : addends_of(operand)) addends.push_back(std::move(addend));
        return addends;
    }
    // max (a + b + x, c + d + x) = max (a + b, c + d) + x: the terms without x.
    std::optional<Operand> take_common_addend() {
        std::vector<std::vector<Operand>> sums;
        for (const Lane term : terms_) {
            sums.push_back(addends_of({{term}, false}));
            if (sums.back().size() != 3) return std::nullopt;
        }
        for (const Operand& common : std::vector<Operand>(sums[0])) {
            const auto has_it = [&](const std::vector<Operand>& sum) {
                return std::find(sum.begin(), sum.end(), common) != sum.end();
            };
            if (!std::all_of(sums.begin(), sums.end(), has_it)) continue;
            for (std::size_t i = 0; i < sums.size(); ++i) {
                sums[i].erase(std::find(sums[i].begin(), sums[i].end(), common));
                at(terms_[i].node).operands = sums[i];
            }
            return common;
        }
        return std::nullopt;
    }
    Lane last_add(Lanes total, const Operand& addend) {
        while (total.size() > 1) total = halved(total);
        Node node;
        node.op = Opcode::Add;
        node.origin = origin_;
        node.operands = {{total, false}, addend};
        return {add(std::move(node)), 0};
    }

    void drop_negative_constants() {
        const auto negative = [&](Lane lane) {
            return std::bit_cast<float>(graph_.node(lane).bits) < 0;
        };
        constants_.erase(std::remove_if(constants_.begin(), constants_.end(), negative),
                         constants_.end());
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
    std::vector<Operand> negated_;  // last, where a sign costs nothing
    std::set<int> doubled_;
};

bool is_extreme(const Node& node) {
    return node.kind == Node::Kind::Op && (node.op == Opcode::Max || node.op == Opcode::Min) &&
           node.width == 1 && !node.operands.empty();
}

// Read by nothing but the first operand of cmp, as it is.
bool is_only_tested(const Graph& graph, int index) {
    const auto reads = [&](const Operand& operand) {
        return std::any_of(operand.lanes.begin(), operand.lanes.end(),
                           [&](Lane lane) { return lane.node == index; });
    };
    for (const Node& node : graph.nodes)
        for (std::size_t k = 0; k < node.operands.size(); ++k)
            if (reads(node.operands[k]) &&
                (node.op != Opcode::Cmp || k > 0 || node.operands[k].negate))
                return false;
    return std::none_of(graph.outputs.begin(), graph.outputs.end(), reads);
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
            Reduction(result, users, static_cast<int>(i),
                      is_only_tested(graph, static_cast<int>(i)));
    drop_dead(result);
    return result;
}

}  // namespace intaglio::d3d9

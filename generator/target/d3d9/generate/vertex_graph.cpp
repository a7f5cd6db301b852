// What vertex shaders lack, in what they have.  A condition is sge's 1 or 0, so a choice is
// arithmetic, and arithmetic is a choice only among finite numbers: 0 * inf is NaN.  Where both
// sides are surely finite, x t + (y - y t) gives exactly the chosen one.  What comes from rcp, rsq,
// log or exp may be infinite just where it is not chosen (guards of divisions), so there
// max(min(x, k), min(y, -k)) with k = +-2^127 is taken: exact as well, but that numbers beyond
// 2^127 become 2^127.  Attributes and uniforms are taken as finite.
#include <algorithm>
#include <bit>
#include <map>
#include <tuple>

#include "generator/target/d3d9/generate/vertex.h"

namespace intaglio::d3d9 {
namespace {

constexpr std::uint32_t sign_bit = 0x80000000u;

class Legalization {
  public:
    Legalization(Graph& graph, Profile profile) : graph_(graph), profile_(profile) {}

    void run() {
        for (const int index : order_of(graph_, Order::Depth)) {
            for (Operand& operand : at(index).operands) operand = resolved(operand);
            shorten_dot(index);
            for (std::size_t k = 0; k < at(index).operands.size(); ++k) {
                const Operand made = homogeneous(at(index).operands[k]);
                at(index).operands[k] = made;
            }
            if (at(index).op == Opcode::Cmp) choose(index);
            if (at(index).saturate && profile_ == Profile::vs_2_0) clamp(index);
        }
        for (Operand& output : graph_.outputs) output = homogeneous(resolved(output));
        drop_dead();
    }

  private:
    Node& at(int index) { return graph_.nodes[static_cast<std::size_t>(index)]; }
    const Node& of(Lane lane) const { return graph_.node(lane); }

    int add(Node node) {
        graph_.nodes.push_back(std::move(node));
        return static_cast<int>(graph_.nodes.size()) - 1;
    }
    // All of the result; equal instructions are one.
    Operand emit(Opcode op, std::vector<Operand> operands) {
        const auto key = std::make_tuple(op, operands);
        const auto [found, added] = seen_.try_emplace(key, 0);
        const std::size_t width = operands[0].lanes.size();
        if (added) {
            Node node;
            node.op = op;
            node.width = static_cast<int>(width);
            node.operands = std::move(operands);
            node.origin = origin_;
            found->second = add(std::move(node));
        }
        return result_of(found->second, width);
    }
    static Operand result_of(int index, std::size_t width) {
        Operand operand;
        for (std::size_t k = 0; k < width; ++k)
            operand.lanes.push_back({index, static_cast<int>(k)});
        return operand;
    }
    Lane constant(std::uint32_t bits) {
        for (std::size_t i = 0; i < graph_.nodes.size(); ++i)
            if (graph_.nodes[i].kind == Node::Kind::Constant && graph_.nodes[i].bits == bits)
                return {static_cast<int>(i), 0};
        Node node;
        node.kind = Node::Kind::Constant;
        node.bits = bits;
        return {add(std::move(node)), 0};
    }
    Lane constant(float number) { return constant(std::bit_cast<std::uint32_t>(number)); }
    Operand repeated(float number, std::size_t width) {
        return {std::vector<Lane>(width, constant(number)), false};
    }
    static Operand negated(Operand operand) {
        operand.negate = !operand.negate;
        return operand;
    }

    // Constants take a sign in; results that were replaced are read where they are now.
    Operand resolved(Operand operand) {
        for (Lane& lane : operand.lanes)
            for (auto found = moved_.find(lane); found != moved_.end(); found = moved_.find(lane))
                lane = found->second;
        return operand;
    }
    // The numbers of an operand of constants, sign and all.
    std::optional<std::vector<float>> numbers_of(const Operand& operand) const {
        std::vector<float> numbers;
        for (const Lane lane : operand.lanes) {
            if (of(lane).kind != Node::Kind::Constant) return std::nullopt;
            numbers.push_back(
                std::bit_cast<float>(of(lane).bits ^ (operand.negate ? sign_bit : 0)));
        }
        return numbers;
    }
    bool all(const Operand& operand, float number) const {
        const auto numbers = numbers_of(operand);
        return numbers &&
               std::all_of(numbers->begin(), numbers->end(), [&](float n) { return n == number; });
    }

    void move(int from, const Operand& to) {
        for (std::size_t k = 0; k < to.lanes.size(); ++k)
            moved_[{from, static_cast<int>(k)}] = to.lanes[k];
    }

    // A component that is multiplied by 0 is none.
    void shorten_dot(int index) {
        if (at(index).op != Opcode::Dp4) return;
        for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t k = 0; k < 4; ++k) {
                const Lane lane = at(index).operands[side].lanes[k];
                if (of(lane).kind != Node::Kind::Constant || (of(lane).bits & ~sign_bit) != 0)
                    continue;
                at(index).op = Opcode::Dp3;
                for (Operand& operand : at(index).operands)
                    operand.lanes.erase(operand.lanes.begin() + static_cast<std::ptrdiff_t>(k));
                return;
            }
    }

    // Components of one attribute beside constants, (x, y, z, 1), are one mad instead of two movs.
    Operand homogeneous(const Operand& operand) {
        int input = -1;
        bool constants = false;
        std::vector<Lane> scale, offset, from;
        for (const Lane lane : operand.lanes) {
            const Node& node = of(lane);
            if (node.kind == Node::Kind::Constant) {
                constants = true;
                continue;
            }
            if (node.kind != Node::Kind::Input || (input >= 0 && input != lane.node))
                return operand;
            input = lane.node;
        }
        if (input < 0 || !constants) return operand;
        for (const Lane lane : operand.lanes) {
            const bool is_constant = of(lane).kind == Node::Kind::Constant;
            from.push_back(is_constant ? Lane{input, 0} : lane);
            offset.push_back(is_constant ? lane : constant(0.0f));
            scale.push_back(constant(is_constant ? 0.0f : 1.0f));
        }
        Operand made = emit(Opcode::Mad, {{from, false}, {scale, false}, {offset, false}});
        made.negate = operand.negate;
        return made;
    }

    bool is_finite(const Operand& operand) {
        return std::all_of(operand.lanes.begin(), operand.lanes.end(),
                           [&](Lane lane) { return is_finite(lane.node); });
    }
    bool is_finite(int index) {
        const auto known = finite_.find(index);
        if (known != finite_.end()) return known->second;
        const Node& node = graph_.nodes[static_cast<std::size_t>(index)];
        bool finite = true;
        if (node.kind == Node::Kind::Op) {
            finite = !is_scalar(node.op);
            if (finite && node.op != Opcode::Sge)
                for (const Operand& operand : node.operands) finite = finite && is_finite(operand);
        }
        return finite_[index] = finite;
    }

    // 1 where the operand is at least 0, else 0; of a difference the two sides are compared.
    Operand truth(const Operand& gap) {
        const Node& node = of(gap.lanes[0]);
        const bool one_sum = node.kind == Node::Kind::Op && node.op == Opcode::Add &&
                             !node.saturate &&
                             std::all_of(gap.lanes.begin(), gap.lanes.end(),
                                         [&](Lane lane) { return lane.node == gap.lanes[0].node; });
        if (!one_sum) return emit(Opcode::Sge, {gap, repeated(0, gap.lanes.size())});
        std::array<Operand, 2> sides;
        for (std::size_t s = 0; s < 2; ++s) {
            for (const Lane lane : gap.lanes)
                sides[s].lanes.push_back(
                    node.operands[s].lanes[static_cast<std::size_t>(lane.component)]);
            sides[s].negate = node.operands[s].negate != (gap.negate != (s == 1));
        }
        return emit(Opcode::Sge, {sides[0], sides[1]});
    }

    // Of two constants, as one mad, if that is exact.
    bool choose_constant(int index, const Operand& t, const Operand& yes, const Operand& no) {
        const auto a = numbers_of(yes), b = numbers_of(no);
        if (!a || !b) return false;
        Operand step, base;
        for (std::size_t k = 0; k < a->size(); ++k) {
            const float difference = (*a)[k] - (*b)[k];
            if (difference + (*b)[k] != (*a)[k]) return false;
            step.lanes.push_back(constant(difference));
            base.lanes.push_back(constant((*b)[k]));
        }
        if (all(step, 1) && all(base, 0))
            move(index, t);
        else if (all(base, 0))
            become(index, Opcode::Mul, {t, step});
        else
            become(index, Opcode::Mad, {t, step, base});
        return true;
    }
    void become(int index, Opcode op, std::vector<Operand> operands) {
        at(index).op = op;
        at(index).operands = std::move(operands);
    }

    void choose(int index) {
        origin_ = at(index).origin;
        const Operand gap = at(index).operands[0], yes = at(index).operands[1],
                      no = at(index).operands[2];
        const std::size_t width = yes.lanes.size();
        const Operand t = truth(gap);
        if (!at(index).saturate && choose_constant(index, t, yes, no)) return;
        if (!is_finite(yes) || !is_finite(no)) {
            constexpr float half = 0x1.fffffep126f;
            const Operand k =
                emit(Opcode::Mad, {t, repeated(2 * half, width), repeated(-half, width)});
            become(index, Opcode::Max,
                   {emit(Opcode::Min, {yes, k}), emit(Opcode::Min, {no, negated(k)})});
            finite_[index] = true;
        } else if (all(no, 0)) {
            become(index, Opcode::Mul, {yes, t});
        } else {
            Operand rest = emit(Opcode::Mad, {negated(no), t, no});
            if (all(yes, 0))
                become(index, Opcode::Mad, {negated(no), t, no});
            else
                become(index, Opcode::Mad, {yes, t, std::move(rest)});
        }
    }

    void clamp(int index) {
        origin_ = at(index).origin;
        const auto width = static_cast<std::size_t>(at(index).width);
        at(index).saturate = false;
        const bool plain = at(index).op == Opcode::Mov;
        const Operand value = plain ? at(index).operands[0] : result_of(index, width);
        const Operand above = emit(Opcode::Max, {value, repeated(0, width)});
        if (plain) {
            become(index, Opcode::Min, {above, repeated(1, width)});
            return;
        }
        Node least;
        least.op = Opcode::Min;
        least.width = static_cast<int>(width);
        least.operands = {above, repeated(1, width)};
        least.origin = origin_;
        move(index, result_of(add(std::move(least)), width));
    }

    void drop_dead() {
        std::vector<char> live(graph_.nodes.size());
        for (const int index : order_of(graph_, Order::Depth))
            live[static_cast<std::size_t>(index)] = 1;
        for (std::size_t i = 0; i < graph_.nodes.size(); ++i)
            if (live[i] == 0) graph_.nodes[i].operands.clear();
    }

    Graph& graph_;
    Profile profile_;
    ir::Origin origin_;
    std::map<std::tuple<Opcode, std::vector<Operand>>, int> seen_;
    std::map<Lane, Lane> moved_;
    std::map<int, bool> finite_;
};

}  // namespace

void legalize_for_vertex(Graph& graph, Profile profile) { Legalization(graph, profile).run(); }

}  // namespace intaglio::d3d9

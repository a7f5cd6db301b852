// Components to lanes.  A vector that an instruction needs whole is computed in place: the nodes
// that give its components get lanes of one register, consumers first; what cannot be (texels,
// inputs, constants, values that another vector has already) is moved there.  Scalars that only
// scalars read stay free for the allocator, which may put them into any lane.
#include <algorithm>
#include <map>
#include <tuple>

#include "generator/target/d3d9/generate/place_homes.h"

namespace intaglio::d3d9 {
namespace {

struct Location {
    VirtualSource::Kind kind = VirtualSource::Kind::Temp;
    int index = -1;
    int lane = 0;
    bool same_register(const Location& other) const {
        return kind == other.kind && index == other.index;
    }
};

class Placement : Homes {
  public:
    Placement(const Graph& graph, const std::vector<int>& order, const Limits& limits,
              const std::vector<int>& uniform_registers)
        : Homes(graph), order_(order), limits_(limits), uniforms_(uniform_registers) {
        for (int k = 0; k < graph.variables; ++k) lanes(new_register()) = full_mask;
    }

    Code run() {
        choose(order_);
        for (const int index : order_) emit(index);
        // The test last: an r# that it has tested counts as one more read deep.
        for (const bool kills : {false, true})
            for (std::size_t k = 0; k < graph_.outputs.size(); ++k)
                if ((graph_.kind_of_output(k) == OutputKind::Kill) == kills)
                    emit_output(static_cast<int>(k));
        if (!limits_.pixel()) write_outputs_directly(code_);
        if (limits_.pixel()) compute_in_tested_lanes(code_);
        return std::move(code_);
    }

  private:
    const InterpolantPlace& place_of(const Node& input) const {
        return graph_.inputs[static_cast<std::size_t>(input.slot)];
    }
    Location locate(Lane lane) {
        const Node& n = node(lane.node);
        if (n.kind == Node::Kind::Uniform)
            return {VirtualSource::Kind::Uniform,
                    uniforms_[static_cast<std::size_t>(n.slot)] + n.element, lane.component};
        if (n.kind == Node::Kind::Input)
            return {VirtualSource::Kind::Input, place_of(n).index,
                    place_of(n).lanes[static_cast<std::size_t>(lane.component)]};
        if (n.kind == Node::Kind::Constant) return {VirtualSource::Kind::Constant, lane.node, 0};
        if (n.kind == Node::Kind::Variable)
            return {VirtualSource::Kind::Temp, n.slot, lane.component};
        const Home& h = home(lane.node);
        return {VirtualSource::Kind::Temp, h.target,
                h.lane[static_cast<std::size_t>(lane.component)]};
    }

    // One register and a legal swizzle that show the lanes at the positions.
    std::optional<VirtualSource> direct(const std::vector<Lane>& list, const Positions& positions,
                                        bool exact) {
        VirtualSource source;
        const Location first = locate(list[0]);
        source.kind = first.kind;
        if (first.kind == VirtualSource::Kind::Constant) {
            if (exact) return std::nullopt;
            for (std::size_t k = 0; k < list.size(); ++k) {
                const Node& n = node(list[k].node);
                if (n.kind != Node::Kind::Constant) return std::nullopt;
                source.wanted.bits[static_cast<std::size_t>(positions[k])] = n.bits;
                source.wanted.mask = static_cast<Mask>(source.wanted.mask | (1 << positions[k]));
            }
            return source;
        }
        source.index = first.index;
        std::array<int, 4> seen{-1, -1, -1, -1};
        for (std::size_t k = 0; k < list.size(); ++k) {
            const Location at = locate(list[k]);
            if (!at.same_register(first)) return std::nullopt;
            if (exact && at.lane != positions[k]) return std::nullopt;
            seen[static_cast<std::size_t>(positions[k])] = at.lane;
        }
        const auto swizzle = find_swizzle(seen, limits_);
        if (!swizzle || (exact && first.kind == VirtualSource::Kind::Uniform)) return std::nullopt;
        source.swizzle = *swizzle;
        return source;
    }

    void move(int target, Mask mask, const VirtualSource& source) {
        VirtualInstruction mov;
        mov.target = target;
        mov.mask = mask;
        mov.sources = {source};
        mov.origin = origin_;
        code_.instructions.push_back(std::move(mov));
    }

    VirtualSource in_place(int target) {
        VirtualSource source;
        source.index = target;
        return source;
    }

    // Moves the lanes that are not in `target` yet to their positions, as few movs as possible.
    void fill(int target, const std::vector<Lane>& list, const Positions& positions) {
        std::vector<std::size_t> rest;
        for (std::size_t k = 0; k < list.size(); ++k)
            if (!written_.contains({target, positions[k], list[k]}) &&
                !at_home(list[k], target, positions[k]))
                rest.push_back(k);
        while (!rest.empty()) {
            const auto part = take_largest_part(list, positions, rest);
            Mask mask = 0;
            for (const std::size_t k : part) {
                mask = static_cast<Mask>(mask | (1 << positions[k]));
                written_.emplace(std::make_tuple(target, positions[k], list[k]), 0);
                occupy(target, positions[k]);
            }
            move(target, mask, *direct_part(list, positions, part));
        }
    }
    // The largest part of the rest that one mov can do.
    std::vector<std::size_t> take_largest_part(const std::vector<Lane>& list,
                                               const Positions& positions,
                                               std::vector<std::size_t>& rest) {
        std::vector<std::size_t> part;
        for (std::size_t set = 1; set < (1u << rest.size()); ++set) {
            std::vector<std::size_t> trial;
            for (std::size_t j = 0; j < rest.size(); ++j)
                if ((set >> j & 1) != 0) trial.push_back(rest[j]);
            if (trial.size() > part.size() && direct_part(list, positions, trial)) part = trial;
        }
        for (const std::size_t k : part) rest.erase(std::find(rest.begin(), rest.end(), k));
        return part;
    }
    bool at_home(Lane lane, int target, int position) {
        const Location at = locate(lane);
        return at.kind == VirtualSource::Kind::Temp && at.index == target && at.lane == position;
    }
    std::optional<VirtualSource> direct_part(const std::vector<Lane>& list,
                                             const Positions& positions,
                                             const std::vector<std::size_t>& part) {
        std::vector<Lane> lanes_of_part;
        Positions positions_of_part;
        for (const std::size_t k : part) {
            lanes_of_part.push_back(list[k]);
            positions_of_part.push_back(positions[k]);
        }
        return direct(lanes_of_part, positions_of_part, false);
    }

    VirtualSource resolve(std::pair<int, int> user, const Operand& operand,
                          const Positions& positions, bool exact) {
        std::optional<VirtualSource> source = direct(operand.lanes, positions, exact);
        if (!source) {
            int target = -1;
            const auto prepared = gathers_.find(user);
            if (prepared != gathers_.end()) {
                target = prepared->second;
                for (std::size_t k = 0; k < operand.lanes.size(); ++k)
                    if (!is_at(operand.lanes[k], target, positions[k])) target = -1;
            }
            if (target < 0) {
                const auto [cached, added] =
                    copies_.try_emplace(std::make_pair(operand.lanes, positions), 0);
                if (added) cached->second = new_register();
                target = cached->second;
            }
            fill(target, operand.lanes, positions);
            source = in_place(target);
        }
        source->negate = operand.negate;
        return *source;
    }

    // A copy of an input or uniform in a temp, or of constants.
    void copy_to_temp(VirtualSource& source) {
        const bool negate = source.negate;
        int target = -1;
        if (source.kind == VirtualSource::Kind::Constant) {
            for (const auto& [wanted, copy] : constant_copies_)
                if (wanted == source.wanted) target = copy;
            if (target < 0) {
                target = new_register();
                constant_copies_.emplace_back(source.wanted, target);
                VirtualSource plain = source;
                plain.negate = false;
                lanes(target) = source.wanted.mask;
                move(target, source.wanted.mask, plain);
            }
            source = in_place(target);
        } else {
            const auto key = std::make_pair(static_cast<int>(source.kind), source.index);
            const auto [cached, added] = register_copies_.try_emplace(key, 0);
            if (added) {
                cached->second = new_register();
                lanes(cached->second) = lanes_of_source(source);
                VirtualSource whole;
                whole.kind = source.kind;
                whole.index = source.index;
                move(cached->second, lanes_of_source(source), whole);
            }
            source.kind = VirtualSource::Kind::Temp;
            source.index = cached->second;
        }
        source.negate = negate;
    }
    Mask lanes_of_source(const VirtualSource& source) {
        if (source.kind == VirtualSource::Kind::Input)
            return lanes_of_register(graph_.inputs, source.index);
        for (const Node& n : graph_.nodes)
            if (n.kind == Node::Kind::Uniform &&
                uniforms_[static_cast<std::size_t>(n.slot)] + n.element == source.index)
                return static_cast<Mask>((1 << n.width) - 1);
        return full_mask;
    }

    // One distinct input and one distinct c# per instruction, that in at most two operands.
    void obey_ports(std::vector<VirtualSource>& sources) {
        const auto is_kind = [&](std::size_t k, VirtualSource::Kind kind) {
            return sources[k].kind == kind;
        };
        for (std::size_t k = 0; k < sources.size(); ++k)
            for (std::size_t j = k + 1; j < sources.size(); ++j) {
                if (is_kind(k, VirtualSource::Kind::Input) &&
                    is_kind(j, VirtualSource::Kind::Input) &&
                    sources[k].index != sources[j].index) {
                    const auto copied = std::make_pair(static_cast<int>(VirtualSource::Kind::Input),
                                                       sources[j].index);
                    copy_to_temp(register_copies_.contains(copied) ? sources[j] : sources[k]);
                }
            }
        const auto constant_like = [&](std::size_t k) {
            return is_kind(k, VirtualSource::Kind::Uniform) ||
                   is_kind(k, VirtualSource::Kind::Constant);
        };
        for (std::size_t k = 0; k < sources.size(); ++k)
            for (std::size_t j = k + 1; j < sources.size(); ++j) {
                if (!constant_like(k) || !constant_like(j)) continue;
                const bool together =
                    sources[k].kind == sources[j].kind &&
                    (is_kind(k, VirtualSource::Kind::Uniform)
                         ? sources[k].index == sources[j].index
                         : can_share(sources[k].wanted, sources[j].wanted, limits_));
                if (together) continue;
                copy_to_temp(is_kind(k, VirtualSource::Kind::Uniform) ? sources[k] : sources[j]);
            }
        int operands = 0;
        for (std::size_t k = 0; k < sources.size(); ++k)
            if (constant_like(k) && ++operands > 2) copy_to_temp(sources[k]);
    }

    void emit(int index) {
        const Node& n = node(index);
        origin_ = n.origin;
        VirtualInstruction instruction;
        instruction.op = n.op;
        instruction.target = home(index).target;
        instruction.saturate = n.saturate;
        instruction.origin = n.origin;
        instruction.mask = 0;
        for (int k = 0; k < n.width; ++k)
            instruction.mask = static_cast<Mask>(
                instruction.mask | (1 << home(index).lane[static_cast<std::size_t>(k)]));
        const bool texture = is_texture_read(n.op);
        if (texture) instruction.sampler = n.slot;
        for (std::size_t k = 0; k < n.operands.size(); ++k) {
            if (is_scalar(n.op)) {
                const Location at = locate(n.operands[k].lanes[0]);
                VirtualSource source = *direct(n.operands[k].lanes, {home(index).lane[0]}, false);
                source.swizzle = replicate(at.lane);
                source.negate = n.operands[k].negate;
                instruction.sources.push_back(source);
                continue;
            }
            instruction.sources.push_back(resolve({index, static_cast<int>(k)}, n.operands[k],
                                                  positions_of(index, k), texture));
        }
        obey_ports(instruction.sources);
        code_.instructions.push_back(std::move(instruction));
    }

    // Vertex shaders take outputs lane by lane.
    void emit_output_lanes(int k, const Operand& operand) {
        const Positions positions = positions_of_output(static_cast<std::size_t>(k));
        std::vector<std::size_t> rest;
        for (std::size_t c = 0; c < operand.lanes.size(); ++c) rest.push_back(c);
        while (!rest.empty()) {
            const auto part = take_largest_part(operand.lanes, positions, rest);
            Mask mask = 0;
            for (const std::size_t c : part) mask = static_cast<Mask>(mask | (1 << positions[c]));
            move(-1, mask, *direct_part(operand.lanes, positions, part));
            code_.instructions.back().output = k;
            code_.instructions.back().sources[0].negate = operand.negate;
        }
    }

    void emit_output(int k) {
        const Operand& operand = graph_.outputs[static_cast<std::size_t>(k)];
        if (!limits_.pixel()) return emit_output_lanes(k, operand);
        const OutputKind kind = graph_.kind_of_output(static_cast<std::size_t>(k));
        if (kind == OutputKind::Depth) return emit_depth(k, operand.lanes[0]);
        if (kind == OutputKind::Kill) return emit_kill(operand.lanes[0]);
        VirtualInstruction mov;
        mov.output = k;
        mov.origin = origin_;
        std::optional<VirtualSource> source = direct(operand.lanes, {0, 1, 2, 3}, false);
        // oC# takes no swizzle: constants are pooled in order, anything else must lie in order.
        if (source && source->kind != VirtualSource::Kind::Constant &&
            source->swizzle != identity_swizzle)
            source = std::nullopt;
        mov.sources = {source && source->kind != VirtualSource::Kind::Constant
                           ? *source
                           : resolve_output(k, operand)};
        code_.instructions.push_back(std::move(mov));
    }
    // oDepth takes one lane of any register, by mov.
    void emit_depth(int k, Lane lane) {
        if (node(lane.node).kind == Node::Kind::Op) origin_ = node(lane.node).origin;
        move(-1, 1, one_lane(lane));
        code_.instructions.back().output = k;
    }
    // An r#, all of whose lanes hold the value: model 2 tests x, y and z without a mask, and
    // MojoShader takes none in model 3 either.
    void emit_kill(Lane lane) {
        if (node(lane.node).kind == Node::Kind::Op) origin_ = node(lane.node).origin;
        const int target = new_register();
        fill(target, std::vector<Lane>(4, lane), {0, 1, 2, 3});
        VirtualInstruction test;
        test.op = Opcode::Texkill;
        test.sources = {in_place(target)};
        test.origin = origin_;
        code_.instructions.push_back(std::move(test));
    }
    VirtualSource one_lane(Lane lane) {
        VirtualSource source = *direct({lane}, {0}, false);
        if (source.kind != VirtualSource::Kind::Constant)
            source.swizzle = replicate(locate(lane).lane);
        return source;
    }
    VirtualSource resolve_output(int k, const Operand& operand) {
        if (node(operand.lanes[0].node).kind == Node::Kind::Constant &&
            direct(operand.lanes, {0, 1, 2, 3}, false)) {
            const int target = new_register();
            fill(target, operand.lanes, {0, 1, 2, 3});
            return in_place(target);
        }
        return resolve({-1, k}, operand, {0, 1, 2, 3}, true);
    }

    const std::vector<int>& order_;
    const Limits& limits_;
    const std::vector<int>& uniforms_;
    ir::Origin origin_;
    std::map<std::tuple<int, int, Lane>, int> written_;  // movs done
    std::map<std::pair<std::vector<Lane>, Positions>, int> copies_;
    std::map<std::pair<int, int>, int> register_copies_;
    std::vector<std::pair<Wanted, int>> constant_copies_;
};

}  // namespace

Code place(const Graph& graph, const std::vector<int>& order, const Limits& limits,
           const std::vector<int>& uniform_registers) {
    return Placement(graph, order, limits, uniform_registers).run();
}

}  // namespace intaglio::d3d9

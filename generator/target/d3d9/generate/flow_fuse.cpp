// Instructions that scale and shift one value by constants become one: (x, c) = x (1, 0) + (0, c).
// Where x is not finite its neighbour is lost as well; whoever reads the two together has lost
// already.
#include <algorithm>
#include <bit>

#include "generator/target/d3d9/generate/flow_code.h"
#include "generator/target/d3d9/generate/flow_merge.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

constexpr std::uint32_t zero = 0, one = 0x3F800000u, sign_bit = 0x80000000u;

// target.mask = x * scale + shift, by position; without x the shift alone.
struct Affine {
    std::optional<VirtualSource> x;
    std::array<std::uint32_t, 4> scale{}, shift{};
    Mask mask = 0;
};

bool is_constant(const VirtualSource& source) {
    return source.kind == VirtualSource::Kind::Constant && !source.absolute;
}
std::uint32_t bits_at(const VirtualSource& source, std::size_t k) {
    return source.wanted.bits[k] ^ (source.negate ? sign_bit : 0);
}

std::optional<Affine> affine_of(const VirtualInstruction& instruction) {
    if (!writes(instruction) || instruction.saturate) return std::nullopt;
    Affine result;
    result.mask = instruction.mask;
    const std::vector<VirtualSource>& sources = instruction.sources;
    const auto fill = [&](std::array<std::uint32_t, 4>& to, const VirtualSource* from,
                          std::uint32_t otherwise) {
        for (std::size_t k = 0; k < 4; ++k)
            if ((instruction.mask >> k & 1) != 0)
                to[k] = from != nullptr ? bits_at(*from, k) : otherwise;
    };
    switch (instruction.op) {
        case Opcode::Mov:
            if (is_constant(sources[0])) {
                fill(result.shift, &sources[0], zero);
                return result;
            }
            result.x = sources[0];
            fill(result.scale, nullptr, one);
            return result;
        case Opcode::Mul:
        case Opcode::Add: {
            const std::size_t c = is_constant(sources[0]) ? 0 : 1;
            if (!is_constant(sources[c]) || is_constant(sources[1 - c])) return std::nullopt;
            result.x = sources[1 - c];
            const bool mul = instruction.op == Opcode::Mul;
            fill(result.scale, mul ? &sources[c] : nullptr, one);
            fill(result.shift, mul ? nullptr : &sources[c], zero);
            return result;
        }
        case Opcode::Mad: {
            const std::size_t c = is_constant(sources[0]) ? 0 : 1;
            if (!is_constant(sources[c]) || is_constant(sources[1 - c]) || !is_constant(sources[2]))
                return std::nullopt;
            result.x = sources[1 - c];
            fill(result.scale, &sources[c], one);
            fill(result.shift, &sources[2], zero);
            return result;
        }
        default: return std::nullopt;
    }
}

// Both, side by side; nothing if they scale different registers or are one constant mov each.
std::optional<Affine> joined(const Affine& a, const Affine& b) {
    if ((a.mask & b.mask) != 0) return std::nullopt;
    Affine result = a;
    if (a.x && b.x &&
        (a.x->kind != b.x->kind || a.x->index != b.x->index || a.x->absolute != b.x->absolute))
        return std::nullopt;
    const bool flips = a.x && b.x && a.x->negate != b.x->negate;
    if (!result.x) {
        result.x = b.x;
        // The lanes that are scaled by nothing may see any that b sees.
        const int seen = std::countr_zero(static_cast<unsigned>(b.mask));
        for (std::size_t k = 0; b.x && k < 4; ++k)
            if ((b.mask >> k & 1) == 0)
                result.x->swizzle[k] = b.x->swizzle[static_cast<std::size_t>(seen)];
    } else {
        const int seen = std::countr_zero(static_cast<unsigned>(a.mask));
        for (std::size_t k = 0; k < 4; ++k)
            if ((a.mask >> k & 1) == 0)
                result.x->swizzle[k] = a.x->swizzle[static_cast<std::size_t>(seen)];
    }
    for (std::size_t k = 0; k < 4; ++k) {
        if ((b.mask >> k & 1) == 0) continue;
        result.scale[k] = b.scale[k] ^ (flips ? sign_bit : 0);
        result.shift[k] = b.shift[k];
        if (a.x && b.x) result.x->swizzle[k] = b.x->swizzle[k];
    }
    result.mask = static_cast<Mask>(a.mask | b.mask);
    return result;
}

VirtualSource constant_of(const std::array<std::uint32_t, 4>& bits, Mask mask) {
    VirtualSource source;
    source.kind = VirtualSource::Kind::Constant;
    source.wanted.bits = bits;
    source.wanted.mask = mask;
    return source;
}

// The shortest instruction for it, if the ports allow one.
std::optional<VirtualInstruction> instruction_for(const Affine& affine,
                                                  const VirtualInstruction& like) {
    VirtualInstruction result = like;
    result.mask = affine.mask;
    const auto all = [&](const std::array<std::uint32_t, 4>& bits, std::uint32_t value) {
        for (std::size_t k = 0; k < 4; ++k)
            if ((affine.mask >> k & 1) != 0 && bits[k] != value) return false;
        return true;
    };
    const VirtualSource scale = constant_of(affine.scale, affine.mask),
                        shift = constant_of(affine.shift, affine.mask);
    if (!affine.x) {
        result.op = Opcode::Mov;
        result.sources = {shift};
    } else if (all(affine.shift, zero)) {
        const bool plain = all(affine.scale, one);
        result.op = plain ? Opcode::Mov : Opcode::Mul;
        result.sources = {*affine.x};
        if (!plain) result.sources.push_back(scale);
    } else if (all(affine.scale, one)) {
        result.op = Opcode::Add;
        result.sources = {*affine.x, shift};
    } else {
        result.op = Opcode::Mad;
        result.sources = {*affine.x, scale, shift};
    }
    if (!obeys_ports(result)) return std::nullopt;
    return result;
}

bool reads_lane_of(const FlowCode& code, const VirtualInstruction& instruction, int reg,
                   Mask mask) {
    for (std::size_t s = 0; s < instruction.sources.size(); ++s) {
        const VirtualSource& source = instruction.sources[s];
        if (source.kind != VirtualSource::Kind::Temp || source.index != reg) continue;
        const Mask positions = positions_of_source(code, instruction, s);
        for (std::size_t k = 0; k < 4; ++k)
            if ((positions >> k & 1) != 0 && (mask >> source.swizzle[k] & 1) != 0) return true;
    }
    return false;
}

// Whether the two may change places.
bool commute(const FlowCode& code, const VirtualInstruction& a, const VirtualInstruction& b) {
    return !(a.target == b.target && (a.mask & b.mask) != 0) &&
           !reads_lane_of(code, a, b.target, b.mask) && !reads_lane_of(code, b, a.target, a.mask);
}

float number(std::uint32_t bits) { return std::bit_cast<float>(bits); }

// b after a, where b scales and shifts what a computes; `a` writes every lane that b reads.
Affine composed(const Affine& a, const Affine& b) {
    Affine result;
    result.mask = b.mask;
    result.x = a.x;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t lane = b.x->swizzle[k];
        result.x->swizzle[k] = a.x->swizzle[lane];
        if ((b.mask >> k & 1) == 0) continue;
        const float scale = number(b.scale[k]) * (b.x->negate ? -1.0f : 1.0f);
        result.scale[k] = std::bit_cast<std::uint32_t>(scale * number(a.scale[lane]));
        result.shift[k] =
            std::bit_cast<std::uint32_t>(scale * number(a.shift[lane]) + number(b.shift[k]));
    }
    return result;
}

// x k + c, then + d, is x k + (c + d): rounding alone differs.
class Composing {
  public:
    explicit Composing(FlowCode& code) : code_(code) {}

    bool run() {
        bool any = false;
        for (std::size_t j = 0; j < code_.instructions.size(); ++j) {
            const auto b = affine_of(code_.instructions[j]);
            if (!b || !b->x || b->x->kind != VirtualSource::Kind::Temp || b->x->absolute) continue;
            const auto i = maker_of(j, *b);
            if (!i) continue;
            const auto made = instruction_for(composed(*affine_of(code_.instructions[*i]), *b),
                                              code_.instructions[j]);
            if (!made) continue;
            code_.instructions[j] = *made;
            any = true;
        }
        return any;
    }

  private:
    // The instruction just before in the same straight run that computes x for this one alone.
    std::optional<std::size_t> maker_of(std::size_t j, const Affine& b) const {
        Mask wanted = 0;
        for (std::size_t k = 0; k < 4; ++k)
            if ((b.mask >> k & 1) != 0) wanted = static_cast<Mask>(wanted | (1 << b.x->swizzle[k]));
        int readers = 0;
        for (const VirtualInstruction& other : code_.instructions)
            readers += reads_lane_of(code_, other, b.x->index, wanted);
        if (readers != 1) return std::nullopt;
        for (std::size_t i = j; i-- > 0 && writes(code_.instructions[i]);) {
            const VirtualInstruction& made = code_.instructions[i];
            if (made.target != b.x->index || (made.mask & wanted) == 0) continue;
            const auto a = affine_of(made);
            if ((made.mask & wanted) != wanted || !a || !a->x) return std::nullopt;
            for (std::size_t k = i + 1; k < j; ++k)
                if (a->x->kind == VirtualSource::Kind::Temp &&
                    reads_lane_of(code_, made, code_.instructions[k].target,
                                  code_.instructions[k].mask))
                    return std::nullopt;
            // Nor what it reads by itself.
            if (reads_lane_of(code_, made, made.target, made.mask)) return std::nullopt;
            return i;
        }
        return std::nullopt;
    }

    FlowCode& code_;
};

bool names(const VirtualInstruction& instruction, int reg) {
    return instruction.target == reg ||
           std::any_of(instruction.sources.begin(), instruction.sources.end(),
                       [&](const VirtualSource& source) {
                           return source.kind == VirtualSource::Kind::Temp && source.index == reg;
                       });
}

class Fusing {
  public:
    explicit Fusing(FlowCode& code) : code_(code), merging_(code) {}

    bool run() {
        bool any = false;
        while (step()) any = true;
        return any;
    }

  private:
    bool step() {
        for (std::size_t i = 0; i < code_.instructions.size(); ++i) {
            if (!affine_of(code_.instructions[i])) continue;
            for (std::size_t j = i + 1;
                 j < code_.instructions.size() && writes(code_.instructions[j]); ++j)
                if (affine_of(code_.instructions[j]) && fuse(i, j)) return true;
        }
        return false;
    }

    bool fuse(std::size_t i, std::size_t j) {
        const int a = code_.instructions[i].target, b = code_.instructions[j].target;
        if (a == b) return fuse_in_place(code_, i, j) && finish();
        if (a < code_.outputs || b < code_.outputs) return false;
        // Lanes aside, could it be?
        const auto x = affine_of(code_.instructions[i])->x, y = affine_of(code_.instructions[j])->x;
        if (x && y && (x->kind != y->kind || x->index != y->index)) return false;
        for (const Permutation& lanes : all_permutations()) {
            if (!merging_.can_merge(b, a, lanes)) continue;
            if (!would_join(i, j, lanes)) continue;
            // On a copy: merging that does not help is not done.
            FlowCode trial = code_;
            bool all_left = true;
            for (VirtualInstruction& instruction : trial.instructions) {
                rename(instruction, b, a, lanes);
                all_left = drop_idle_lanes(instruction) && all_left;
            }
            if (!all_left || !fuse_in_place(trial, i, j)) continue;
            code_ = std::move(trial);
            return finish();
        }
        return false;
    }
    // Whether fuse_in_place() would do it, the second's register being the first's.
    bool would_join(std::size_t i, std::size_t j, const Permutation& lanes) const {
        VirtualInstruction first = code_.instructions[i], second = code_.instructions[j], other;
        const int into = first.target, from = second.target;
        const auto renamed = [&](VirtualInstruction& each) {
            rename(each, from, into, lanes);
            return drop_idle_lanes(each);
        };
        if (!renamed(first) || !renamed(second)) return false;
        const auto both = joined(*affine_of(first), *affine_of(second));
        if (!both || !instruction_for(*both, first) || !commute(code_, first, second)) return false;
        bool early = true, late = true;
        for (std::size_t k = i + 1; k < j && (early || late); ++k) {
            const VirtualInstruction* between = &code_.instructions[k];
            if (names(*between, from)) {
                other = *between;
                if (!renamed(other)) return false;
                between = &other;
            }
            early = early && commute(code_, second, *between);
            late = late && commute(code_, first, *between);
        }
        return early || late;
    }
    bool finish() {
        merging_.refresh();
        return true;
    }

    // Writes both where the first stands, or where the second does.
    static bool fuse_in_place(FlowCode& code, std::size_t i, std::size_t j) {
        const auto a = affine_of(code.instructions[i]), b = affine_of(code.instructions[j]);
        const auto both = joined(*a, *b);
        if (!both) return false;
        const auto made = instruction_for(*both, code.instructions[i]);
        if (!made) return false;
        // What the first writes the second may not read, nor the other way about.
        if (!commute(code, code.instructions[i], code.instructions[j])) return false;
        bool early = true, late = true;
        for (std::size_t k = i + 1; k < j; ++k) {
            early = early && commute(code, code.instructions[j], code.instructions[k]);
            late = late && commute(code, code.instructions[i], code.instructions[k]);
        }
        if (!early && !late) return false;
        code.instructions[early ? i : j] = *made;
        code.instructions.erase(code.instructions.begin() +
                                static_cast<std::ptrdiff_t>(early ? j : i));
        return true;
    }

    FlowCode& code_;
    Merging merging_;
};

}  // namespace

bool fuse(FlowCode& code) {
    const bool composed_any = Composing(code).run();
    return Fusing(code).run() || composed_any;
}

}  // namespace intaglio::d3d9

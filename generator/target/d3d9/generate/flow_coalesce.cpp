// Registers become one where their lives allow it ("Register allocation & spilling via graph
// coloring", Chaitin 1982, by lanes): a value is then computed where a mov would have brought it,
// whatever lanes that are, since ps_3_0 takes any write mask and any swizzle.
#include <algorithm>
#include <bit>
#include <map>

#include "generator/target/d3d9/generate/flow_code.h"
#include "generator/target/d3d9/generate/flow_merge.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {

Merging::Merging(FlowCode& code) : code_(code) { refresh(); }

void Merging::refresh() {
    live_ = live_after(code_);
    const auto registers = static_cast<std::size_t>(code_.registers);
    used_.assign(registers, 0);
    read_.assign(registers, 0);
    restricted_.assign(registers, 0);
    constants_.assign(registers, {});
    macros_.clear();
    written_by_.resize(registers);
    for (std::vector<std::size_t>& list : written_by_) list.clear();
    for (std::size_t i = 0; i < code_.instructions.size(); ++i) {
        const VirtualInstruction& instruction = code_.instructions[i];
        for (std::size_t s = 0; s < instruction.sources.size(); ++s) {
            const VirtualSource& source = instruction.sources[s];
            if (source.kind == VirtualSource::Kind::Temp)
                ++read_[static_cast<std::size_t>(source.index)];
        }
        if (!writes(instruction)) continue;
        const auto target = static_cast<std::size_t>(instruction.target);
        written_by_[target].push_back(i);
        if (info(instruction.op).has(Trait::Macro)) macros_.push_back(i);
        used_[target] = static_cast<Mask>(used_[target] | instruction.mask);
        const Lanes lanes = info(instruction.op).lanes;
        const bool free = lanes == Lanes::Masked || lanes == Lanes::First || lanes == Lanes::Dot2 ||
                          lanes == Lanes::Dot3 || lanes == Lanes::Dot4 ||
                          lanes == Lanes::Coordinate;
        if (!free) restricted_[target] = 1;
        note_constants(instruction);
    }
}

void Merging::note_constants(const VirtualInstruction& instruction) {
    const auto target = static_cast<std::size_t>(instruction.target);
    const bool constant = is_copy(instruction) &&
                          instruction.sources[0].kind == VirtualSource::Kind::Constant &&
                          !instruction.sources[0].negate && !instruction.sources[0].absolute;
    for (std::size_t k = 0; k < 4; ++k) {
        if ((instruction.mask >> k & 1) == 0) continue;
        ConstantLane& lane = constants_[target][k];
        if (!constant || lane.state == ConstantLane::Varies) {
            lane.state = ConstantLane::Varies;
            continue;
        }
        const std::uint32_t bits = instruction.sources[0].wanted.bits[k];
        if (lane.state == ConstantLane::Same && lane.bits != bits)
            lane.state = ConstantLane::Varies;
        else
            lane = {ConstantLane::Same, bits};
    }
}

std::optional<std::uint32_t> Merging::constant_in(int reg, int lane) const {
    const ConstantLane& found =
        constants_[static_cast<std::size_t>(reg)][static_cast<std::size_t>(lane)];
    if (found.state != ConstantLane::Same) return std::nullopt;
    return found.bits;
}

// x is written while y holds what is still read.
bool Merging::overwrites(int a, int x, int b, int y) const {
    for (const std::size_t i : written_by_[static_cast<std::size_t>(a)]) {
        const VirtualInstruction& instruction = code_.instructions[i];
        if ((instruction.mask >> x & 1) == 0 || !live_.has(i, b, y)) continue;
        const bool same = is_copy(instruction) &&
                          instruction.sources[0].kind == VirtualSource::Kind::Temp &&
                          !instruction.sources[0].negate && !instruction.sources[0].absolute &&
                          instruction.sources[0].index == b &&
                          instruction.sources[0].swizzle[static_cast<std::size_t>(x)] == y;
        if (!same) return true;
    }
    return false;
}

bool Merging::interfere(int a, int x, int b, int y) const {
    const auto one = constant_in(a, x), other = constant_in(b, y);
    if (one && other && *one == *other) return false;
    return overwrites(a, x, b, y) || overwrites(b, y, a, x);
}

bool Merging::can_merge(int from, int into, const Permutation& lanes) const {
    if (from == into || from < code_.outputs) return false;
    const Mask mine = used(from), theirs = used(into);
    const bool moved = lanes != Permutation{0, 1, 2, 3};
    if (moved && restricted_[static_cast<std::size_t>(from)] != 0) return false;
    for (int x = 0; x < 4; ++x) {
        if ((mine >> x & 1) == 0) continue;
        const int y = lanes[static_cast<std::size_t>(x)];
        if ((theirs >> y & 1) != 0 && interfere(from, x, into, y)) return false;
    }
    return keeps_macros(from, into);
}

// Some macros may not write a register that they read.
bool Merging::keeps_macros(int from, int into) const {
    for (const std::size_t i : macros_) {
        const VirtualInstruction& instruction = code_.instructions[i];
        if (instruction.target != from && instruction.target != into) continue;
        for (const VirtualSource& source : instruction.sources)
            if (source.kind == VirtualSource::Kind::Temp &&
                (source.index == from || source.index == into))
                return false;
    }
    return true;
}

namespace {

void permute_positions(VirtualSource& source, const Permutation& lanes, Mask written) {
    Swizzle swizzle = source.swizzle;
    Wanted wanted;
    for (std::size_t k = 0; k < 4; ++k) {
        if ((written >> k & 1) == 0) continue;
        const auto to = static_cast<std::size_t>(lanes[k]);
        swizzle[to] = source.swizzle[k];
        if ((source.wanted.mask >> k & 1) == 0) continue;
        wanted.bits[to] = source.wanted.bits[k];
        wanted.mask = static_cast<Mask>(wanted.mask | (1 << to));
    }
    source.swizzle = swizzle;
    source.wanted = wanted;
}

Mask permuted(Mask mask, const Permutation& lanes) {
    Mask result = 0;
    for (std::size_t k = 0; k < 4; ++k)
        if ((mask >> k & 1) != 0) result = static_cast<Mask>(result | (1 << lanes[k]));
    return result;
}

}  // namespace

void rename(VirtualInstruction& instruction, int from, int into, const Permutation& lanes) {
    for (VirtualSource& source : instruction.sources) {
        if (source.kind != VirtualSource::Kind::Temp || source.index != from) continue;
        source.index = into;
        for (std::uint8_t& lane : source.swizzle) lane = static_cast<std::uint8_t>(lanes[lane]);
    }
    if (instruction.target != from) return;
    instruction.target = into;
    if (info(instruction.op).lanes == Lanes::Masked)
        for (VirtualSource& source : instruction.sources)
            permute_positions(source, lanes, instruction.mask);
    if (info(instruction.op).lanes == Lanes::Coordinate) {
        const Swizzle before = instruction.sampler_swizzle;
        for (std::size_t k = 0; k < 4; ++k)
            instruction.sampler_swizzle[static_cast<std::size_t>(lanes[k])] = before[k];
    }
    instruction.mask = permuted(instruction.mask, lanes);
}

bool drop_idle_lanes(VirtualInstruction& instruction) {
    if (!writes(instruction) || !is_copy(instruction)) return true;
    const VirtualSource& source = instruction.sources[0];
    if (source.kind != VirtualSource::Kind::Temp || source.negate || source.absolute ||
        source.index != instruction.target)
        return instruction.mask != 0;
    for (std::size_t k = 0; k < 4; ++k)
        if (source.swizzle[k] == k)
            instruction.mask = static_cast<Mask>(instruction.mask & ~(1 << k));
    return instruction.mask != 0;
}

void Merging::merge(int from, int into, const Permutation& lanes) {
    for (VirtualInstruction& instruction : code_.instructions) {
        rename(instruction, from, into, lanes);
        drop_idle_lanes(instruction);
    }
    std::erase_if(code_.instructions, [](const VirtualInstruction& instruction) {
        return is_copy(instruction) && instruction.mask == 0;
    });
    refresh();
}

const std::vector<Permutation>& all_permutations() {
    static const std::vector<Permutation> list = [] {
        std::vector<Permutation> result;
        Permutation next = {0, 1, 2, 3};
        do result.push_back(next);
        while (std::next_permutation(next.begin(), next.end()));
        return result;
    }();
    return list;
}

namespace {

// The source's register becomes the mov's, so that the mov has nothing to do.
bool absorb(Merging& merging, const FlowCode& code, const VirtualInstruction& mov) {
    const VirtualSource& source = mov.sources[0];
    if (!is_copy(mov) || source.kind != VirtualSource::Kind::Temp || source.negate ||
        source.absolute || source.index == mov.target)
        return false;
    // Outputs cannot be read, and a texture read brings its texel to an r#.
    if (mov.target < code.outputs &&
        (merging.reads_of(source.index) > 1 || merging.is_texel(source.index)))
        return false;
    for (const Permutation& lanes : all_permutations()) {
        bool fits = true;
        for (std::size_t k = 0; k < 4; ++k)
            fits = fits &&
                   ((mov.mask >> k & 1) == 0 || lanes[source.swizzle[k]] == static_cast<int>(k));
        if (!fits || !merging.can_merge(source.index, mov.target, lanes)) continue;
        merging.merge(source.index, mov.target, lanes);
        return true;
    }
    return false;
}

// Lanes that are written again with the constant that they hold in any case.
bool drop_repeated_constants(FlowCode& code, const Merging& merging) {
    bool any = false;
    LaneSet written(code.registers);
    // Lanes written outside of loops stay written.
    const std::vector<int> loops = loops_of(code);
    for (std::size_t i = 0; i < code.instructions.size(); ++i) {
        VirtualInstruction& instruction = code.instructions[i];
        if (!writes(instruction)) continue;
        for (int lane = 0; lane < 4; ++lane) {
            if ((instruction.mask >> lane & 1) == 0) continue;
            if (merging.constant_in(instruction.target, lane) &&
                written.has(instruction.target, lane)) {
                instruction.mask = static_cast<Mask>(instruction.mask & ~(1 << lane));
                any = true;
            } else if (loops[i] < 0) {
                written.insert(instruction.target, lane);
            }
        }
    }
    std::erase_if(code.instructions, [](const VirtualInstruction& instruction) {
        return writes(instruction) && instruction.mask == 0;
    });
    return any;
}

// Two registers that hold the same constant in a lane.
bool share_constant(Merging& merging, const FlowCode& code) {
    std::vector<int> holders;
    for (int reg = code.outputs; reg < code.registers; ++reg)
        for (int lane = 0; lane < 4; ++lane)
            if (merging.constant_in(reg, lane) && (holders.empty() || holders.back() != reg))
                holders.push_back(reg);
    for (const int a : holders)
        for (const int b : holders) {
            if (a == b) continue;
            for (const Permutation& lanes : all_permutations()) {
                bool shares = false;
                for (int x = 0; x < 4; ++x) {
                    const auto mine = merging.constant_in(a, x);
                    shares = shares || (mine && mine == merging.constant_in(
                                                            b, lanes[static_cast<std::size_t>(x)]));
                }
                if (!shares || !merging.can_merge(a, b, lanes)) continue;
                merging.merge(a, b, lanes);
                return true;
            }
        }
    return false;
}

}  // namespace

bool coalesce(FlowCode& code) {
    bool any = false;
    Merging merging(code);
    for (bool changed = true; changed; any = any || changed) {
        changed = false;
        // Outputs first: what is put together for one must not be put together elsewhere.
        for (const bool outputs : {true, false})
            for (std::size_t i = 0; i < code.instructions.size() && !changed; ++i)
                changed = writes(code.instructions[i]) &&
                          (code.instructions[i].target < code.outputs) == outputs &&
                          absorb(merging, code, code.instructions[i]);
        if (!changed) changed = share_constant(merging, code);
        if (drop_repeated_constants(code, merging)) {
            merging.refresh();
            changed = true;
        }
    }
    return any;
}

bool assign_registers(FlowCode& code, int temps) {
    Merging merging(code);
    std::vector<int> order, given;
    for (const VirtualInstruction& instruction : code.instructions)
        if (instruction.target >= code.outputs &&
            std::find(order.begin(), order.end(), instruction.target) == order.end())
            order.push_back(instruction.target);
    for (const int reg : order) {
        const auto fits = [&](int into) {
            for (const Permutation& lanes : all_permutations())
                if (merging.can_merge(reg, into, lanes)) {
                    merging.merge(reg, into, lanes);
                    return true;
                }
            return false;
        };
        if (!std::any_of(given.begin(), given.end(), fits)) given.push_back(reg);
    }
    std::map<int, int> numbers;
    for (const int reg : given)
        numbers.emplace(reg, code.outputs + static_cast<int>(numbers.size()));
    for (VirtualInstruction& instruction : code.instructions) {
        if (instruction.target >= code.outputs) instruction.target = numbers.at(instruction.target);
        for (VirtualSource& source : instruction.sources)
            if (source.kind == VirtualSource::Kind::Temp) source.index = numbers.at(source.index);
    }
    code.registers = code.outputs + static_cast<int>(numbers.size());
    return static_cast<int>(numbers.size()) <= temps;
}

}  // namespace intaglio::d3d9

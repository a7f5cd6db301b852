// Copies: read through, dropped where nothing reads them, and made before the loop.
#include <algorithm>

#include "generator/target/d3d9/generate/flow_code.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

// Lane `lane` of register `target` holds what lane source.swizzle[lane] of the source does, as far
// as no instruction between has written either.
struct Copy {
    int instruction;
    int lane;
};

class Copies {
  public:
    explicit Copies(FlowCode& code) : code_(code), available_(code.instructions.size()) {
        for (std::size_t i = 0; i < code.instructions.size(); ++i) {
            const VirtualInstruction& instruction = code.instructions[i];
            const bool absolute = instruction.op == Opcode::Abs && !instruction.saturate;
            if (!writes(instruction) || !(is_copy(instruction) || absolute)) continue;
            for (int lane = 0; lane < 4; ++lane)
                if ((instruction.mask >> lane & 1) != 0)
                    copies_.push_back({static_cast<int>(i), lane});
        }
        find_available();
    }

    bool run() {
        bool changed = false;
        for (std::size_t i = 0; i < code_.instructions.size(); ++i)
            for (std::size_t s = 0; s < code_.instructions[i].sources.size(); ++s)
                changed = replace(i, s) || changed;
        return changed;
    }

  private:
    using Set = std::vector<char>;  // of copies_

    const VirtualInstruction& maker(const Copy& copy) const {
        return code_.instructions[static_cast<std::size_t>(copy.instruction)];
    }

    void step(std::size_t i, Set& set) const {
        const VirtualInstruction& instruction = code_.instructions[i];
        if (!writes(instruction)) return;
        const auto is_written = [&](int reg, int lane) {
            return instruction.target == reg && (instruction.mask >> lane & 1) != 0;
        };
        for (std::size_t c = 0; c < copies_.size(); ++c) {
            const VirtualInstruction& mov = maker(copies_[c]);
            const VirtualSource& source = mov.sources[0];
            const int from = source.swizzle[static_cast<std::size_t>(copies_[c].lane)];
            const bool own = copies_[c].instruction == static_cast<int>(i);
            if (own) set[c] = 1;
            if (!own && is_written(mov.target, copies_[c].lane)) set[c] = 0;
            if (source.kind == VirtualSource::Kind::Temp && is_written(source.index, from))
                set[c] = 0;
        }
    }

    // What holds on every way to each instruction.
    void find_available() {
        const auto successors = successors_of(code_);
        std::vector<char> reached(code_.instructions.size());
        if (reached.empty()) return;
        reached[0] = 1;
        available_[0] = Set(copies_.size());
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t i = 0; i < code_.instructions.size(); ++i) {
                if (reached[i] == 0) continue;
                Set set = available_[i];
                step(i, set);
                for (const int next : successors[i]) {
                    if (next < 0 || next >= static_cast<int>(reached.size())) continue;
                    const auto n = static_cast<std::size_t>(next);
                    Set meet = set;
                    for (std::size_t c = 0; reached[n] != 0 && c < meet.size(); ++c)
                        meet[c] = static_cast<char>(meet[c] & available_[n][c]);
                    changed = changed || reached[n] == 0 || meet != available_[n];
                    reached[n] = 1;
                    available_[n] = std::move(meet);
                }
            }
        }
    }

    // The copy that a lane holds there.
    const Copy* copy_in(std::size_t at, int reg, int lane) const {
        for (std::size_t c = 0; c < copies_.size(); ++c)
            if (available_[at][c] != 0 && copies_[c].lane == lane &&
                maker(copies_[c]).target == reg)
                return &copies_[c];
        return nullptr;
    }

    bool replace(std::size_t at, std::size_t s) {
        VirtualInstruction& instruction = code_.instructions[at];
        const VirtualSource old = instruction.sources[s];
        if (old.kind != VirtualSource::Kind::Temp || available_[at].empty()) return false;
        const Mask positions = positions_of_source(code_, instruction, s);
        std::optional<VirtualSource> found;
        int first = -1;
        for (std::size_t k = 0; k < 4; ++k) {
            if ((positions >> k & 1) == 0) continue;
            const Copy* copy = copy_in(at, old.index, old.swizzle[k]);
            if (copy == nullptr) return false;
            const VirtualSource& source = maker(*copy).sources[0];
            const bool absolute = source.absolute || maker(*copy).op == Opcode::Abs;
            const auto lane = static_cast<std::size_t>(copy->lane);
            if (!found) {
                found = source;
                found->absolute = absolute;
                found->wanted = {};
                first = static_cast<int>(k);
            }
            if (found->kind != source.kind || found->index != source.index ||
                found->absolute != absolute || found->negate != source.negate)
                return false;
            found->swizzle[k] = source.swizzle[lane];
            if (source.kind == VirtualSource::Kind::Constant) {
                found->wanted.bits[k] = source.wanted.bits[lane];
                found->wanted.mask = static_cast<Mask>(found->wanted.mask | (1 << k));
            }
        }
        if (!found) return false;
        for (std::size_t k = 0; k < 4; ++k)
            if ((positions >> k & 1) == 0)
                found->swizzle[k] = found->swizzle[static_cast<std::size_t>(first)];
        if (positions == 1) found->swizzle = replicate(found->swizzle[0]);
        combine_signs(*found, old, at, first);
        VirtualInstruction trial = instruction;
        trial.sources[s] = *found;
        if (!obeys_ports(trial)) return false;
        instruction = std::move(trial);
        return true;
    }
    // The reader's sign and absolute value go over the copy's.
    void combine_signs(VirtualSource& found, const VirtualSource& old, std::size_t at,
                       int first) const {
        const Copy& copy = *copy_in(at, old.index, old.swizzle[static_cast<std::size_t>(first)]);
        const bool inside = maker(copy).sources[0].negate && maker(copy).op != Opcode::Abs;
        found.negate = old.absolute ? old.negate : old.negate != inside;
        found.absolute = found.absolute || old.absolute;
    }

    FlowCode& code_;
    std::vector<Copy> copies_;
    std::vector<Set> available_;  // before each instruction
};

// Registers' lanes that an instruction inside [from, to] writes.
LaneSet written_in(const FlowCode& code, std::size_t from, std::size_t to) {
    LaneSet written(code.registers);
    for (std::size_t i = from; i <= to; ++i) {
        const VirtualInstruction& instruction = code.instructions[i];
        for (int lane = 0; writes(instruction) && lane < 4; ++lane)
            if ((instruction.mask >> lane & 1) != 0) written.insert(instruction.target, lane);
    }
    return written;
}

bool is_written_once(const FlowCode& code, const VirtualInstruction& instruction) {
    int count = 0;
    for (const VirtualInstruction& other : code.instructions)
        count += writes(other) && other.target == instruction.target &&
                 (other.mask & instruction.mask) != 0;
    return count == 1;
}

// The first copy in the loop that could be made before it.
std::optional<std::size_t> invariant_copy(const FlowCode& code, std::size_t rep, std::size_t end) {
    const LaneSet written = written_in(code, rep, end);
    for (std::size_t i = rep + 1; i < end; ++i) {
        const VirtualInstruction& mov = code.instructions[i];
        if (!writes(mov) || !is_copy(mov) || mov.target < code.outputs) continue;
        const VirtualSource& source = mov.sources[0];
        bool same = true;
        for (std::size_t k = 0; k < 4 && source.kind == VirtualSource::Kind::Temp; ++k)
            same =
                same && ((mov.mask >> k & 1) == 0 || !written.has(source.index, source.swizzle[k]));
        if (same && is_written_once(code, mov)) return i;
    }
    return std::nullopt;
}

}  // namespace

bool propagate_copies(FlowCode& code) { return Copies(code).run(); }

bool remove_dead_lanes(FlowCode& code) {
    bool any = false;
    for (bool changed = true; changed;) {
        changed = false;
        const LaneSets live = live_after(code);
        std::vector<VirtualInstruction> kept;
        for (std::size_t i = 0; i < code.instructions.size(); ++i) {
            VirtualInstruction instruction = std::move(code.instructions[i]);
            if (writes(instruction)) {
                Mask mask = 0;
                for (int lane = 0; lane < 4; ++lane)
                    if ((instruction.mask >> lane & 1) != 0 &&
                        live.has(i, instruction.target, lane))
                        mask = static_cast<Mask>(mask | (1 << lane));
                if (mask != 0 && info(instruction.op).has(Trait::Macro)) mask = instruction.mask;
                changed = changed || mask != instruction.mask;
                if (mask == 0) continue;
                instruction.mask = mask;
                for (VirtualSource& source : instruction.sources)
                    if (info(instruction.op).lanes == Lanes::Masked)
                        source.wanted.mask = static_cast<Mask>(source.wanted.mask & mask);
            }
            kept.push_back(std::move(instruction));
        }
        code.instructions = std::move(kept);
        any = any || changed;
    }
    return any;
}

bool remove_idle_loops(FlowCode& code) {
    bool any = false;
    for (std::size_t rep = code.instructions.size(); rep-- > 0;) {
        if (code.instructions[rep].op != Opcode::Rep) continue;
        std::size_t end = rep + 1;
        while (!writes(code.instructions[end]) && code.instructions[end].op != Opcode::EndRep &&
               code.instructions[end].op != Opcode::Rep)
            ++end;
        if (code.instructions[end].op != Opcode::EndRep) continue;
        const auto first = code.instructions.begin() + static_cast<std::ptrdiff_t>(rep);
        code.instructions.erase(first, first + static_cast<std::ptrdiff_t>(end - rep + 1));
        any = true;
    }
    return any;
}

bool hoist_copies(FlowCode& code) {
    bool any = false;
    for (std::size_t rep = 0; rep < code.instructions.size(); ++rep) {
        if (code.instructions[rep].op != Opcode::Rep) continue;
        for (;;) {
            const std::vector<int> loops = loops_of(code);
            std::size_t end = rep;
            for (std::size_t i = rep; i < loops.size(); ++i)
                if (code.instructions[i].op == Opcode::EndRep && loops[i] == static_cast<int>(rep))
                    end = i;
            const auto found = invariant_copy(code, rep, end);
            if (!found) break;
            const auto at = [&](std::size_t i) {
                return code.instructions.begin() + static_cast<std::ptrdiff_t>(i);
            };
            std::rotate(at(rep), at(*found), at(*found + 1));
            ++rep;
            any = true;
        }
    }
    return any;
}

}  // namespace intaglio::d3d9

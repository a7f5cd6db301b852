// Virtual registers to r#, lane by lane: a lane is busy from its write to its last read, so that
// scalars live in the holes of vectors.  Where dependent texture reads are counted (facts: a read
// into a register that was written before comes after it, and an order never falls), each value has
// a highest order that still lets the last read through; among the registers that keep to it, the
// one of the highest order is taken, and fresh ones are left for the reads that need them.
#include <algorithm>
#include <bit>

#include "generator/target/d3d9/generate/code.h"

namespace intaglio::d3d9 {

Mask positions_read(const VirtualInstruction& instruction) {
    switch (instruction.op) {
        case Opcode::Dp3: return 7;
        case Opcode::Dp4:
        case Opcode::Texldl: return full_mask;
        case Opcode::Texld:
        case Opcode::Texldd: return 3;
        default: return instruction.mask;
    }
}

namespace {

struct Interval {
    int begin = 0, end = -1;  // writes at 2 i + 1, reads at 2 i
};

class Allocator {
  public:
    Allocator(const Code& code, const Limits& limits)
        : code_(code),
          limits_(limits),
          intervals_(code.lanes.size()),
          budget_(code.lanes.size()),
          allowed_(code.instructions.size()),
          registers_(static_cast<std::size_t>(limits.temps)) {
        result_.places.resize(code.lanes.size());
    }

    Allocation run() {
        find_intervals();
        find_budgets();
        for (std::size_t i = 0; i < code_.instructions.size() && !result_.failure; ++i)
            step(static_cast<int>(i));
        return std::move(result_);
    }

  private:
    struct Register {
        std::array<std::vector<Interval>, 4> busy;
        std::vector<std::size_t> residents;  // virtual registers that were given it
        int order = 0;
        bool written = false;
    };
    using Lanes = std::array<std::vector<Interval>, 4>;  // from each write to its last read

    void find_intervals() {
        for (std::size_t i = 0; i < code_.instructions.size(); ++i) {
            const VirtualInstruction& instruction = code_.instructions[i];
            const int now = static_cast<int>(i);
            for (std::size_t s = 0; s < instruction.sources.size(); ++s) {
                const VirtualSource& source = instruction.sources[s];
                if (source.kind != VirtualSource::Kind::Temp) continue;
                Lanes& lanes = intervals_[static_cast<std::size_t>(source.index)];
                const Mask mask = positions_read(instruction);
                for (std::size_t k = 0; k < 4; ++k)
                    if ((mask >> k & 1) != 0 && !lanes[source.swizzle[k]].empty())
                        lanes[source.swizzle[k]].back().end =
                            std::max(lanes[source.swizzle[k]].back().end, 2 * now);
            }
            if (instruction.target < 0) continue;
            Lanes& lanes = intervals_[static_cast<std::size_t>(instruction.target)];
            for (std::size_t k = 0; k < 4; ++k)
                if ((instruction.mask >> k & 1) != 0)
                    lanes[k].push_back({2 * now + 1, 2 * now + 1});
        }
    }
    void find_budgets() {
        std::fill(budget_.begin(), budget_.end(), limits_.dependent_level);
        for (std::size_t i = code_.instructions.size(); i-- > 0;) {
            const VirtualInstruction& instruction = code_.instructions[i];
            if (instruction.op == Opcode::Texkill) {
                int& tested = budget_[static_cast<std::size_t>(instruction.sources[0].index)];
                tested = std::min(tested, limits_.dependent_level - 1);
            }
            if (instruction.target < 0) continue;
            const int mine = budget_[static_cast<std::size_t>(instruction.target)];
            allowed_[i] = mine;
            for (const VirtualSource& source : instruction.sources) {
                if (source.kind != VirtualSource::Kind::Temp) continue;
                int& theirs = budget_[static_cast<std::size_t>(source.index)];
                theirs = std::min(theirs, instruction.sampler >= 0 ? mine - 1 : mine);
            }
        }
    }

    int order_of_sources(const VirtualInstruction& instruction, bool& from_temp) const {
        int order = 0;
        for (const VirtualSource& source : instruction.sources) {
            if (source.kind != VirtualSource::Kind::Temp) continue;
            from_temp = true;
            const int number = result_.places[static_cast<std::size_t>(source.index)].number;
            order = std::max(order, registers_[static_cast<std::size_t>(number)].order);
        }
        return order;
    }
    // The order of a register after the instruction has written it.
    int order_after(const VirtualInstruction& instruction, const Register& into) const {
        bool from_temp = false;
        const int order = std::max(into.order, order_of_sources(instruction, from_temp));
        if (instruction.sampler < 0) return order;
        return from_temp || into.written ? order + 1 : 0;
    }

    bool is_free(const Register& candidate, const Lanes& wanted, Mask mask, int shift) const {
        for (int k = 0; k < 4; ++k) {
            if ((mask >> k & 1) == 0) continue;
            for (const Interval& mine : wanted[static_cast<std::size_t>(k)])
                for (const Interval& other : candidate.busy[static_cast<std::size_t>(k + shift)])
                    if (mine.begin <= other.end && other.begin <= mine.end) return false;
        }
        return true;
    }
    // What lives there and is read later must not come to wait for more than it may.
    bool disturbs(const Register& candidate, int order, int now) const {
        for (const std::size_t resident : candidate.residents)
            for (const std::vector<Interval>& lane : intervals_[resident])
                if (!lane.empty() && lane.back().end > 2 * now + 1 && order > budget_[resident])
                    return true;
        return false;
    }
    int busy_lanes(const Register& candidate, int time) const {
        int count = 0;
        for (const auto& lane : candidate.busy)
            count += std::any_of(lane.begin(), lane.end(), [&](const Interval& interval) {
                return interval.begin <= time && time <= interval.end;
            });
        return count;
    }

    bool choose(const VirtualInstruction& instruction, int now) {
        const auto target = static_cast<std::size_t>(instruction.target);
        const Lanes& wanted = intervals_[target];
        const Mask mask = code_.lanes[target];
        const bool movable = std::has_single_bit(mask);
        int best = -1, best_shift = 0;
        std::array<int, 3> best_score{};
        bool any_free = false;
        for (std::size_t r = 0; r < registers_.size(); ++r) {
            const Register& candidate = registers_[r];
            for (int shift = -3; shift <= 3; ++shift) {
                if (shift != 0 && !movable) continue;
                const unsigned moved =
                    shift >= 0 ? unsigned(mask) << shift : unsigned(mask) >> -shift;
                if (movable && (moved == 0 || moved > full_mask)) continue;
                if (!is_free(candidate, wanted, mask, shift)) continue;
                any_free = true;
                const int order = order_after(instruction, candidate);
                if (order > allowed_[static_cast<std::size_t>(now)]) continue;
                if (order > candidate.order && disturbs(candidate, order, now)) continue;
                const std::array<int, 3> score = {candidate.order, candidate.written ? 1 : 0,
                                                  busy_lanes(candidate, 2 * now + 1)};
                if (best >= 0 && score <= best_score) continue;
                best = static_cast<int>(r);
                best_shift = shift;
                best_score = score;
            }
        }
        if (best < 0) {
            result_.failure =
                any_free ? AllocationFailure::DependentReads : AllocationFailure::Temps;
            // With more registers there would always be a fresh one, unless even that is too late.
            if (any_free &&
                order_after(instruction, Register{}) <= allowed_[static_cast<std::size_t>(now)])
                result_.failure = AllocationFailure::Temps;
            result_.failed_at = now;
            return false;
        }
        result_.places[target] = {best, best_shift, std::countr_zero(static_cast<unsigned>(mask))};
        Register& chosen = registers_[static_cast<std::size_t>(best)];
        chosen.residents.push_back(target);
        for (int k = 0; k < 4; ++k)
            if ((mask >> k & 1) != 0)
                for (const Interval& interval : wanted[static_cast<std::size_t>(k)])
                    chosen.busy[static_cast<std::size_t>(k + best_shift)].push_back(interval);
        return true;
    }

    void step(int now) {
        const VirtualInstruction& instruction = code_.instructions[static_cast<std::size_t>(now)];
        if (instruction.op == Opcode::Texkill) {
            const auto tested = static_cast<std::size_t>(instruction.sources[0].index);
            Register& read = registers_[static_cast<std::size_t>(result_.places[tested].number)];
            if (++read.order > limits_.dependent_level) fail_for_reads(now);
        }
        if (instruction.target < 0) return;
        const auto target = static_cast<std::size_t>(instruction.target);
        if (result_.places[target].number < 0 && !choose(instruction, now)) return;
        Register& into = registers_[static_cast<std::size_t>(result_.places[target].number)];
        into.order = order_after(instruction, into);
        into.written = true;
        if (into.order > allowed_[static_cast<std::size_t>(now)]) fail_for_reads(now);
    }
    void fail_for_reads(int now) {
        result_.failure = AllocationFailure::DependentReads;
        result_.failed_at = now;
    }

    const Code& code_;
    const Limits& limits_;
    std::vector<Lanes> intervals_;
    std::vector<int> budget_;   // by virtual register, by the reads seen so far from the end
    std::vector<int> allowed_;  // by instruction: the highest order that its target may have then
    std::vector<Register> registers_;
    Allocation result_;
};

}  // namespace

Allocation allocate(const Code& code, const Limits& limits) {
    return Allocator(code, limits).run();
}

}  // namespace intaglio::d3d9

// Moves that need not be: what a mov copies may be completed where it lies.  Two virtual registers
// become one, whose lanes are written again once nothing reads them any more.
#include "generator/target/d3d9/generate/code.h"

namespace intaglio::d3d9 {
namespace {

class Coalesce {
  public:
    explicit Coalesce(Code& code) : code_(code) {}

    void run() {
        for (std::size_t i = 0; i < code_.instructions.size();)
            if (is_copy(i) && copies_nothing(i))
                code_.instructions.erase(code_.instructions.begin() +
                                         static_cast<std::ptrdiff_t>(i));
            else
                ++i;
    }

  private:
    using Kind = VirtualSource::Kind;

    const VirtualInstruction& at(std::size_t i) const { return code_.instructions[i]; }
    bool is_copy(std::size_t i) const {
        return at(i).op == Opcode::Mov && at(i).target >= 0 && !at(i).saturate &&
               !at(i).sources[0].negate && !at(i).sources[0].absolute;
    }

    bool writes(std::size_t i, int target, int lane) const {
        return at(i).target == target && (at(i).mask >> lane & 1) != 0;
    }
    bool reads(std::size_t i, int target, int lane) const {
        const Mask positions = positions_read(at(i));
        for (const VirtualSource& source : at(i).sources)
            for (std::size_t k = 0; k < 4; ++k)
                if (source.kind == Kind::Temp && source.index == target &&
                    (positions >> k & 1) != 0 && source.swizzle[k] == lane)
                    return true;
        return false;
    }
    int first_write(int target, int lane) const {
        for (std::size_t i = 0; i < code_.instructions.size(); ++i)
            if (writes(i, target, lane)) return static_cast<int>(i);
        return static_cast<int>(code_.instructions.size());
    }
    // The last instruction that touches the lane; -1 if none does.
    int last_use(int target, int lane) const {
        for (std::size_t i = code_.instructions.size(); i-- > 0;) {
            if (reads(i, target, lane)) return static_cast<int>(i);
            // A result that nothing reads still needs its place.
            if (writes(i, target, lane)) return static_cast<int>(i) + 1;
        }
        return -1;
    }
    Mask lanes(int target) const { return code_.lanes[static_cast<std::size_t>(target)]; }

    // Whether the lanes of `later` can live in `earlier` once that has done with its own.
    bool follows(int earlier, int later, Mask but) const {
        for (int lane = 0; lane < 4; ++lane) {
            if ((lanes(later) & ~but) >> lane & 1 &&
                last_use(earlier, lane) > first_write(later, lane))
                return false;
        }
        return true;
    }
    void merge(int earlier, int later) {
        for (VirtualInstruction& instruction : code_.instructions) {
            if (instruction.target == later) instruction.target = earlier;
            for (VirtualSource& source : instruction.sources)
                if (source.kind == Kind::Temp && source.index == later) source.index = earlier;
        }
        const Mask both = static_cast<Mask>(lanes(earlier) | lanes(later));
        code_.lanes[static_cast<std::size_t>(earlier)] = both;
        code_.lanes[static_cast<std::size_t>(later)] = 0;
    }

    // mov t, s lane for lane: the rest of t goes to s.
    bool copies_nothing(std::size_t i) {
        const VirtualSource& source = at(i).sources[0];
        const int target = at(i).target;
        if (source.kind != Kind::Temp || source.index == target) return false;
        for (int lane = 0; lane < 4; ++lane) {
            if ((at(i).mask >> lane & 1) == 0) continue;
            if (source.swizzle[static_cast<std::size_t>(lane)] != lane) return false;
            // Written once: what is copied stays.
            for (std::size_t j = 0; j < code_.instructions.size(); ++j)
                if (j != i && (writes(j, target, lane) || (j > i && writes(j, source.index, lane))))
                    return false;
        }
        if (!follows(source.index, target, at(i).mask)) return false;
        merge(source.index, target);
        return true;
    }

    Code& code_;
};

}  // namespace

void coalesce(Code& code) { Coalesce(code).run(); }

}  // namespace intaglio::d3d9

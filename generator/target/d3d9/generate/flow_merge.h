// Which registers of code with loops can be one, by lanes.  Private to the passes that merge them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "generator/target/d3d9/generate/flow_code.h"

namespace intaglio::d3d9 {

using Permutation = std::array<int, 4>;              // lane k goes to lane [k]
const std::vector<Permutation>& all_permutations();  // the identity first

// What was in register `from` is in `into`, its lanes there.
void rename(VirtualInstruction& instruction, int from, int into, const Permutation& lanes);
// Of a mov, those from a lane to itself; whether it has anything left to do.
bool drop_idle_lanes(VirtualInstruction& instruction);

class Merging {
  public:
    explicit Merging(FlowCode& code);
    // To be called after any other change of the code.
    void refresh();

    // Whether `from` can live in `into`, its lanes there: no lane is overwritten that is still
    // read.
    bool can_merge(int from, int into, const Permutation& lanes) const;
    // Does it, and drops the movs that have nothing left to do.
    void merge(int from, int into, const Permutation& lanes);

    Mask used(int reg) const { return used_[static_cast<std::size_t>(reg)]; }
    // How many operands read the register.
    int reads_of(int reg) const { return read_[static_cast<std::size_t>(reg)]; }
    bool is_texel(int reg) const {
        for (const std::size_t i : written_by_[static_cast<std::size_t>(reg)])
            if (code_.instructions[i].sampler >= 0) return true;
        return false;
    }
    // The one constant that is ever written there.
    std::optional<std::uint32_t> constant_in(int reg, int lane) const;

  private:
    struct ConstantLane {
        enum State : char { Unwritten, Same, Varies } state = Unwritten;
        std::uint32_t bits = 0;
    };

    void note_constants(const VirtualInstruction& instruction);
    bool overwrites(int a, int x, int b, int y) const;
    bool interfere(int a, int x, int b, int y) const;
    bool keeps_macros(int from, int into) const;

    FlowCode& code_;
    LaneSets live_;
    std::vector<Mask> used_;
    std::vector<int> read_;
    std::vector<char> restricted_;  // written by a macro whose lanes are not free
    std::vector<std::array<ConstantLane, 4>> constants_;
    std::vector<std::vector<std::size_t>> written_by_;
    std::vector<std::size_t> macros_;
};

}  // namespace intaglio::d3d9

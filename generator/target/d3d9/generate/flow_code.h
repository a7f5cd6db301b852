// Placed instructions with loops among them: rep, break_comp and endrep stand in the list, and a
// lane of a virtual register may be written in several places.  What is tidied here knows any
// swizzle and any write mask, so it is for ps_3_0.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "generator/target/d3d9/generate/code.h"

namespace intaglio::d3d9 {

struct FlowCode {
    std::vector<VirtualInstruction> instructions;
    int registers = 0;                  // virtual ones
    int outputs = 0;                    // the first so many are oC0, oC1 ..., which nothing reads
    std::vector<SamplerKind> samplers;  // by s#
};

// Arithmetic and texture slots.
int slots_of(const FlowCode& code);

// The positions at which an instruction looks at a source.
Mask positions_of_source(const FlowCode& code, const VirtualInstruction& instruction,
                         std::size_t source);
// Writes a register: neither flow nor a test.
bool writes(const VirtualInstruction& instruction);
// A mov that only copies.
bool is_copy(const VirtualInstruction& instruction);
// Where execution can go on after each instruction, the number of them being the end; -1: there is
// no second way.
std::vector<std::array<int, 2>> successors_of(const FlowCode& code);
// The rep of the innermost loop around each instruction, rep and endrep included; -1: none.
std::vector<int> loops_of(const FlowCode& code);
// Whether all sources may stand together in one ps_3_0 instruction: one v#, one c#, textures'
// coordinates without sign.
bool obeys_ports(const VirtualInstruction& instruction);

// One bit for each lane of each register.
class LaneSet {
  public:
    explicit LaneSet(int registers = 0)
        : words_((static_cast<std::size_t>(registers) * 4 + 63) / 64) {}
    bool has(int reg, int lane) const { return (words_[word(reg)] >> bit(reg, lane) & 1) != 0; }
    void insert(int reg, int lane) { words_[word(reg)] |= std::uint64_t{1} << bit(reg, lane); }
    void erase(int reg, int lane) { words_[word(reg)] &= ~(std::uint64_t{1} << bit(reg, lane)); }
    static std::size_t word(int reg) { return static_cast<std::size_t>(reg) / 16; }
    static unsigned bit(int reg, int lane) {
        return static_cast<unsigned>(reg % 16) * 4 + static_cast<unsigned>(lane);
    }

  private:
    std::vector<std::uint64_t> words_;
};

// A set of lanes for each instruction, all in one piece of memory.
class LaneSets {
  public:
    explicit LaneSets(std::size_t count = 0, int registers = 0)
        : width_((static_cast<std::size_t>(registers) * 4 + 63) / 64), words_(count * width_) {}
    bool has(std::size_t set, int reg, int lane) const {
        return (words_[set * width_ + LaneSet::word(reg)] >> LaneSet::bit(reg, lane) & 1) != 0;
    }
    void insert(std::size_t set, int reg, int lane) {
        words_[set * width_ + LaneSet::word(reg)] |= std::uint64_t{1} << LaneSet::bit(reg, lane);
    }
    std::size_t width() const { return width_; }
    std::uint64_t* words(std::size_t set) { return words_.data() + set * width_; }

  private:
    std::size_t width_;
    std::vector<std::uint64_t> words_;
};

// After each instruction: the lanes that are read later, whichever way execution goes.
LaneSets live_after(const FlowCode& code);

// Each keeps what the code computes and answers whether it changed anything.
//
// Reads of what a mov (or abs) copied read its source instead.
bool propagate_copies(FlowCode& code);
// Lanes that nothing reads are not written.
bool remove_dead_lanes(FlowCode& code);
// Loops that write nothing go.
bool remove_idle_loops(FlowCode& code);
// Copies of what no iteration changes are made before the loop.
bool hoist_copies(FlowCode& code);
// A value is computed where a mov would bring it, outputs included; constants are kept once.
bool coalesce(FlowCode& code);
// Two instructions that only scale and shift by constants become one: x and a constant side by side
// are x (1, 0) + (0, c), and one after the other is again such an instruction.  Rounding differs.
bool fuse(FlowCode& code);

// Numbers anew those that are named.
void drop_unused_registers(FlowCode& code);

// All of them until nothing changes.
void tidy(FlowCode& code);

// As few registers as first fit finds, of any lane order; false if they are more than `temps`.
// Afterwards virtual register `outputs` + n is r#n.
bool assign_registers(FlowCode& code, int temps);

}  // namespace intaglio::d3d9

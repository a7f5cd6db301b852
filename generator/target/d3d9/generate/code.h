// Instructions over virtual registers: what placement makes of the graph, and allocation and the
// constant pool of it.  Each lane of a virtual register is written once.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "generator/target/d3d9/generate/graph.h"
#include "generator/target/d3d9/limits.h"

namespace intaglio::d3d9 {

// Floats that a definition must hold, by the position that the reading instruction sees them at.
struct Wanted {
    std::array<std::uint32_t, 4> bits{};
    Mask mask = 0;
    friend bool operator==(const Wanted&, const Wanted&) = default;
};

struct VirtualSource {
    enum class Kind : std::uint8_t { Temp, Constant, Uniform, Input };
    Kind kind = Kind::Temp;
    int index = 0;  // virtual register, c#, t# or v#; of a constant, its definition once pooled
    Swizzle swizzle = identity_swizzle;
    bool negate = false;
    bool absolute = false;  // before the sign
    Wanted wanted;          // Constant
    friend bool operator==(const VirtualSource&, const VirtualSource&) = default;
};

struct VirtualInstruction {
    Opcode op = Opcode::Mov;
    int target = -1;  // virtual register
    int output = -1;  // or number of the graph's output; texkill has neither, but a source
    Mask mask = full_mask;
    bool saturate = false;
    int sampler = -1;
    std::vector<VirtualSource> sources;
    ir::Origin origin;
    // Code with loops alone, see flow_code.h.
    Comparison comparison = Comparison::None;  // break_comp
    int repeats = 0;                           // rep
    Swizzle sampler_swizzle = identity_swizzle;
    friend bool operator==(const VirtualInstruction&, const VirtualInstruction&) = default;
};

// The positions of its operands that an instruction looks at.
Mask positions_read(const VirtualInstruction& instruction);

struct Code {
    std::vector<VirtualInstruction> instructions;
    std::vector<Mask> lanes;  // of each virtual register: those that are ever written
    friend bool operator==(const Code&, const Code&) = default;
};

// Which component each lane sees, so that position k gets component lanes[k] (-1: any); nothing if
// the profile has no such swizzle.
std::optional<Swizzle> find_swizzle(const std::array<int, 4>& lanes, const Limits& limits);

// Chooses lanes for the nodes' results and writes the instructions in this order, with the moves
// that swizzles, ports and texture coordinates need.  `uniform_registers` gives each uniform's
// first c#.
Code place(const Graph& graph, const std::vector<int>& order, const Limits& limits,
           const std::vector<int>& uniform_registers);

// Drops moves by letting two virtual registers be one, lanes of which are then written again when
// nothing reads them any more.
void coalesce(Code& code);

// Outputs of vertex shaders take lanes, signs and any arithmetic: what a mov to an output alone
// reads is written there instead, and the mov goes.
void write_outputs_directly(Code& code);

// What a mov brings to the lanes that texkill tests is computed there, and the mov goes.
void compute_in_tested_lanes(Code& code);

// Definitions for the constants that instructions want; sets the sources' index and swizzle.
// Nothing if more than `limits.constants` would be needed; `first` is the first free c#.
std::optional<std::vector<Definition>> pool_constants(Code& code, const Limits& limits, int first);
// Whether one definition can serve both.
bool can_share(const Wanted& a, const Wanted& b, const Limits& limits);

// Why registers could not be given.
enum class AllocationFailure : std::uint8_t { Temps, DependentReads };
struct Allocation {
    struct Place {
        int number = -1;
        int shift = 0;      // what is added to the lane: not 0 only where a register has one lane
        int only_lane = 0;  // that one, before the shift
    };
    std::vector<Place> places;  // by virtual register
    std::optional<AllocationFailure> failure;
    int failed_at = -1;  // instruction
};
Allocation allocate(const Code& code, const Limits& limits);

}  // namespace intaglio::d3d9

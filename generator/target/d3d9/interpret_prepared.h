// A shader made ready to run: operands checked against the register files, blocks matched, so that
// the machine (interpret.cpp) never looks anything up.  Private to the interpreter.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "generator/target/d3d9/interpret.h"

namespace intaglio::d3d9 {

inline constexpr int temp_count = 32, constant_count = 256, flow_constant_count = 16;

// Everything a shader can write besides temps, addresses and predicates, in one row of vectors.
enum OutputSlot : int {
    colour_slot = 0,
    depth_slot = 4,
    position_slot,
    fog_slot,
    point_size_slot,
    diffuse_slot,
    texcoord_slot = diffuse_slot + 2,
    output_slot = texcoord_slot + 8,
    output_slot_count = output_slot + 12,
};

struct Interpreter::Prepared {
    struct Step {
        Instruction instruction;
        int target = -1;  // opens: the else or end of the block; end of a loop: its begin; calls:
                          // the label; break: the end of its loop
        int output = -1;  // OutputSlot of the destination, if it is none of r, a0, p0
        int sampler = -1;
    };
    std::vector<Step> steps;
    std::array<bool, constant_count> defined{};
    std::array<Vector, constant_count> definitions{};
    std::array<bool, flow_constant_count> integer_defined{}, boolean_defined{};
    std::array<std::array<int, 4>, flow_constant_count> integer_definitions{};
    std::array<bool, flow_constant_count> boolean_definitions{};
    bool loses_sincos = false;  // shader model 2
};

}  // namespace intaglio::d3d9

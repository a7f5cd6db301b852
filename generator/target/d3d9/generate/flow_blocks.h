// A module with loops as straight blocks between loop borders and exits.  What one block computes
// and another reads is a variable: a register that lives as long as anything may still read it.
#pragma once

#include <vector>

#include "generator/base/result.h"
#include "generator/ir/module.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

struct FlowStep {
    enum class Kind : std::uint8_t { Block, Rep, Break, EndRep };
    Kind kind = Kind::Block;
    int block = 0;                             // Block
    int repeats = 0;                           // Rep: 1 to 255
    Comparison comparison = Comparison::None;  // Break: if variable `left` so to `right`
    int left = 0, right = 0;
    ir::Origin origin;
};

struct FlowBlock {
    // Reads variable v as input inputs + v; its outputs go to `targets`, all at once.
    ir::Module module;
    // Of each output: the variable that it is assigned to, or -1 - k for output k of the shader.
    std::vector<int> targets;
};

struct Flow {
    std::vector<FlowStep> steps;
    std::vector<FlowBlock> blocks;
    int inputs = 0;           // of the module
    std::vector<int> widths;  // components of each variable
};

// The most iterations that one rep can run (facts: `defi` above is refused), and how deep reps
// nest.
inline constexpr int most_repeats = 255;
inline constexpr int most_nested = 4;

// Loops of more than 255 iterations to loops in loops, the outer left when the inner was.
void split_long_loops(ir::Module& module);

// Of a module without ifs.  Refuses [d3d9-loop] loops nested deeper than 4.
Result<Flow> cut_into_blocks(const ir::Module& module);

}  // namespace intaglio::d3d9

// Who spends the slots of a shader: by step of the technique and line of C++, with what is left of
// every resource and how deep each texture read hangs on others.
#pragma once

#include <string>
#include <vector>

#include "generator/target/d3d9/ops.h"
#include "generator/target/d3d9/resources.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// Slots of all instructions with one origin.
struct Spent {
    std::string step;  // empty: work outside the steps
    std::string file;  // empty: unknown
    int line = 0;
    Slots slots;
};

struct TextureRead {
    int level = 0;        // dependent-read order: 0 waits for no other read
    std::string sampler;  // its name in the constant table, else "s0"
    std::string step, file;
    int line = 0;
};

struct Explanation {
    Slots slots;
    std::vector<Spent> steps;  // most slots first; without file and line
    std::vector<Spent> lines;  // in the order of steps, most slots first
    std::vector<Headroom> headroom;
    std::vector<TextureRead> reads;  // in the order of the instructions
};
Explanation explain(const Shader& shader);

// Sums one row an instruction by step and by line: slots, steps and lines of an explanation.
Explanation sum_up(const std::vector<Spent>& instructions);

}  // namespace intaglio::d3d9

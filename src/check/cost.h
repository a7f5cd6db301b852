// Static cost of a SPIR-V module: what a compiler for a GPU is given, before it does its own work.
#pragma once

#include <cstdint>

#include "generator/base/result.h"
#include "src/check/source.h"

namespace intaglio::check {

// Numbers of SPIR-V instructions, vector instructions counting once.  Not counted, because they
// name or rearrange values that hardware reaches without an instruction: constants, access chains,
// composite construction, extraction and shuffles, copies, phi, loads of textures and samplers,
// calls themselves, unconditional branches.
struct SpirvCost {
    int alu = 0;      // arithmetic, comparison, selection, conversion, derivatives, GLSL.std.450
    int texture = 0;  // samples, fetches, gathers, queries
    int branch = 0;   // conditional branches, switches, discards
    int memory = 0;   // loads and stores of variables, image reads and writes, atomics
    int total = 0;    // the sum of the four
    // The same instructions along one way through the entry point, calls included; control_flow.h
    // says how loops count.
    std::int64_t shortest_path = 0;
    std::int64_t longest_path = 0;
    bool operator==(const SpirvCost&) const = default;
};

// Counts each function that the first entry point reaches once, and of it only blocks that can run.
// Meant for optimised modules: there calls are inlined and dead code is gone.  `loop_bound` >= 0:
// the most passes of any one loop. Errors: "spirv-invalid"; "endless" when no path ends;
// "bad-bound".
Result<SpirvCost> count_spirv(const SpirvWords& words, int loop_bound);

}  // namespace intaglio::check

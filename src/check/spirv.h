// SPIRV-Tools as a witness: spirv-val, spirv-opt and the disassembler, all for Vulkan 1.1
// (SPIR-V 1.3).
#pragma once

#include <string>

#include "generator/base/result.h"
#include "src/check/source.h"

namespace intaglio::check {

// spirv-val.  Error "spirv-invalid": the validator's first message, and the instruction it names in
// a note.
Status validate_spirv(const SpirvWords& words);

// spirv-opt -O, and spirv-val on what comes out.  Refuses an invalid module as validate_spirv does.
// Loops lose their `for` form here: they end as `for (;;)` with breaks, which WebGL 1 does not
// allow.
Result<SpirvWords> optimize_spirv(const SpirvWords& words);

// As spirv-dis prints it, with friendly names.  Error "spirv-unreadable".
Result<std::string> disassemble(const SpirvWords& words);

}  // namespace intaglio::check

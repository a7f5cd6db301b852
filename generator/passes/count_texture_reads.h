// Instrumentation: a shader that also says how many textures it read.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::passes {

// Adds an output `reads` (float4: the number of texture reads that this invocation executed, then
// 0, 0, 0) behind the others: a colour target of the pixel stage, a result of a function, an
// interpolant of the vertex stage.  Reads on paths not taken do not count.  The other outputs keep
// their bits.  Ends with values numbered anew.
void count_texture_reads(ir::Module& module);

}  // namespace intaglio::passes

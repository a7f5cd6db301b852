// Whether a shader reads a texture at a level of its own choice, told before anything is unrolled.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::passes {

// The first read at a constant level other than 0; null if there is none.  Levels that are computed
// may turn out to be 0, and are not looked at.
const ir::Instruction* find_coarser_read(const ir::Module& module);

}  // namespace intaglio::passes

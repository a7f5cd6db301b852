// Constant folding and algebra that is exact to the bit.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::passes {

// Computes what is known while generating:
// - bit-exact ops over constants become constants; device ops (see the ops table) do not;
// - the identities of rewrite_rules.h, and division by a power of two as a multiplication;
// - swizzles of swizzles and of compositions, compositions that are a swizzle of one vector;
// - an if with a known condition, a loop of no iteration, or of one without break_if, a break_if
//   with a known condition. Inside a region of an if, and after a break_if, its condition is known.
// Bit-exact, with denormals as in rewrite_rules.h.  Ends with values numbered anew; what became
// unused stays.
// Returns whether it changed anything.
bool fold_constants(ir::Module& module);

}  // namespace intaglio::passes

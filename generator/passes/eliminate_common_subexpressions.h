// Common subexpressions: one quantity is computed once.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::passes {

// Replaces an instruction that computes, from the same operands to the bit, what an earlier one
// already computed in its own region or in one around it.  Operands of commutative ops may stand in
// either order, and a > b is b < a.  Texture reads merge if sampler and operands are the same.  The
// earlier instruction stays, with its origin; it takes over a DSL name if it has none.  Bit-exact.
// Ends with values numbered anew.  Returns whether it changed anything.
bool eliminate_common_subexpressions(ir::Module& module);

}  // namespace intaglio::passes

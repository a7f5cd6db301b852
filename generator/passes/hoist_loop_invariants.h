// Loop-invariant code: what is the same in every iteration is computed once, before the loop.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::passes {

// Moves instructions whose operands all come from outside a loop to before it, out of as many loops
// as possible. Arithmetic moves freely, also out of an if and past a break_if: nothing traps.
// Texture reads, and ifs and loops as a whole, move only where the first iteration executes them in
// any case, so that no read and no loop runs that did not run before.  Bit-exact.  Ends with values
// numbered anew.  Returns whether it changed anything.
bool hoist_loop_invariants(ir::Module& module);

}  // namespace intaglio::passes

// Loops to straight code, for targets without loops and for schedules that say so.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::passes {

enum class Loops {
    AsScheduled,  // those whose form is Unrolled
    All,          // for targets without loops
};

// What becomes of leaving a loop early.
enum class EarlyExit {
    Branch,  // the rest of the iteration and all later ones go into the else region of an if
    Select,  // everything runs, and selects pick the values: what flatten_branches makes of Branch,
             // without the nesting
};

// Writes a loop's body out, once for each iteration, with the index as a constant.  The loop's name
// is gone with it. Bit-exact; with EarlyExit::Select texture reads after an early exit run too.
// Ends with values numbered anew.  Returns whether it changed anything.
bool unroll_loops(ir::Module& module, Loops which = Loops::AsScheduled,
                  EarlyExit early_exit = EarlyExit::Branch);

}  // namespace intaglio::passes

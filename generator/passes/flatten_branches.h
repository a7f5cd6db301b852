// Ifs to selects, for targets without branches or where a branch costs more than both its sides.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::passes {

enum class Branches {
    All,
    OutsideLoops,  // those inside loops stay
};

// Runs both sides of an if and selects its results, inner ifs before outer ones.  Always legal,
// since a region of an if holds nothing that depends on neighbouring pixels and nothing that traps;
// texture reads and loops of both sides run. Bit-exact.  Ends with values numbered anew.
// Returns whether it changed anything.
bool flatten_branches(ir::Module& module, Branches which = Branches::All);

}  // namespace intaglio::passes

// What pays for loops that stay loops, before they are cut into blocks.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::d3d9 {

// A loop whose carried values are functions of the index alone, and before it are what those
// functions give one iteration earlier, computes them at its top instead and runs once more: what
// stood before the loop, a texture read most often, goes.  With finite numbers the results are the
// same: 0 x counts as 0 there.
void rotate_loops(ir::Module& module);

// The smaller of 1 and what cannot be negative is a saturation, which costs nothing.
void form_saturations(ir::Module& module);

}  // namespace intaglio::d3d9

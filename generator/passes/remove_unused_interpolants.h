// What the pixel stage does not read, the vertex stage does not compute.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::passes {

// Drops every interpolant that no instruction of the pixel stage reads: the pixel input, the vertex
// output of that name, and the vertex computation that only it needed.  Bit-exact for all that is
// left.  Returns whether it changed the pixel stage.
bool remove_unused_interpolants(ir::Program& program);

}  // namespace intaglio::passes

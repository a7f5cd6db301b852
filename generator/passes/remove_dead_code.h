// Dead code: instructions, loop-carried values and results of ifs that no output depends on.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::passes {

// Removes everything that no output of the module depends on: instructions, whole loops and ifs,
// single results of an if, and single carried values of a loop, including those that are only used
// to compute themselves.  A carried value that never changes becomes its initial value.
// Declarations, files and steps that nothing uses any more go too (a function keeps its
// inputs, uniforms and samplers: they are its signature).  Bit-exact.  Ends with values numbered
// anew.  Returns whether it changed anything.
bool remove_dead_code(ir::Module& module);

}  // namespace intaglio::passes

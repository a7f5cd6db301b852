// The rules of the IR: those of the ops table (operands, results) and those of module.h (scopes,
// regions, terminators, declarations).  Every pass may assume them and must keep them; tests run
// the verifier around each pass.
#pragma once

#include "generator/base/result.h"
#include "generator/ir/module.h"

namespace intaglio::ir {

// Done, or the first broken rule as an error [ir-verify] that names the value and op, and points at
// the instruction's C++ line where its origin is known.  Total: any Module, however damaged, gets
// an answer.  A module that passes has parse(print(m)) == m, because fields that an op does not use
// must be at their defaults.
Status verify(const Module& module);

}  // namespace intaglio::ir

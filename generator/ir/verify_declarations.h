// The part of the verifier that reads no instruction: types, names, semantics, array counts,
// dimensions.
#pragma once

#include "generator/base/result.h"
#include "generator/ir/module.h"

namespace intaglio::ir {

// Done, or the first broken rule of a declaration or a value's type as an error [ir-verify].
Status verify_declarations(const Module& module);

}  // namespace intaglio::ir

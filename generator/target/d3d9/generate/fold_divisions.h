// Quotients of constants, which the general passes leave to the device's rounding.
#pragma once

#include "generator/ir/module.h"

namespace intaglio::d3d9 {

// Replaces each quotient of two constants by its correctly rounded value.  Direct3D 9 divides by
// an approximate reciprocal, so that any device's quotient is as far away as its own.
void fold_divisions(ir::Module& module);

}  // namespace intaglio::d3d9

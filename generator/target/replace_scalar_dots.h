// A dot product of scalars is their product.
#pragma once

#include "generator/target/target.h"

namespace intaglio {

// glslang 12 makes an OpFMul of a scalar dot() and forgets NoContraction on it; HLSL and people
// prefer `a * b` anyway. Bit-exact.
Status replace_scalar_dots(ir::Module& module, const Target& target, Notes& notes);

inline constexpr LegalizingPass replace_scalar_dots_pass{"replace_scalar_dots",
                                                         replace_scalar_dots};

}  // namespace intaglio

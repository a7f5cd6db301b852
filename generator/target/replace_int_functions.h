// For languages whose abs, min and max know only floats: GLSL before 1.30 and GLSL ES 1.00.
#pragma once

#include "generator/target/target.h"

namespace intaglio {

// abs, min and max of ints become comparisons and selects, component by component.  Exact.
Status replace_int_functions(ir::Module& module, const Target& target, Notes& notes);

inline constexpr LegalizingPass replace_int_functions_pass{"replace_int_functions",
                                                           replace_int_functions};

}  // namespace intaglio

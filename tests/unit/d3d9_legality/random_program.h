// Random shaders for the comparison with Direct3D's validator: mostly legal, with a slip here and
// there.
#pragma once

#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// A fifth to a half are legal.  Profiles: ps_2_0, ps_2_a (as ps_2_x), ps_3_0.
Shader random_program(Profile profile, unsigned seed);

// Any operand anywhere, any number of them, any nesting, any profile.
Shader random_nonsense(unsigned seed);

}  // namespace intaglio::d3d9

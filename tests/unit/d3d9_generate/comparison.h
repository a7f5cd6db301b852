// Whether a generated shader computes what its program says.
#pragma once

#include "generator/ir/module.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// Of so many pixels of random inputs, uniforms and smooth textures, those in which the pixel shader
// differs from the recorded program by more than rounding explains.  A march compares with >=, so a
// pixel at the edge of a hit may fall to either side: that is rare, and an error in the code is
// not.
int count_differences(const ir::Program& program, const Shader& shader, int pixels);

// The same of two modules with the same declarations, in the evaluator: pixels with any bit
// unequal.
int count_unequal(const ir::Module& a, const ir::Module& b, int pixels);

}  // namespace intaglio::d3d9

// The HLSL family, for fxc: shader model 5 (textures apart from samplers), and shader models 3
// and 2 (Direct3D 9).
#pragma once

#include "generator/target/target.h"

namespace intaglio {

extern const Target hlsl_5_0;
extern const Target hlsl_3_0;
extern const Target hlsl_2_b;
extern const Target hlsl_2_0;

}  // namespace intaglio

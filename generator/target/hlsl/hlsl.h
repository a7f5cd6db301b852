// The HLSL family, for fxc: shader model 5 (textures apart from samplers) and shader model 3
// (Direct3D 9).
#pragma once

#include "generator/target/target.h"

namespace intaglio {

extern const Target hlsl_5_0;
extern const Target hlsl_3_0;

}  // namespace intaglio

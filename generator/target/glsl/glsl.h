// The GLSL family: Vulkan GLSL, desktop GL 3.3, and WebGL 2's ESSL 3.00.
#pragma once

#include "generator/target/target.h"

namespace intaglio {

extern const Target glsl_450;
extern const Target glsl_330;
extern const Target essl_300;

}  // namespace intaglio

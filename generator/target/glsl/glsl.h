// The GLSL family: Vulkan GLSL, desktop GL 3.3 and 2.1, WebGL 2's ESSL 3.00 and WebGL 1's
// ESSL 1.00.
#pragma once

#include "generator/target/target.h"

namespace intaglio {

extern const Target glsl_450;
extern const Target glsl_330;
extern const Target glsl_120;
extern const Target essl_300;
extern const Target essl_100;

}  // namespace intaglio

// SPIRV-Cross as a witness: a second opinion on what the binary means, as text of another language.
#pragma once

#include <string>

#include "generator/base/result.h"
#include "src/check/source.h"

namespace intaglio::check {

enum class CrossTarget { Glsl450 /* Vulkan's */, Glsl330, Essl300, Hlsl50, Msl };

// "glsl_450", "glsl_330", "essl_300", "hlsl_5_0", "msl".
std::string_view name_of(CrossTarget target);

// The module as text; its entry point is `main` (`main0` in Metal).  Bindings are kept in Glsl450;
// Hlsl50 gets registers b0, t0 and s0 upwards in order of binding; Glsl330 and Essl300 have none,
// and join separate textures and samplers.  The module is validated first ("spirv-invalid").  Error
// "cross-failed": the target cannot say it.
Result<std::string> cross_to(const SpirvWords& words, CrossTarget target);

}  // namespace intaglio::check

// The whole chain of witnesses for one stage: front end, spirv-val, spirv-opt, spirv-val,
// SPIRV-Cross, and the front end again on what SPIRV-Cross wrote.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/check/cross.h"
#include "src/check/source.h"

namespace intaglio::check {

struct Witnessed {
    struct Crossed {
        CrossTarget target;
        std::string text;
    };
    SpirvWords words;              // as glslang made them; empty for Glsl120 and Essl100
    SpirvWords optimized;          // after spirv-opt -O
    std::vector<Crossed> crossed;  // from the optimised words
    std::vector<std::string>
        steps;  // what was done and passed, in order: "glslang glsl_450", "spirv-val", ...
};

// Glsl120 and Essl100 end after the front end, because no SPIR-V of them exists.  The GLSL 4.50 and
// HLSL 5.0 texts of SPIRV-Cross must become valid SPIR-V again, its GLSL 3.30 and ES 3.00 must pass
// the front end. Errors: those of the step that failed; a text of SPIRV-Cross that is refused has
// the code "round-trip-refused".
Result<Witnessed> judge(const Source& source);

}  // namespace intaglio::check

// Artifacts made by tools that others wrote, from the text that the generator wrote: the targets
// `spirv` and `msl`.
#pragma once

#include <string>

#include "generator/base/result.h"
#include "src/check/source.h"

namespace intaglio::check {

// The optimised binary of one stage.  Errors as of to_spirv and optimize_spirv.
Result<SpirvWords> derive_spirv(const Source& source);

// Metal text of one stage, made by SPIRV-Cross from the unoptimised binary: that keeps `for` loops
// and names.  No compiler for Metal is at hand, so nothing has judged the text but the tool that
// made it.
Result<std::string> derive_msl(const Source& source);

}  // namespace intaglio::check

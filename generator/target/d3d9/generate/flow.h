// Shaders with loops, for ps_3_0: each straight block is selected, packed and placed as a shader
// without loops is; then registers, copies and outputs are settled over all of them.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/ir/module.h"
#include "generator/target/d3d9/generate/candidate.h"

namespace intaglio::d3d9 {

// A pixel module without ifs, with loops or none, for a profile that has rep, any swizzle and any
// write mask: ps_3_0.  The candidate may not fit, for want of registers or slots.  Refuses as
// lower() and cut_into_blocks() do; `notes` as lower().
Result<Candidate> generate_flow(const ir::Module& module, Profile profile,
                                std::vector<std::string>& notes);

}  // namespace intaglio::d3d9

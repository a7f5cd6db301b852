// Direct3D 9 shaders from the IR: unrolled and flattened, selected, packed four to an instruction,
// placed, allocated, and checked against every rule of the profile.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// The pixel stage of a program as recorded (not yet optimised), for ps_2_0, ps_2_a, ps_2_b or
// ps_3_0: always legal by check().  Interpolant number i of the optimised program is t#i (v#i as
// texcoord i in ps_3_0).  Lowerings of first-hit searches are tried, the fewest arithmetic slots
// win; the same program gives the same shader.  Refuses [d3d9-limit] what does not fit, in a
// sentence that names the limit, by how much, the step and line that spend most, and what to try;
// [d3d9-level] and [d3d9-op] as lower(); [d3d9-stage] another stage or profile.  `notes` gets what
// whoever uses the shader must know.
Result<Shader> generate(const ir::Program& program, ir::Stage stage, Profile profile,
                        std::vector<std::string>* notes = nullptr);

}  // namespace intaglio::d3d9

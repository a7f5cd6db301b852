// Direct3D 9 shaders from the IR: unrolled and flattened, selected, packed four to an instruction,
// placed, allocated, and checked against every rule of the profile.
//
// Programs come as recorded, not yet optimised; what comes out is always legal by check(), and the
// same program gives the same shaders.  All refuse [d3d9-limit] what does not fit, in a sentence
// that names the limit, by how much, the step and line that spend most, and what to try; what is
// far too long is refused before packing, with a lower bound of what it needs ("at least");
// [d3d9-level] and [d3d9-op] as lower(); [d3d9-texture] a vertex stage's texture read that its
// profile does not have; [d3d9-stage] a profile of the other stage.  Notes are what whoever uses
// the shader must know.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// Two stages that belong together: the vertex shader writes each component that the pixel shader
// declares.
struct Stages {
    Shader vertex, pixel;
    std::vector<std::string> interpolants;  // what passes between them: "texcoord0.xy uv"
    std::vector<std::string> notes;
};

// Both stages, for ps_2_0, ps_2_a and ps_2_b with vs_2_0, for ps_3_0 with vs_3_0.  Lowerings of
// first-hit searches are tried, the fewest arithmetic slots of the pixel stage win.
Result<Stages> generate_program(const ir::Program& recorded, Profile pixel);

// The same, with what does not fit: for those who ask where the slots went.
struct Attempt {
    Shader pixel;
    std::optional<Shader> vertex;       // nothing where the pixel stage is refused
    std::optional<Diagnostic> refusal;  // of the pixel stage
    bool only_slots =
        false;  // refused for want of registers, or before packing: only slots are right
    std::vector<std::string> interpolants;
    std::vector<std::string> notes;
};
Result<Attempt> attempt_program(const ir::Program& recorded, Profile pixel);

// The pixel stage alone: that of generate_program.
Result<Shader> generate_pixel(const ir::Program& recorded, Profile pixel,
                              std::vector<std::string>* notes = nullptr);

// The vertex stage alone, for vs_2_0 or vs_3_0: every interpolant of the optimised program, where
// interpolant_places() has it, whether a pixel shader would fit or not.
Result<Shader> generate_vertex(const ir::Program& recorded, Profile vertex,
                               std::vector<std::string>* notes = nullptr);

}  // namespace intaglio::d3d9

// Whether a variant is legal where it is going: the front end of its own language, the validator of
// what that makes, both stages together, and for Direct3D 9 every rule of the profile.  The part
// of judge_variant that a build waits for; the rest asks whether further tools understand it too.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/check/reflect.h"
#include "src/variant/variant.h"

namespace intaglio {

struct Accepted {
    std::vector<std::string> steps;  // what each witness accepted, in order
    // Both stages that fit each other, as the front end made them, not optimised; of Direct3D 9,
    // what MojoShader makes of the bytecode.  Nothing where no SPIR-V of the language exists, and
    // for a vertex profile alone.
    std::optional<check::Program> program;
    std::vector<d3d9::Shader> shaders;  // Direct3D 9: as decoded from their bytes, vertex first
    // Vertex and pixel; nothing of Direct3D 9's bytecode.  Of a language whose uniforms have names
    // and no places, as reflect_names says; of others, what is in the program.
    std::vector<check::Reflection> reflections;
};

// Errors: those of the first witness that refuses; "no-witness" for a target without one.
Result<Accepted> accept_variant(const Variant& variant);

}  // namespace intaglio

// Is a Direct3D 9 shader legal?  Every rule of the profiles, on shaders from anywhere: text,
// bytecode, our own back end. Each rule was probed on Direct3D's validator, and is compared with it
// in the tests labelled `judge`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/target/d3d9/limits.h"
#include "generator/target/d3d9/resources.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// The codes of all rules.
inline constexpr std::string_view rule_names[] = {
    // budgets
    "arithmetic-slots",
    "texture-slots",
    "total-slots",
    "temps",
    "constants",
    "integer-constants",
    "boolean-constants",
    "samplers",
    "inputs",
    "texcoords",
    "texcoord-outputs",
    "colour-outputs",
    "outputs",
    "register-number",
    "dependent-reads",
    // declarations and definitions
    "dcl-register",
    "dcl-mask",
    "dcl-modifier",
    "dcl-twice",
    "dcl-usage",
    "def-register",
    "def-twice",
    "repeat-count",
    "loop-values",
    // inside an instruction
    "instruction",
    "operands",
    "predication",
    "predicate",
    "destination",
    "write-mask",
    "texture-mask",
    "saturate",
    "partial-precision",
    "source",
    "swizzle",
    "scalar-swizzle",
    "texture-swizzle",
    "source-modifier",
    "abs-modifier",
    "constant-port",
    "constant-operands",
    "input-port",
    "relative-addressing",
    "macro-mask",
    "macro-operands",
    "macro-registers",
    // outputs
    "output-mov",
    "output-mask",
    "output-saturate",
    "output-source",
    "scalar-output",
    "output-twice",
    "output-missing",
    "output-gap",
    // flow
    "flow-structure",
    "flow-depth",
    "flow-count",
    "loop-counter",
    "gradient-in-flow",
    // what is not there
    "undeclared-input",
    "undeclared-sampler",
    "undeclared-output",
    "uninitialised",
};

struct Violation {
    std::string rule;     // stable code, e.g. "dependent-reads"
    std::string message;  // one sentence that names the limit, and by how much it is exceeded
    int instruction =
        -1;  // index into Shader::instructions; -1: the shader as a whole, or a declaration
};

// All violations, those of the whole shader first, then by instruction; empty: legal.
std::vector<Violation> check(const Shader& shader);

// The same by other limits than those of the shader's profile, e.g. validator_limits().
std::vector<Violation> check(const Shader& shader, const Limits& limits);

}  // namespace intaglio::d3d9

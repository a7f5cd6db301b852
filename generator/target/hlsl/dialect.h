// How the members of the HLSL family differ, as text: the rows of hlsl.cpp.
#pragma once

#include <string_view>

#include "generator/target/clike/spelling.h"
#include "generator/target/target.h"

namespace intaglio::hlsl {

// Patterns have numbered holes: {0} a register, {1} a name, {2} the dimension.
struct Dialect {
    const Target& target;
    clike::Spelling spelling;
    std::string_view texture;            // a declaration
    std::string_view sampler_state;      // the one beside it; empty: the texture is the sampler
    std::string_view texture_parameter;  // both, as function parameters
    std::string_view
        uniform_block;  // {0} register, {1} name, ends in "{"; empty: uniforms are loose
    std::string_view
        pixel_position;  // member of the pixel stage's interpolants, {1} name; may be empty
};

Result<Artifact> print_stage(const Dialect& dialect, const ir::Program& program, ir::Stage stage);
Result<Artifact> print_function(const Dialect& dialect, const ir::Program& program,
                                Binding binding);

}  // namespace intaglio::hlsl

// How the members of the GLSL family differ, as text: the rows of glsl.cpp.
#pragma once

#include <string_view>

#include "generator/target/clike/spelling.h"
#include "generator/target/target.h"

namespace intaglio::glsl {

// Patterns have numbered holes: {0} a location or binding, {1} a type, {2} a name.
struct Dialect {
    const Target& target;
    clike::Spelling spelling;
    clike::Spelling vertex_spelling;
    clike::Spelling function_spelling;  // inside a host shader, which may lack extensions
    std::string_view version;
    std::string_view rolled_loop_extension;  // a line needed by spelling.rolled_loop; may be empty
    std::string_view default_precision;      // lines; may be empty
    std::string_view volume_precision;       // a further line if there is a sampler3D; may be empty
    std::string_view attribute;
    std::string_view vertex_output;
    std::string_view position;  // a line; may be empty
    std::string_view pixel_input;
    std::string_view colour_target;  // empty: gl_FragColor, or gl_FragData of several
    std::string_view sampler;
    std::string_view
        uniform_block;  // {0} binding, {1} name, ends in "{"; empty: uniforms are loose
    // Lines needed by reads with gradients, by those with a level outside the vertex stage, and by
    // ddx and ddy; empty: the language has them.
    std::string_view explicit_read_extension = {};
    std::string_view derivative_extension = {};
    std::string_view depth = "gl_FragDepth";
    std::string_view depth_extension = {};  // a line needed to write it; may be empty
};

Result<Artifact> print_stage(const Dialect& dialect, const ir::Program& program, ir::Stage stage);
Result<Artifact> print_function(const Dialect& dialect, const ir::Program& program,
                                Binding binding);

}  // namespace intaglio::glsl

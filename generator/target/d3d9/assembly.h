// Shaders as assembly text, in the syntax that Direct3D's D3DAssemble accepts, and back.  What the
// syntax cannot say is carried by comments in fixed words: which of ps_2_a and ps_2_b a ps_2_x text
// is, and the constant table.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "generator/base/result.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

struct AssemblyOptions {
    // The sentence of a step before its first instruction; beside each instruction the slots so
    // far, arithmetic and texture, and the step and source line that cost them.  The constant table
    // is written either way.
    bool comments = true;
};

// The text, ending in a line break.  parse() reads it back to an equal shader, except that a NaN in
// a definition becomes the one NaN (of either sign) that the syntax can write.
std::string print(const Shader& shader, const AssemblyOptions& options = {});

// One instruction or operand as the text has it, for diagnostics: "mad_sat r0.xyz, r1, -c2.x, t0".
std::string text_of(const Instruction& instruction);
std::string text_of(const Source& source);
std::string text_of(const Destination& destination);

// Reads assembly text.  A ps_2_x text is `x_profile` if given (ps_2_a or ps_2_b), else what its
// comment says, else ps_2_a.  Refuses [d3d9-parse], with line and column, what is not an
// instruction, register or number of the syntax or has the wrong operands; whether the profile
// allows it is the checker's matter.
Result<Shader> parse(std::string_view text, std::string_view file_name,
                     std::optional<Profile> x_profile = std::nullopt);

// The words of the comments that carry meaning, shared by print and parse.
inline constexpr std::string_view profile_comment = "// profile ";
inline constexpr std::string_view uniform_comment = "// uniform ";

// "float3", "float4x4", "int2", "bool1", "sampler": the type in a uniform comment.
inline constexpr std::string_view set_type_names[] = {"bool", "int", "float", "sampler"};
inline constexpr std::string_view set_letters[] = {"b", "i", "c", "s"};

}  // namespace intaglio::d3d9

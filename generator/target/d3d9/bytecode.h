// Shaders as Direct3D 9 bytecode: a stream of 32-bit tokens, in host order (little-endian in
// files). Source: Direct3D 9 driver development kit, "Shader code tokens"; d3d9types.h.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "generator/base/result.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// Version, constant table, definitions, declarations, instructions, end.  The shader's operands
// must be of register files that its profile has (has_file) and as many as its rows say (ops.h), as
// from parse() and decode(); its constants in the order of the constant table.  Without
// `constant_table`, only what the device needs.
std::vector<std::uint32_t> encode(const Shader& shader, bool constant_table = true);

// Reads a stream from any compiler, and to its last token: decode(encode(x)) == x.  Comments other
// than the first constant table are skipped.  A ps_2_x stream is `x_profile` if given (ps_2_a or
// ps_2_b), else what the constant table names, else ps_2_a.  Refuses [d3d9-bytecode], with the
// offset of the token, unknown versions, instructions, registers and modifiers, wrong lengths, bits
// that must be set or clear, a missing end, and what follows the end.
Result<Shader> decode(std::span<const std::uint32_t> tokens,
                      std::optional<Profile> x_profile = std::nullopt);

// The version token of a profile, 0xFFFF0201 for ps_2_a and ps_2_b.
std::uint32_t version_token(Profile profile);

// The tokens without comments: two streams that are equal in this do the same.
std::vector<std::uint32_t> without_comments(std::span<const std::uint32_t> tokens);

}  // namespace intaglio::d3d9

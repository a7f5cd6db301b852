// The constant table (CTAB): a comment at the start of the bytecode, by which engines bind uniforms
// and samplers by name.  Source: D3DXSHADER_CONSTANTTABLE, D3DXSHADER_CONSTANTINFO and
// D3DXSHADER_TYPEINFO in d3dx9shader.h; the order of names and of the pieces is that of Microsoft's
// compiler.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// "CTAB" as a little-endian word: the first of the comment.
inline constexpr std::uint32_t constant_table_tag = 0x42415443;

struct ConstantTable {
    std::string target;               // "ps_2_b"
    std::vector<Constant> constants;  // by set, then register, then name
};

// The words after the tag.  `version` is the shader's version token.  The declarations tell which
// kind of texture a sampler reads; one that is not declared is a plain sampler.
std::vector<std::uint32_t> build_constant_table(const Shader& shader, std::uint32_t version);

// Reads the words after the tag, from any compiler.  A matrix stored by rows comes back as its
// transpose, stored by columns; of a structure remains its registers as one array of vectors.
// Refuses [d3d9-bytecode] what points outside the table, names that are no identifiers, and sets,
// shapes and counts that do not exist.
Result<ConstantTable> parse_constant_table(std::span<const std::uint32_t> words);

}  // namespace intaglio::d3d9

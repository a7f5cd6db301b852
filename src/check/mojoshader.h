// MojoShader as a witness: a Direct3D 9 runtime that we did not write reads the bytecode and says
// it in GLSL, which glslang takes to SPIR-V for the runner.  Nothing of ours lies between the bytes
// and the pixels but declarations: MojoShader's text is GLSL 1.20, so its built-in varyings and
// attributes get names of their own here, and its functions stay as they are.
//
// Of its two outputs this one is run because its SPIR-V leaves out unconditional breaks and gives
// texldd gradients of the wrong size (libmojoshader 1314); spirv-val refuses both.  It knows no
// predication, and relative addressing only with a constant table.  Edge values are its own: rcp(0)
// is 1e38, log of a negative number is NaN, vPos is half a pixel more than Direct3D's.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/check/frontend.h"
#include "src/check/source.h"

namespace intaglio::check {

using D3d9Words = std::span<const std::uint32_t>;  // from the version token to the end token

// A row of the bytecode's constant table, as MojoShader reads it.
struct D3d9Constant {
    enum class Set { Bool, Int, Float, Sampler };
    std::string name;
    Set set = Set::Float;
    int index = 0;       // first register
    int count = 1;       // registers
    int components = 4;  // that a register carries of the value: 3 for a float3 or a float3[n]
};

// One stage in MojoShader's words.
struct D3d9Stage {
    Source source;  // GLSL 3.30
    int slots = 0;  // MojoShader's count of instruction slots
    std::vector<D3d9Constant> constants;
    // The registers behind the elements of the stage's uniform arrays, in order: only those that
    // are read and not defined in the shader.
    std::vector<int> float_registers, int_registers, bool_registers;
    // What the program calls the texture (ps_s3), by its name in the constant table; without one
    // by its register (s3).
    std::map<std::string, std::string> textures;
};

// Errors: "d3d9-malformed": no stream of whole instructions from a version (model 2 or 3) to an end
// token, which MojoShader does not mind; "d3d9-refused": MojoShader's first complaint, with the
// byte it names; "stages-disagree": the bytecode is of the other stage.
Result<D3d9Stage> translate_d3d9(D3d9Words bytecode, Stage stage);

struct D3d9Program {
    Program spirv;
    std::vector<D3d9Stage> stages;  // those that came as bytecode
};

// Both stages, ready to draw.  Vertex inputs are called in_position, in_normal, in_tangent, in_uv
// (texcoord0) and otherwise by usage and index (in_texcoord1); clip coordinates are handed on as
// they are.  Errors: as translate_d3d9 and link_to_spirv.
Result<D3d9Program> link_d3d9(D3d9Words vertex, D3d9Words pixel);
// The same with a vertex stage in GLSL 3.30, which feeds texcoord n by `out vec4 mojo_texcoord<n>`
// and color n by `out vec4 mojo_color<n>`.
Result<D3d9Program> link_d3d9(const Source& vertex, D3d9Words pixel);

// The stage with its uniforms and textures called as in the constant table, a register's further
// components being zero: what a caller of the runner sets by name.  Registers without a name stay
// in their array.
D3d9Stage with_names(D3d9Stage stage);

// Both stages of link_d3d9 with names: a program like those of other languages.  A name that both
// tables have is one uniform.
Result<Program> link_d3d9_by_name(D3d9Words vertex, D3d9Words pixel);

// The uniform arrays of the program, by their names in it, from values by their names in the
// constant table: register after register, each as many as it has components.  A register that the
// table does not name is looked up as c5, i0 or b1, with four values (b: one).  Values that the
// program does not read are ignored.  Errors: "missing-uniform"; "bad-uniform": a wrong number.
Result<std::map<std::string, std::vector<float>>> uniforms_of(
    const D3d9Program& program, const std::map<std::string, std::vector<float>>& values);

}  // namespace intaglio::check

// glslang as a witness: does a front end that we did not write accept the text, and what SPIR-V
// does it make of it? Every function may be called from several threads.  The first parse of a
// process and profile costs up to 150 ms (glslang builds its symbol tables), later ones about 1 ms.
//
// Errors: code "glsl-refused" or "hlsl-refused" with the tool's first complaint, the line it names
// and that line quoted in a note; "spirv-invalid" when the front end accepted the text and the
// validator refused the binary. Never feed HLSL from strangers: noise(), msad4() and two-element
// matrix swizzles crash glslang 12 in process.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/check/source.h"

namespace intaglio::check {

// The front end alone, by the rules of the language itself (not those of Vulkan, except for
// Glsl450).
Status parse(const Source& source);

// SPIR-V 1.3 for Vulkan 1.1, accepted by spirv-val.  (At Vulkan 1.3 discard becomes demote, which
// SPIRV-Cross cannot say in plain GLSL.)  What has no binding or location in the text gets one: see
// source.h, and locations in order of declaration.  Two stages that must fit each other belong in
// link_to_spirv.  Glsl120 and Essl100: "no-spirv".
Result<SpirvWords> to_spirv(const Source& source);

struct Program {
    SpirvWords vertex;
    SpirvWords pixel;
    // Textures that are to be sampled nearest: SPIR-V does not say it, so whoever made the text
    // does.
    std::set<std::string> nearest{};
    // Textures to be given without mipmaps: read at level 0, where the language leaves the level to
    // the hardware.
    std::set<std::string> one_level{};
    // The settings that textures must be baked with, "shininess=32", by name.
    std::map<std::string, std::string> baked{};
};

// Both stages of a draw, so that they agree in locations, bindings and uniform blocks.  GLSL
// varyings without a location are matched by name, and the loose uniforms of both stages become one
// block.  HLSL has locations in order of declaration in each stage, whatever the semantics say, so
// there both stages must declare the same names in the same order; loose uniforms of Hlsl3 belong
// to a stage, as the constant registers of Direct3D 9 do, and those of the vertex stage lie at
// vertex_uniform_binding. Checked on the binaries ("stages-disagree"): each pixel input has a
// vertex output of its width (and, but for Glsl450, its name) at its location, and a block that
// both stages bind at one place has one layout.  glslang's own linker may see a difference first
// ("glsl-refused"). Both sources must be of one language ("language-mismatch"), the first a vertex
// and the second a pixel stage.
Result<Program> link_to_spirv(const Source& vertex, const Source& pixel);

}  // namespace intaglio::check

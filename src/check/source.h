// What a witness is asked about: the text of one shader stage, and the binary it becomes.
// The folder sees plain text only: it knows nothing of the generator, so that both cannot share a
// mistake.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace intaglio::check {

enum class Language {
    Glsl450,  // Vulkan GLSL with explicit set, binding and location
    Glsl330,  // desktop GL; loose uniforms and samplers without binding
    Essl300,  // WebGL 2
    Glsl120,  // front end only: no SPIR-V exists for it
    Essl100,  // front end only, with WebGL 1's limits on loops and indexing (GLSL ES 1.00, appendix
              // A)
    Hlsl5,    // cbuffer, Texture2D and SamplerState with registers
    Hlsl3,    // sampler2D, tex2D*, loose uniforms (also for the ps_2_x profiles)
};
enum class Stage { Vertex, Pixel };

// A SPIR-V module: five words of header, then instructions.
using SpirvWords = std::vector<std::uint32_t>;

struct Source {
    Language language = Language::Glsl450;
    Stage stage = Stage::Pixel;
    std::string text = {};
    std::string entry = "main";  // the GLSL languages allow no other
    std::string name = {};       // stands for the file in messages; may be empty
};

// Descriptor bindings in set 0 of whatever has none in its text.  HLSL's b0, t0 and s0 would all
// fall on binding 0, so register n of each kind is shifted; the same bases serve GLSL without
// explicit bindings, in order of use.
inline constexpr int uniform_binding = 0;         // b0, the block of loose uniforms
inline constexpr int vertex_uniform_binding = 1;  // of Hlsl3: each stage has constants of its own
inline constexpr int texture_binding = 16;        // t0; combined samplers too
inline constexpr int sampler_binding = 32;        // s0 of a SamplerState

// "glsl_450", "essl_100", "hlsl_5_0", ...: the names of the targets.
std::string_view name_of(Language language);
// "vertex" or "pixel".
std::string_view name_of(Stage stage);
// Whether SPIR-V can be made from it: all but Glsl120 and Essl100.
bool has_spirv(Language language);

// Line `line` (from 1) of `text`, without the line break and the blanks around it; empty when there
// is none.
std::string quote_line(std::string_view text, int line);

}  // namespace intaglio::check

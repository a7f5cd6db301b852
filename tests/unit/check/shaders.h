// Hand-written shaders: a looping parallax search with an early exit, and the vertex stage for it,
// in each language. The uniforms are depth_scale (float) and light (float3); the texture is
// height_map; the varyings are uv (2) and view (3), in this order; the vertex inputs position (3),
// texcoord (2) and tangent_view (3).
#pragma once

#include <string>

#include "src/check/source.h"

namespace intaglio::check {

Source parallax_pixel(Language language);
Source parallax_vertex(Language language);

// All languages that can become SPIR-V.
inline constexpr Language spirv_languages[] = {Language::Glsl450, Language::Glsl330,
                                               Language::Essl300, Language::Hlsl5, Language::Hlsl3};

// `text` with the first occurrence of `from` replaced; `from` must occur.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace intaglio::check

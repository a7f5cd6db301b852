// Random shaders: legal ones, which Direct3D's validator accepts, and arbitrary ones, which use
// every field that text and bytecode can say.
#pragma once

#include <cstdint>

#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

inline constexpr Profile every_profile[] = {Profile::ps_2_0, Profile::ps_2_a, Profile::ps_2_b,
                                            Profile::ps_3_0, Profile::vs_2_0, Profile::vs_3_0};

// A shader that keeps every rule of its profile: limits, ports, swizzles, masks, macros, dependent
// reads, initialised lanes, output rules.  It has no NaN or infinity in its definitions.  The same
// seed gives the same shader.
Shader random_legal_shader(std::uint32_t seed, Profile profile);

// A shader of random instructions, operands, declarations, definitions and constants of the
// profile's register files.
Shader random_shader(std::uint32_t seed, Profile profile);

}  // namespace intaglio::d3d9

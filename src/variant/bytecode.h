// Variants for Direct3D 9: their bytecode before our own rules and before MojoShader.
#pragma once

#include "src/variant/variant.h"

namespace intaglio {

// What link_variant and judge_variant do for the Direct3D 9 profiles.
Result<check::Program> link_bytecode(const Variant& variant);
Result<Judged> judge_bytecode(const Variant& variant);

// A stage as decoded from its bytes, having passed our own checks: the bytes are encoded again to
// the same, the text is the same shader, and it keeps every rule of the profile.
Result<d3d9::Shader> checked_stage(const Variant& variant, ir::Stage stage);

}  // namespace intaglio

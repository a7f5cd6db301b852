// Variants for Direct3D 9: their bytecode before our own rules and before MojoShader.
#pragma once

#include "src/variant/variant.h"

namespace intaglio {

// What link_variant and judge_variant do for the Direct3D 9 profiles.
Result<check::Program> link_bytecode(const Variant& variant);
Result<Judged> judge_bytecode(const Variant& variant);

}  // namespace intaglio

// Which witnesses are compiled in: what they make depends on their versions.
#pragma once

#include <string>

namespace intaglio::check {

// One line: "glslang 12.0.0, SPIRV-Tools v2023.1 ..., MojoShader 1314".
std::string witness_versions();

}  // namespace intaglio::check

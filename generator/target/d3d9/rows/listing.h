// Assembly for a person to read: what the shader is, what to bind where, how much of the profile is
// left, then the instructions with their steps, lines and running slot counts.
#pragma once

#include <string>
#include <vector>

#include "generator/target/d3d9/shader.h"
#include "generator/target/target.h"

namespace intaglio::d3d9 {

// The text that parse() reads back to an equal shader.  `recorded` gives title, settings and what
// uniforms and textures mean; `interpolants` as in Stages.
std::string listing(const ir::Program& recorded, ir::Stage stage, const Target& target,
                    const Shader& shader, const std::vector<std::string>& interpolants);

}  // namespace intaglio::d3d9

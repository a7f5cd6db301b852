// Random vertex programs of every float op that vertex shaders have, with a pixel stage that reads
// each interpolant.
#pragma once

#include <cstdint>

#include "generator/ir/module.h"

namespace intaglio::d3d9 {

ir::Program random_vertex_program(std::uint64_t seed, int instructions);

// A vertex program from the text of its vertex module: the pixel stage reads each interpolant.
ir::Program vertex_program(const ir::Module& vertex);

}  // namespace intaglio::d3d9

// Texture reads with gradients where the profile has none.
#pragma once

#include <string>
#include <vector>

#include "generator/ir/module.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// For ps_2_0 and ps_2_b, which have neither gradients nor derivatives: reads with gradients become
// reads whose level the hardware chooses, with a note for each texture, and what only computed
// gradients goes, interpolants included.  On straight code; derivatives that are left are lower()'s
// to refuse.
void drop_gradients(ir::Program& program, Profile profile, std::vector<std::string>& notes);

}  // namespace intaglio::d3d9

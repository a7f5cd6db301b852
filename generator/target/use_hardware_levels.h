// For languages whose texture reads have no level of their own: ps_2_0 and ps_2_b.
#pragma once

#include "generator/target/target.h"

namespace intaglio {

// In a pixel stage or function, reads at the constant level 0 and reads with gradients become reads
// at the level that the hardware chooses from the coordinate, and what computed the gradients goes.
// That changes the result wherever a texture has more than one level, so a note says so.  Reads at
// other levels stay, to be refused by check_limits.  Loops and branches must be gone.
Status use_hardware_levels(ir::Module& module, const Target& target, Notes& notes);

inline constexpr LegalizingPass use_hardware_levels_pass{"use_hardware_levels",
                                                         use_hardware_levels};

}  // namespace intaglio

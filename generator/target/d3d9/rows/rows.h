// The Direct3D 9 profiles as targets: assembly to read, bytecode to load.  A pixel profile comes
// with the vertex profile of its model; a vertex profile stands alone.
#pragma once

#include "generator/target/target.h"

namespace intaglio {

extern const Target ps_2_0, ps_2_a, ps_2_b, ps_3_0, vs_2_0, vs_3_0;

}  // namespace intaglio

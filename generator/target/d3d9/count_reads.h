// Instrumentation of a finished shader: what the instructions themselves read, not what the IR
// would have.
#pragma once

#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// The pixel shader with one more colour output behind its others: how many texture reads this pixel
// executed, then 0, 0, 0.  Straight code pays one slot and one constant for it; with flow, a
// temporary and a slot for each read.  Not checked against the profile's limits: nobody ships it.
Shader with_read_counter(const Shader& shader);

}  // namespace intaglio::d3d9

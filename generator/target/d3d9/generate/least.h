// What a program needs at least, counted before packing: a variant that is far too long is refused
// from that, in the time of its lowering.
#pragma once

#include <vector>

#include "generator/target/d3d9/generate/candidate.h"
#include "generator/target/d3d9/generate/graph.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {

// No more than any shader of these graphs takes, however they are packed: texture reads as they
// are, scalar instructions and dot products one by one, four lanes of what packing cannot take away
// to an instruction.  `tidied`: they are blocks that flow_code.h's passes go over as well.
Slots least_slots(const std::vector<Graph>& graphs, bool tidied);

// So much more than the profile has that the exact number is not worth its seconds.
bool is_far_too_long(const Slots& least, Profile profile);

// A candidate that does not fit: one instruction a node, for who spends what; registers mean
// nothing.
Candidate unpacked(const ir::Module& module, const std::vector<Graph>& graphs, Profile profile,
                   const Slots& least);

}  // namespace intaglio::d3d9

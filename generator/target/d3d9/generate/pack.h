// Scalars to vectors: two independent instructions of one kind become one.
#pragma once

#include <vector>

#include "generator/target/d3d9/generate/code.h"

namespace intaglio::d3d9 {

// Arithmetic slots of the graph's instructions, with the moves that placement adds.
int cost_of(const Graph& graph, const Limits& limits, const std::vector<int>& uniform_registers);

// Joins instructions as long as that saves slots; each result is cheaper than the one before, the
// first is the graph itself.  The first improvement found is taken, in the order of the nodes, so
// the result is deterministic; `evaluations` bounds the work.
std::vector<Graph> pack(const Graph& graph, const Limits& limits,
                        const std::vector<int>& uniform_registers, int evaluations);

}  // namespace intaglio::d3d9

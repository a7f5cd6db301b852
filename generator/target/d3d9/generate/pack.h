// Scalars to vectors: two independent instructions of one kind become one.
#pragma once

#include <vector>

#include "generator/target/d3d9/generate/code.h"

namespace intaglio::d3d9 {

// Arithmetic slots of the graph's instructions, with the moves that placement adds.
int cost_of(const Graph& graph, const Limits& limits, const std::vector<int>& uniform_registers);

// The graph with each maximum or minimum of four or more scalars computed by vectors.
Graph with_wide_reductions(const Graph& graph);

// Joins instructions as long as that saves slots, by each of a few plans.  In each plan's list a
// result is cheaper than the one before; the first is the graph, with wide reductions or outputs
// where these are cheaper.  The first improvement found is taken, in the plan's order, so the
// result is deterministic; `evaluations` bounds the work of each of a plan's sweeps.
std::vector<std::vector<Graph>> pack(const Graph& graph, const Limits& limits,
                                     const std::vector<int>& uniform_registers, int evaluations);

}  // namespace intaglio::d3d9

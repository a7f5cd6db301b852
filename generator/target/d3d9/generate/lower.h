// IR to the instruction graph: which Direct3D instructions compute each op.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/target/d3d9/generate/graph.h"

namespace intaglio::d3d9 {

// A module without loops and ifs (unrolled, flattened) to instructions of the profile, mads and
// saturations formed; a vertex module still needs legalize_for_vertex() and the places of its
// inputs and outputs.  Refuses [d3d9-level] a texture read at a level that the profile cannot
// name, [d3d9-op] what has no instructions.  `notes` gets a sentence for each deviation from the
// IR's meaning.
Result<Graph> lower(const ir::Module& module, Profile profile, std::vector<std::string>& notes);

// Refuses [d3d9-level] as lower() does, from the recorded module, before unrolling takes its time.
Status check_levels(const ir::Module& module, Profile profile);
Diagnostic refuse_level(const ir::Module& module, const ir::Instruction& read, Profile profile);

// What each output of a pixel module is.
std::vector<OutputKind> output_kinds_of(const ir::Module& module);

// Forms mad and _sat, drops what nothing reads.  Rounding differs by the product's, as mad's does
// on the hardware of the profiles.
void simplify(Graph& graph);

// Moves constants, common terms and common factors to where they save slots; rounding differs.
void reassociate(Graph& graph);

// Clears the operands of what no output needs, so that it counts as no user.
void drop_dead(Graph& graph);

// The graph with components of an output that are factor * x + term for one x, constants among
// them, as one mad: one graph for each such x.
std::vector<Graph> with_wide_output(const Graph& graph);

}  // namespace intaglio::d3d9

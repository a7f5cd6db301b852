// Placed code to a shader: registers, declarations, definitions and the constant table.
#pragma once

#include <vector>

#include "generator/target/d3d9/generate/code.h"

namespace intaglio::d3d9 {

// The first c# of each of the module's uniforms that the graph reads, -1 for the others; `next` is
// the first c# after them.
std::vector<int> assign_uniforms(const ir::Module& module, const Graph& graph, int& next);

// The shader of the graph in this order, or why it got no registers.  Constants beyond the limit
// are left to check().
struct Finished {
    Shader shader;
    std::optional<AllocationFailure> failure;  // the shader has only its slots right then
    int failed_at = -1;
};
Finished finish(const ir::Module& module, const Graph& graph, const std::vector<int>& order,
                Profile profile);

// The same for code whose virtual registers are r# already.  Of the graph only the places of inputs
// are read; `uniforms` and `next` are those of assign_uniforms.
Shader finish_flow(const ir::Module& module, const Graph& graph, const Code& code,
                   const std::vector<int>& uniforms, int next, Profile profile);

}  // namespace intaglio::d3d9

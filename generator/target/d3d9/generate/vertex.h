// Vertex shaders: the position, and the interpolants where the pixel shader has them.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/target/d3d9/generate/candidate.h"

namespace intaglio::d3d9 {

// An output of the vertex stage that the pixel stage reads there.
struct Interpolant {
    std::string name;
    InterpolantPlace place;
};

// The vertex stage of an optimised program, for vs_2_0 or vs_3_0, or a refusal as generate.h lists
// them.  Attributes are v# in order of declaration, each with its usage as in the recorded module.
Result<Candidate> vertex_stage(const ir::Program& program, const ir::Module& recorded,
                               const std::vector<Interpolant>& interpolants, Profile profile);

// Rewrites the graph of a vertex module into what vertex shaders have: they know no cmp, and vs_2_0
// no _sat.
void legalize_for_vertex(Graph& graph, Profile profile);

// What each of a recorded vertex module's inputs is, by its name: position, normal, tangent,
// bitangent, color; all others are texture coordinates, in order of declaration.
std::vector<AttributeUsage> attribute_usages(const ir::Module& vertex);

}  // namespace intaglio::d3d9

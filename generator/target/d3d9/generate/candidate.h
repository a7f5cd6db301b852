// The search for the smallest shader of one instruction graph: packings, then orders, then
// registers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/target/d3d9/generate/code.h"
#include "generator/target/d3d9/legality.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {

struct Candidate {
    Shader shader;
    std::vector<InterpolantPlace> inputs;  // of the graph
    std::vector<std::string> notes;
    std::vector<Violation> violations;
    std::optional<AllocationFailure> failure;
    int failed_at = -1;
    // Refused before packing: no shader of the program takes fewer.
    std::optional<Slots> at_least;
    int iterations = 0;  // of each long loop, if not all were counted then
    bool fits() const { return !failure && violations.empty(); }
};

// Whether a fits and b does not, or is packed and b is not, or takes fewer slots.
bool better(const Candidate& a, const Candidate& b);

// The best that packing, ordering and allocation find.
Candidate best_of(const ir::Module& module, const Graph& graph, Profile profile);

// [d3d9-limit] why it does not fit: the limit, by how much, the step and line that spend most, and
// what to try.  `name` is the program's.
Diagnostic refuse(const std::string& name, const Candidate& candidate);

}  // namespace intaglio::d3d9

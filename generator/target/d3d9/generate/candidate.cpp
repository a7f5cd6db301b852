// Greedy packing has several plans, and joining lengthens lives: the first that gets registers,
// from the cheapest packing on, counts.
#include "generator/target/d3d9/generate/candidate.h"

#include <algorithm>

#include "generator/target/d3d9/generate/finish.h"
#include "generator/target/d3d9/generate/pack.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {

bool better(const Candidate& a, const Candidate& b) {
    if (a.fits() != b.fits()) return a.fits();
    if (a.at_least.has_value() != b.at_least.has_value()) return !a.at_least;
    const Slots x = a.at_least ? *a.at_least : slots_of(a.shader),
                y = b.at_least ? *b.at_least : slots_of(b.shader);
    return std::pair(x.arithmetic, x.texture) < std::pair(y.arithmetic, y.texture);
}

namespace {

// How many placements one packing may try: about a second's worth, fewer for long shaders.
int evaluations_for(const Graph& graph) {
    return static_cast<int>(20'000'000 / (graph.nodes.size() * graph.nodes.size() / 8 + 1000));
}

Candidate try_orders(const ir::Module& module, const Graph& graph, Profile profile) {
    std::optional<Candidate> best;
    for (const Order order : all_orders) {
        const Finished finished = finish(module, graph, order_of(graph, order), profile);
        Candidate candidate;
        candidate.shader = finished.shader;
        candidate.failure = finished.failure;
        candidate.failed_at = finished.failed_at;
        if (!candidate.failure) candidate.violations = check(candidate.shader);
        if (!best || better(candidate, *best)) best = std::move(candidate);
    }
    return std::move(*best);
}

// How many joins may be given up for registers.
constexpr std::size_t most_given_up = 8;

// Joining lengthens lives: what got no registers may fit with a few joins less.
Candidate cheapest_fitting(const ir::Module& module, const std::vector<Graph>& packings,
                           Profile profile) {
    std::optional<Candidate> best;
    const std::size_t last = packings.size() > most_given_up ? packings.size() - most_given_up : 0;
    for (std::size_t i = packings.size(); i-- > last;) {
        Candidate candidate = try_orders(module, packings[i], profile);
        if (!best || better(candidate, *best)) best = std::move(candidate);
        if (best->fits()) break;
    }
    return std::move(*best);
}

}  // namespace

Candidate best_of(const ir::Module& module, const Graph& graph, Profile profile) {
    int next = 0;
    const std::vector<int> uniforms = assign_uniforms(module, graph, next);
    std::optional<Candidate> best;
    for (const std::vector<Graph>& packings :
         pack(graph, limits_of(profile), uniforms, evaluations_for(graph))) {
        Candidate candidate = cheapest_fitting(module, packings, profile);
        if (!best || better(candidate, *best)) best = std::move(candidate);
    }
    best->inputs = graph.inputs;
    return std::move(*best);
}

}  // namespace intaglio::d3d9

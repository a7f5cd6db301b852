// Paths over a graph whose loops are marked by their heads, as in SPIR-V's structured control flow.
#include "src/check/control_flow.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace intaglio::check {
namespace {

constexpr std::int64_t saturated = std::numeric_limits<std::int64_t>::max() / 4;
constexpr int end_of_function = -1;

// Both arguments lie in [0, saturated].
std::int64_t add(std::int64_t a, std::int64_t b) { return std::min(a + b, saturated); }
std::int64_t multiply(std::int64_t a, std::int64_t b) {
    return a != 0 && b > saturated / a ? saturated : a * b;
}

// Where a path can go on, and what getting there costs.
using Exits = std::map<int, PathCost>;

void offer(Exits& exits, int target, PathCost cost) {
    const auto [place, is_new] = exits.try_emplace(target, cost);
    if (is_new) return;
    place->second.shortest = std::min(place->second.shortest, cost.shortest);
    place->second.longest = std::max(place->second.longest, cost.longest);
}

class Paths {
  public:
    Paths(const std::vector<FlowBlock>& blocks, int loop_bound)
        : blocks_(blocks), loop_bound_(loop_bound) {}

    // From `head` through blocks of `region`, each at most once, to whatever lies outside of it;
    // the way back to `head` counts as outside.
    Exits through(int head, const std::set<int>& region) {
        std::map<int, Exits> steps;
        const std::vector<int> order = topological_order(head, region, steps);
        Exits arrivals{{head, {}}};
        Exits exits;
        for (const int block : order) {
            const PathCost here = arrivals.at(block);
            for (const auto& [target, cost] : steps.at(block)) {
                const PathCost there{add(here.shortest, cost.shortest),
                                     add(here.longest, cost.longest)};
                const bool inside = target != head && region.count(target) > 0;
                offer(inside ? arrivals : exits, target, there);
            }
        }
        return exits;
    }

    // Blocks that `head` reaches without passing `barrier`.
    std::set<int> reached(int head, int barrier) const {
        std::set<int> found{head};
        std::vector<int> pending{head};
        while (!pending.empty()) {
            const int block = pending.back();
            pending.pop_back();
            for (const int next : blocks_[index(block)].successors) {
                if (next != barrier && found.insert(next).second) pending.push_back(next);
            }
        }
        return found;
    }

  private:
    static std::size_t index(int block) { return static_cast<std::size_t>(block); }

    // One step from a block, a whole inner loop being one step.
    Exits step(int block, int head) {
        const FlowBlock& current = blocks_[index(block)];
        if (current.loop_merge >= 0 && block != head) return loop(block);
        Exits exits;
        if (current.ends) offer(exits, end_of_function, current.cost);
        for (const int next : current.successors) offer(exits, next, current.cost);
        return exits;
    }

    Exits loop(int head) {
        Exits exits = through(head, reached(head, blocks_[index(head)].loop_merge));
        const auto back = exits.find(head);
        if (back == exits.end())
            return exits;  // never repeats: glslang and spirv-opt make such shells
        const std::int64_t pass = back->second.longest;
        exits.erase(back);
        std::int64_t cheapest = saturated;
        for (const auto& [target, cost] : exits) cheapest = std::min(cheapest, cost.shortest);
        for (auto& [target, cost] : exits) {
            const std::int64_t early =
                add(multiply(std::max(loop_bound_ - 1, 0), pass), cost.longest);
            const std::int64_t tested = add(multiply(loop_bound_, pass), cost.shortest);
            cost.longest = cost.shortest == cheapest ? std::max(early, tested) : early;
        }
        return exits;
    }

    // Depth first, without recursion over blocks: an unrolled march has thousands in a row.
    std::vector<int> topological_order(int head, const std::set<int>& region,
                                       std::map<int, Exits>& steps) {
        struct Visit {
            int block;
            Exits::const_iterator next;
        };
        std::vector<int> postorder;
        std::vector<Visit> stack;
        const auto enter = [&](int block) {
            const auto placed = steps.emplace(block, step(block, head)).first;
            stack.push_back({block, placed->second.begin()});
        };
        enter(head);
        while (!stack.empty()) {
            Visit& top = stack.back();
            if (top.next == steps.at(top.block).end()) {
                postorder.push_back(top.block);
                stack.pop_back();
                continue;
            }
            const int target = (top.next++)->first;
            if (region.count(target) > 0 && steps.count(target) == 0) enter(target);
        }
        std::reverse(postorder.begin(), postorder.end());
        return postorder;
    }

    const std::vector<FlowBlock>& blocks_;
    const int loop_bound_;
};

}  // namespace

std::optional<PathCost> path_cost(const std::vector<FlowBlock>& blocks, int loop_bound) {
    if (blocks.empty()) return std::nullopt;
    // The entry is never the head of a loop: SPIR-V forbids branches to it.
    Paths paths(blocks, loop_bound);
    const Exits exits = paths.through(0, paths.reached(0, end_of_function));
    const auto end = exits.find(end_of_function);
    if (end == exits.end()) return std::nullopt;
    return end->second;
}

std::vector<bool> reachable_blocks(const std::vector<FlowBlock>& blocks) {
    std::vector<bool> result(blocks.size(), false);
    if (blocks.empty()) return result;
    for (const int block : Paths(blocks, 0).reached(0, end_of_function)) {
        result[static_cast<std::size_t>(block)] = true;
    }
    return result;
}

}  // namespace intaglio::check

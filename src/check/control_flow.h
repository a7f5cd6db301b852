// Cheapest and dearest way through a structured control flow graph, each loop passed at most a
// given number of times. The idea: a loop is collapsed, innermost first, into edges to the places
// where it can be left.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace intaglio::check {

struct PathCost {
    std::int64_t shortest = 0;
    std::int64_t longest = 0;
    bool operator==(const PathCost&) const = default;
};

struct FlowBlock {
    PathCost cost;  // of passing through the block
    std::vector<int>
        successors;       // indices; empty: the path ends here when `ends`, else it cannot be taken
    bool ends = false;    // return or discard
    int loop_merge = -1;  // index of the block after the loop when this block heads one
};

// From block 0 to any end.  Shortest: no back edge is taken.  Longest: a loop of N = `loop_bound`
// >= 0 whole passes costs N times its dearest pass, and leaves by its cheapest exit (the failing
// test at the head of a `for`) or, on the last pass, by a dearer one (an early exit); so it grows
// linearly with N.  A loop tested at its end may be counted one pass too dear.  Saturates instead
// of overflowing.  nullopt: no path ends.
std::optional<PathCost> path_cost(const std::vector<FlowBlock>& blocks, int loop_bound);

// Whether block 0 can reach each block.
std::vector<bool> reachable_blocks(const std::vector<FlowBlock>& blocks);

}  // namespace intaglio::check

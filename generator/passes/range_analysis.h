// What every value of a module may be, from its constants and from what is assumed: one forward
// walk that runs loops iteration by iteration, so that what depends on the index stays sharp, and
// long ones once for all (Cousot and Cousot, "Abstract Interpretation", 1977).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "generator/passes/ranges.h"

namespace intaglio::passes {

using Restriction = std::array<std::optional<Range>, 4>;  // by component

struct Assumptions {
    // By value.  Whoever restricts one component of a value says that none of them is NaN.
    std::vector<Restriction> values;
    std::vector<Restriction> samplers;  // by slot, of every texel read
};

struct RangeFacts {
    // By value, in all visits; nothing at all: it is never computed.
    std::vector<Ranges> values;
    // By a loop's index parameter: how many iterations are ever needed, if fewer than it has.
    std::map<ir::ValueId, int> trips;
    // A value outside loops and ifs that cannot be what is assumed of it.
    std::optional<ir::ValueId> impossible;
};

// Instructions that the iterations of one loop may take, those of loops inside it included; a loop
// that takes more is entered once for all iterations.
inline constexpr long affordable_iterations = 20000;

// The module must verify.
RangeFacts analyze_ranges(const ir::Module& module, const Assumptions& assumptions,
                          long affordable = affordable_iterations);

}  // namespace intaglio::passes

// Searches of which one only asks whether they hit: a shadow ray's.  Private to lower_first_hit.
//
// After the loop, its results serve only to compare again what the loop compared; every hit gives
// the comparison the same truth.  Beside the hit, the loop may end at a stop that stays once it
// came: the ray has left the relief.
#pragma once

#include <optional>
#include <vector>

#include "generator/passes/first_hit_loop.h"

namespace intaglio::passes {

// greater > lesser, or greater >= lesser.
struct Comparison {
    ir::ValueId greater{}, lesser{};
    bool strict = false;
};
// Nothing unless the instruction compares floats by order.
std::optional<Comparison> comparison_of(const ir::Module& module,
                                        const ir::Instruction& instruction);

// A comparison after the loop: the hit's own, or its opposite.
struct Truth {
    ir::ValueId value{};
    bool of_hit = false;
};

struct AnyHit {
    Comparison hit;                   // of values inside the loop
    std::optional<ir::ValueId> stop;  // the other half of the loop's condition
    std::vector<Truth> truths;        // all that the loop's results are used for
};

// Whether the loop at this position of the region is one, as far as its uses tell.
std::optional<AnyHit> find_any_hit(const ir::Module& module, const ir::Region& region,
                                   std::size_t position);

// True if the condition, once it holds, holds in all later iterations: a comparison of a sum,
// product or table that grows with the index to a value from outside.
bool stays(const ir::Module& module, const Definitions& definitions, const FirstHitLoop& search,
           ir::ValueId condition);

// True if the stop, which stays, says that the hit's lesser side has reached 1 and the greater side
// is a texel of the iteration before: texels in [0, 1] do not hit any more.
bool is_above_texels(const ir::Module& module, const Definitions& definitions,
                     const FirstHitLoop& search, const AnyHit& any);

}  // namespace intaglio::passes

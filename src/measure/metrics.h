// Numbers from pictures of hits: how much hits swim as the camera moves, and which source an error
// comes from.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "src/measure/hits.h"

namespace intaglio::measure {

// The view a tenth of a degree lower, or higher where it would reach the horizon.
inline constexpr double swim_step = 0.1;  // degrees
Direction moved_view(Direction view);

// How the change of a reported hit from one view to the next differs from that of the exact hit: a
// constant error does not swim.  Texels; pixels with NaN or Inf in either picture do not count.
struct Swim {
    double median = 0, p95 = 0, max = 0;
    int worst_x = 0, worst_y = 0;  // where max is
    std::int64_t pixels = 0;
};
Swim swim_of(const vulkan::Picture& before, const vulkan::Picture& after,
             const ExactPicture& exact_before, const ExactPicture& exact_after, int map_width,
             int map_height);

// Hits of the same rays: uv and what else comes after it.
using Hits = std::vector<std::array<double, 4>>;
Hits hits_in(const vulkan::Picture& picture);

// The same surface four times over, on the same rays.
struct SplitHits {
    Hits technique;   // in double, filtered exactly
    Hits filter;      // in double, filtered with 8-bit weights
    Hits arithmetic;  // in the arithmetic of the case, filtered exactly
    Hits total;       // in the arithmetic of the case, filtered with 8-bit weights
};

// A hit's error as a vector in texels is that of the technique (technique - exact), of the filter
// and of the arithmetic.  What one of the last two does depends on whether the other is there: each
// counts with the mean of both orders (its Shapley value),
//     filter     = ((filter - technique) + (total - arithmetic)) / 2
//     arithmetic = ((arithmetic - technique) + (total - filter)) / 2.
// Each mean is of the part's length along the whole error, so that
//     total = technique + filter + arithmetic,
// and a part that works against the others is negative.  `interaction` is what filter and
// arithmetic do together beyond what they do alone: half of it is in each.
struct ErrorSplit {
    std::int64_t rays = 0;     // that count: no NaN and no Inf in any of the four
    std::int64_t invalid = 0;  // the others
    double total = 0, technique = 0, filter = 0, arithmetic = 0, interaction = 0;  // texels
    // Mean lengths of the parts by themselves, where neither of the others is.
    double technique_alone = 0, filter_alone = 0, arithmetic_alone = 0;
};
ErrorSplit split_error(const SplitHits& hits, const ExactPicture& exact, int map_width,
                       int map_height);

}  // namespace intaglio::measure

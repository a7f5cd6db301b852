// How long a pixel takes on the device, of every variant of a page: what no stored result holds,
// because a time belongs to a machine and an hour.
#pragma once

#include "src/measure/map_set.h"
#include "src/report/page_data.h"

namespace intaglio::report {

// Draws each variant that the device runs `rounds` times, one after the other round after round, so
// that what else the machine does falls on all alike; on the first map that is not empty and that
// it was measured on, from the view of that map's data nearest to 30 degrees.  variants[i].time = {ratio, ratio_low, ratio_high}: over
// the rounds the median and the quartiles of the time relative to the first such variant's in the
// same round; made_by.time says all of this.  Nothing where no map is known, or where
// the cases have times of their own.
Status add_times(PageData& page, const dsl::Catalogue& catalogue,
                 const std::vector<measure::MapSet>& maps, int rounds);

}  // namespace intaglio::report

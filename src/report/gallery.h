// The report's pictures: renders, exact pictures, and errors and texture reads as one byte a pixel,
// which the page colours.
#pragma once

#include "src/measure/map_set.h"
#include "src/report/page_data.h"

namespace intaglio::report {

struct GalleryOptions {
    int size = 192;    // pixels a side
    bool all = false;  // every variant in place of one a technique
};

// Draws each technique's variant in the middle of its settings on every map, seen from the
// elevation of the data that is nearest to 30 degrees: json["gallery"] = {size, least_error,
// most_error, entries: [{map, variant, view, light, exact, render, error, reads, reads_step,
// reads_max}], exact: [data URL]}.  `maps` in the order of the data's; empty ones are left out.
// Pictures are PNG data URLs.  A byte of `error` is 0 to 253, logarithmic from least to most error,
// 254 for a missed hit, 255 for NaN; one of `reads` is the count divided by reads_step.
Status add_gallery(PageData& page, const dsl::Catalogue& catalogue,
                   const std::vector<measure::MapSet>& maps, const GalleryOptions& options);

}  // namespace intaglio::report

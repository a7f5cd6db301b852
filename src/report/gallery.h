// The report's pictures: renders, exact pictures, and errors and texture reads as one byte a pixel,
// which the page colours.
#pragma once

#include <optional>
#include <vector>

#include "src/measure/map_set.h"
#include "src/measure/shot.h"
#include "src/report/page_data.h"

namespace intaglio::report {

// Where the gallery sees a map from: of the data's views the one nearest to 30 degrees, with its
// light and scale, in 192 x 192 pixels.  Nothing where no case is on the map.
std::optional<measure::Shot> shown_shot(const PageData& page, std::size_t map);
// Variants with a case on the map whose target the device runs as it is, in the data's order: all
// but the Direct3D 9 profiles.
std::vector<std::size_t> drawn_variants(const PageData& page, std::size_t map);

struct GalleryOptions {
    int size = 192;  // pixels a side
};

// Draws, on every map, of the variants that were measured on it each technique's in the middle of
// its settings (of a planned scene all), seen from the elevation of the data that is nearest to 30 degrees: json["gallery"]
// = {size, least_error, most_error, entries: [{map, variant, view, light, exact, render, error,
// reads, reads_step, reads_max}], exact: [data URL]}.  `maps` in the order of the data's; empty
// ones are left out.
// Pictures are PNG data URLs.  A byte of `error` is 0 to 253, logarithmic from least to most error,
// 254 for a missed hit, 255 for NaN; one of `reads` is the count divided by reads_step.
Status add_gallery(PageData& page, const dsl::Catalogue& catalogue,
                   const std::vector<measure::MapSet>& maps, const GalleryOptions& options);

}  // namespace intaglio::report

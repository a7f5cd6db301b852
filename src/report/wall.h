// A relief as the eye sees it.  The runner draws maps straight: one pixel for each place of the
// polygon, as if it were unrolled before the eye.  Here such a picture is laid down on the polygon
// and looked at under parallel rays from where it was drawn for, the map repeated as a wall would
// have it.
#pragma once

#include <optional>

#include "src/maps/image.h"
#include "src/measure/view.h"
#include "src/report/picture.h"

namespace intaglio::report {

struct WallView {
    measure::Direction view;
    int width = 192, height = 192;  // of the picture
    double across = 1;              // texture units that its width shows
    // Where the map is worn once and the eye sees past it: this colour.  None: it is repeated.
    std::optional<Rgb> outside = {};
};

// What a pixel shows of the straight pixels that it covers: their mean, or the nearest to its
// middle, for pictures whose colours are numbers.
enum class Footprint { Mean, Nearest };

// `straight`: over [0, 1]^2 of texture space, row 0 at v = 0.  The middle of the map is in the
// middle, and an eye at azimuth 90 sees u grow to the right: letters read.
maps::Image wall_picture(const maps::Image& straight, const WallView& wall, Footprint footprint);

}  // namespace intaglio::report

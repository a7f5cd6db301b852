// Normal maps from height maps.
#pragma once

#include "generator/base/result.h"
#include "src/maps/image.h"
#include "src/maps/work.h"

namespace intaglio::maps {

// How slopes are estimated from neighbours.  Central: the difference of the two neighbours along
// the axis, exact for quadratic surfaces.  Sobel: the same, averaged over three rows with weights 1
// 2 1, which suppresses noise across the slope and costs a little sharpness.
enum class NormalKernel { Central, Sobel };

// What lies beyond the border.  Repeat: the opposite side.  Clamp: nothing; slopes at the border
// are one-sided.
enum class Wrap { Repeat, Clamp };

// The tangent space normal of each texel, encoded as n * 0.5 + 0.5 in three channels with the
// precision of `heights`:
//     n = normalize(-dh/du * scale, -dh/dv * scale, 1)
// where h is the first channel of `heights` and `scale` the depth of the relief in texture units
// (the width of the map is 1, and so is its height, whatever its number of texels).  v grows
// downwards, with the rows of the image, so y of the normal points towards larger v: where the
// surface rises downwards in the picture, y is below one half. (Tools whose v grows upwards store 1
// - y.)  A negative scale turns the relief inside out. Codes: "image-malformed"; "scale-range" (the
// magnitude of the scale is at most 1e6).
Result<Image> bake_normal(const Image& heights, double scale, NormalKernel kernel, Wrap wrap,
                          const Work& work = {});

}  // namespace intaglio::maps

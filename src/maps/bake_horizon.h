// Horizon maps: how high the relief stands around each texel, by azimuth.  A point sees the light
// if the light is above the horizon.  Max, "Horizon mapping", The Visual Computer, 1988; Sloan and
// Cohen, "Interactive Horizon Mapping", 2000.
#pragma once

#include <vector>

#include "generator/base/result.h"
#include "src/maps/image.h"
#include "src/maps/work.h"

namespace intaglio::maps {

// The slope, in height per texture unit, that is stored as one half.
inline constexpr double horizon_middle = 16.0;

// `azimuths` / 4 images of four channels with the precision of `heights`.  Direction k is
//     (cos, sin)(360 degrees * k / azimuths)   in texture coordinates, v downwards,
// and lies in image k % (azimuths / 4), channel k / (azimuths / 4): image 0 of every map is
// +u, +v, -u, -v, and of eight azimuths image 1 is the diagonals that follow each of them.
//
// The value of a direction d at texel p is the steepest slope of the bilinear surface,
//     m = sup over r > 0 of (H(p + r d) - H(p)) / r,  not below 0, r in texture units,
// stored as m / (m + horizon_middle), rounded to nearest.  Heights are in [0, 1], so m does not
// depend on the relief's scale: a light is above the horizon where
//     L.z (1 - value) > horizon_middle * value * scale * length(L.xy).
// Exact at the texel and in its azimuths for 4 and 8 of them: the line repeats after 1 or sqrt(2)
// texture units.  For more, what is more than 2 texture units away is left out, which is a slope of
// at most 1/2.  Between texels and azimuths the shader interpolates, which is an approximation.
// Texels times azimuths times the cells until nothing higher can follow.
//
// Codes: "image-malformed"; "azimuths-range" unless a multiple of 4 from 4 to 64.
Result<std::vector<Image>> bake_horizon(const Image& heights, int azimuths = 8,
                                        const Work& work = {});

}  // namespace intaglio::maps

// The phong map of fast bump mapping: brightness by direction, so that shading is one read at the
// polygon's own place in it plus the bump's offset.  "Fast Bump Mapping" (seeds), after Phong.
#pragma once

#include "generator/base/result.h"
#include "src/maps/image.h"

namespace intaglio::maps {

// The offset at the map's edge: a little more than 1, so that all of the border is 0 and a
// repeating sampler mixes nothing in.
inline constexpr double phong_edge = 1.125;

// size x size texels of 8 bits, two channels: diffuse light and highlight of a normal at the offset
//     (x, y) = (((column + 0.5) / size, (row + 0.5) / size) * 2 - 1) * phong_edge
// from the direction that is lit most:
//     cosine = sqrt(max(0, 1 - x^2 - y^2)),  highlight = cosine^shininess,  rounded to nearest.
// Beyond the unit circle both are 0.  An offset is read at offset / (2 phong_edge) + 0.5,
// saturated.
//
// Codes: "image-size" unless 16 to 4096; "shininess-range" unless 0 < shininess <= 1024.
Result<Image> bake_phong(double shininess = 32, int size = 256);

}  // namespace intaglio::maps

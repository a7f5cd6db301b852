// What the exact searches skip by and solve: for each patch of the bilinear surface its corners, and
// the highest points of squares around it.  Our own; the squares are dilations of the relief at
// four sizes, where a quadtree of maxima (bake_max_mip.h) has only aligned ones.
#pragma once

#include <array>
#include <vector>

#include "generator/base/result.h"
#include "src/maps/image.h"

namespace intaglio::maps {

// How many patches the squares of bake_summit reach beyond their middle one, on every side.
inline constexpr std::array summit_reach = {0, 2, 6, 20};

// Texel (i, j) stands for the patch between the centres of texels (i, j) and (i + 1, j + 1) of the
// height map, as in bake_max_mip, and is read nearest.  Four channels, size and precision of
// `heights`: the highest point of the bilinear surface over all patches (k, l) with |k - i| <= r and
// |l - j| <= r, for r of summit_reach, exactly; the map repeats.  The other levels of a chain sized
// as mip levels are hold the highest of what they cover: the last one texel, the top of the map.
// O(n) for n texels.  Code: "image-malformed".
Result<std::vector<Image>> bake_summit(const Image& heights);

// The corners of each patch: the heights of texels (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)
// in four channels, so that one read knows the whole patch.  Code: "image-malformed".
Result<Image> bake_patch(const Image& heights);

}  // namespace intaglio::maps

// The quadtree of highest and lowest points: a ray above a node's maximum crosses the whole node
// without a hit.  Tevs, Ihrke and Seidel, "Maximum Mipmaps", 2008; Drobot, "Quadtree Displacement
// Mapping", GPU Pro, 2010.
#pragma once

#include <vector>

#include "generator/base/result.h"
#include "src/maps/image.h"

namespace intaglio::maps {

// The levels of a chain, sized as mip levels are (each half the one before, rounded down, not below
// 1), two channels of the precision of `heights`: the highest and the lowest point of the bilinear
// surface over the node, exactly.
//
// Texel (i, j) of level 0 stands for the patch between the centres of texels (i, j) and (i + 1,
// j + 1) of the height map: a node is found half a texel away from where the height is,
//     node of uv = floor((uv - 0.5 / size) * size of the level),
// and read nearest.  Texel (i, j) of a level of w by h stands for [i / w, (i + 1) / w] x [j / h,
// (j + 1) / h] in those shifted coordinates, at any size: where a size is odd, nodes overlap the
// borders of their children, and cover all that they touch.  O(n) for n texels.
//
// Codes: "image-malformed".
Result<std::vector<Image>> bake_max_mip(const Image& heights);

// The levels as one image, for a file: each below the one before, at the left, the rest 0.  Code:
// "image-size" where that is too high.
Result<Image> stacked(const std::vector<Image>& levels);

}  // namespace intaglio::maps

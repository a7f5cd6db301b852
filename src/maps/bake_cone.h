// Cone maps: over each texel, how wide a cone opens upwards that no other part of the surface
// reaches into.  A search steps to the border of the cone and never through the surface.
//
// Dummer, "Cone Step Mapping", 2006; Policarpo and Oliveira, "Relaxed Cone Stepping for Relief
// Mapping", GPU Gems 3, 2007.  Both bake cones over texels, which under bilinear filtering lets
// rays slip through; these cones hold for the filtered surface.
#pragma once

#include "generator/base/result.h"
#include "src/maps/image.h"
#include "src/maps/work.h"

namespace intaglio::maps {

enum class ConeKind {
    // Nothing of the surface is inside the cone: over every point p of the texel's footprint,
    //     H(q) <= H(p) + |q - p| / ratio   for every q.
    Empty,
    // A ray that enters the surface inside the cone does not leave it inside the cone: the same,
    // for those q only where the surface falls in the direction from p to q.
    Relaxed,
};

// The widest cone that is stored, in texture units of radius per unit of height.
inline constexpr double widest_cone = 1.0;

// Two channels, with the precision of `heights`: the height as given, and sqrt(ratio).  `ratio` is
// the radius of the cone, in texture units, at one unit of height above its apex; heights are in
// [0, 1], so the ratio does not depend on the relief's scale.  A ray that travels `reach` texture
// units horizontally while it descends by 1, and is `gap` above the surface, may advance by
//     ratio * gap / (reach + ratio)   in height.
//
// Safe, read linearly or nearest, at any position: the root is rounded down, and a texel's cone
// holds for every p within a texel of it along either axis, so each of the texels that a bilinear
// read mixes has a cone that holds where it is read, and so has their mean.  The last bits of the
// shader's own arithmetic, and 8-bit filter weights (1/256 of the difference between neighbours),
// are not covered.
//
// Method: for a pair of cells (bilinear patches) A and B at least two apart, with n the unit
// vector between them, |q - p| >= n.(q - p), and H(q) - H(p) - m n.(q - p) is largest at corners:
// the steepest slope m between A and B is bounded by 16 corner pairs.  Nearer pairs are bounded by
// the gradients along the way.  Blocks of cells too low to matter are skipped.  At worst
// O(n^2 / 64 + pairs that are close to touching) for n texels.
//
// Codes: "image-malformed".
Result<Image> bake_cone(const Image& heights, ConeKind kind, const Work& work = {});

}  // namespace intaglio::maps

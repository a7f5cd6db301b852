// View-dependent displacement: where the view ray meets the relief, baked for every texel and view.
// Wang, Wang, Tong, Lin, Hu, Guo and Shum, "View-Dependent Displacement Mapping", 2003, without its
// dimension of curvature.
#pragma once

#include "generator/base/result.h"
#include "src/maps/bake_distance.h"

namespace intaglio::maps {

// A view is known by its reach: the texture units that the ray travels from height 1 to 0,
//     reach = V.xy / V.z * scale,
// so the map does not depend on the scale.  Reaches of any length are mapped into the unit disc,
//     direction = reach / (length(reach) + view_middle),
// and the square [-1, 1]^2 around it is covered by a grid of `views` x `views` directions, the
// corners of (views - 1)^2 cells.
inline constexpr double view_middle = 0.25;
// Directions beyond are baked as this one, with reach 9 view_middle.
inline constexpr double widest_view = 0.9;

// A volume with one slice for each cell of directions: slice y * (views - 1) + x is the cell with
// the corners (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) of the grid, whose values are its
// four channels, in this order.  The value is t, the ray's parameter at its first hit, exact at the
// texel's centre and rounded to nearest: the hit is at uv - reach * t, the height there 1 - t.
//
// Read linearly at the slice's centre, w = (slice + 0.5) / slices, so that only texels of that
// slice mix; the shader then mixes the four channels by the direction's place in its cell.  Between
// texels and directions t is interpolated, which is wrong where the hit jumps from one feature to
// the next: the technique is of the unsafe class.
//
// `columns` x `rows` texels, or the map's own size where that is smaller: texel (x, y) is at
// ((x + 0.5) / columns, (y + 0.5) / rows).  Texels times views squared times the cells until the
// hit.  Codes: "image-malformed"; "views-range" unless 2 to 32; "image-size".
Result<Volume> bake_view_dependent(const Image& heights, int columns = 128, int rows = 128,
                                   int views = 9, const Work& work = {});

}  // namespace intaglio::maps

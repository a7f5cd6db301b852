// What a relief and the directions it is seen and lit from say before anything is drawn: heights,
// slopes, and how far rays can go.  Each is a bound that holds for every ray; the proof stands with
// it.  The relief is the surface that the texture unit reconstructs: bilinear patches between texel
// centres (src/reference/height_field.h), exact weights.
#pragma once

#include <array>

#include "generator/passes/assume.h"
#include "src/reference/height_field.h"
#include "src/vulkan/texture.h"

namespace intaglio::measure {

// Directions to the eye or to a light, tangent space, degrees: elevation above the polygon, azimuth
// from +u towards +v, most - least <= 360.  Inclusive.
struct Directions {
    double least_elevation = 90, most_elevation = 90;
    double least_azimuth = 0, most_azimuth = 360;
};

// Bounds of the components of the unit vector, as a shader computes it: widened by 2^-16, more than
// an interpolation and a normalize in binary32 are off by.
std::array<passes::Interval, 3> vector_ranges(const Directions& directions);

// What a channel (0 to 3) of a texture gives whatever is read: on all levels, between texels and
// between levels, as its format stores it; widened by 2^-16 for the rounding of the filter.
// Proof: a filtered texel is a mean of texels with weights from 0 to 1 that add up to 1, also where
// the weights are rounded to 8 bits, so it lies between the least and the greatest of them.
passes::Interval channel_range(const vulkan::Texture& texture, int channel);

// Heights are those of the map, in [0, 1].
struct ReliefFacts {
    int width = 0, height = 0;
    // Exact: a bilinear patch is a mean of its corners, and reaches them.
    double least = 0, most = 1;
};
// The field must be valid.
ReliefFacts relief_facts(const reference::HeightField& field);

// --- light

// The greatest rise of the relief along a light's path, per length along the polygon, over all
// azimuths of the range: a light whose elevation has at least this tangent, from that side, throws
// no shadow from any point of the surface on another.  `scale`: depth of the relief in texture
// units.
// Proof: let s be the height that the light ray has gained over a point where it touches the
// surface.  The surface's height along the path minus the ray's is continuous, 0 at s = 0, and
// piecewise smooth; if its derivative is at most 0 everywhere, it never becomes positive.  Along a
// direction (a, b) in texture units the height changes by scale (h_u a + h_v b); in one patch h_u
// is linear in v and h_v in u, so that the sum is linear in both and greatest at a corner.  At a
// corner with gradient g it is |g| cos(angle between), greatest where the azimuth is that of g or
// at an end of the range.
// With 8-bit weights the surface is a staircase around the patches; its risers, up to 1/256 of the
// difference of two texels high, throw shadows of that size.
double steepest_slope(const reference::HeightField& field, double scale,
                      const Directions& directions);
// Whether no light of the range can shadow anything: all of them are as steep as the steepest
// slope.
bool casts_no_shadow(const reference::HeightField& field, double scale,
                     const Directions& directions);

// --- rays

// How far a ray may go that begins at the height `from` of the relief and ends at `to` (view rays
// go down, light rays up), over all directions; elevations of the range must lie in (0, 90].
struct RayReach {
    // Texels, at most: along u, along v, along the longer of the two, and both added.
    // Proof: over a height of d the ray moves by cot(elevation) scale d in texture units, and
    // cos(azimuth) of it along u; each is monotone between the places where the azimuth meets an
    // axis or the diagonal of the map's texels, which are looked at beside the ends.
    double along_u = 0, along_v = 0, longer = 0, added = 0;

    // Cells (patches or texels) that the ray touches, at most, one after the other across their
    // sides: what bounds `max_cells`, `max_leaps` and `shadow_cells` of the exact search and
    // shadow, and `max_steps` of steep_parallax with stride = 2 or 3.
    // Proof: a segment that is d long on an axis has at most floor(d) + 1 whole numbers on it.  It
    // crosses a line for each, on either axis, and stands in one cell more: floor(along_u) +
    // floor(along_v) + 3 <= floor(added) + 3.  Two more, one on each axis, for a line that rounding
    // puts on the other side of an end.
    int cells() const;
    // Equal steps over this reach, at least so many that no step is longer than a texel on either
    // axis: on the axis along which the ray is longer every texel that it passes over has a sample.
    // Proof: a step moves by longer / steps <= 1 on each axis, so that no unit interval is stepped
    // over.  More steps find no texel that these skip; what they still improve is the place of the
    // hit within a texel, which refinement does with fewer reads.
    int steps() const;
};
RayReach ray_reach(const ReliefFacts& facts, double scale, const Directions& directions,
                   double from, double to);
// View rays, from the polygon (height 1) down to the deepest point of the relief, where at the
// latest they have met it.
RayReach view_reach(const ReliefFacts& facts, double scale, const Directions& directions);
// The part of it that lies below the highest point: what a search walks that begins there, as the
// exact one with baked maps does.
RayReach view_reach_below_top(const ReliefFacts& facts, double scale, const Directions& directions);
// Light rays, from the deepest point up to the highest, above which nothing is in the way.
RayReach light_reach(const ReliefFacts& facts, double scale, const Directions& directions);

// Halvings of one of `steps` steps over the reach after which the bracket is at most `texels` long:
// more of them move a hit by less.  Proof: k halvings leave longer / (steps 2^k) on either axis.
int useful_halvings(const RayReach& reach, int steps, double texels);

}  // namespace intaglio::measure

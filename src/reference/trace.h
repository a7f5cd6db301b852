// What every search and every shadow is measured against: the first point where a view ray meets
// the height field, and whether a point of it sees the light.  Cell by cell along the ray, the
// quadratic of each cell solved in double precision; nothing is sampled, so nothing is missed.
//
// Exactness.  With a path of n texels per unit of t, positions are exact to about 1e-16 (n + width)
// texels and hits to that times the slope of the surface: |height_at(hit.uv) - hit.height| stays
// below some 1e-15 (n + width + 1). A summit that a ray passes within that distance may count as
// touched or as missed.
//
// Range.  Rays steeper than max_travel allows are answered; a ray closer to the horizon than that
// (89.9999 degrees on a map of 1024 texels with scale 0.1), below it, or not finite, has no answer:
// not found, not lit.
#pragma once

#include "src/reference/height_field.h"

namespace intaglio::reference {

// The longest path, in texels along either axis for a height of 1, that is walked.
inline constexpr double max_travel = 67108864.0;  // 2^26

// Two surfaces closer than this touch and do not shadow each other.  In units of height: far above
// the rounding of a hit, far below a step of a 16-bit map (1.5e-5).
inline constexpr double contact_tolerance = 1e-9;

struct Hit {
    bool found;
    double t;       // in [0, 1], from the polygon (0) to the deepest point (1)
    Vec2 uv;        // uv - V.xy / V.z * scale * t, in the unwrapped coordinates of the caller
    double height;  // of the ray, 1 - t; the surface is there too, unless it rises above the
                    // polygon at t = 0
};

// The smallest t in [0, 1] at which the surface reaches the ray:
//     height_at(uv - V.xy / V.z * scale * t) >= 1 - t.
// `view` points from the surface to the eye, of any length; `scale` is the depth of the relief in
// texture units.  With heights in [0, 1] there always is a hit.
//
// Not found, t = 0, `uv` unchanged and height 1 when view.z <= 0, anything is not finite, the field
// is not valid or the path longer than max_travel.
//
// 8-bit weights: on the riser between two steps of the staircase both heights count; where a ray
// passes a corner between four steps within rounding, any of the four may.
Hit first_hit(const HeightField& field, Vec2 uv, Vec3 view, double scale);

// Whether the point (uv, height) sees the light: no point of
//     uv + L.xy / L.z * scale * s,  s in (0, 1 - height],
// has a surface more than `tolerance` above height + s.  `light` points to the light, of any
// length.
//
// The point is meant to lie on the surface and so touches it: the path counts from 1e-6 texel on,
// which also puts a point on a riser (8-bit weights) on the step that the light's direction leads
// to.  A point inside the relief is not lit.
//
// Not lit either when light.z <= 0, anything is not finite, the field is not valid or the path
// longer than max_travel.
//
// 8-bit weights: the risers of the staircase throw shadows of their own, up to 1/256 of the
// difference between neighbouring texels high; a tolerance of that size leaves them out.
bool lit(const HeightField& field, Vec2 uv, double height, Vec3 light, double scale,
         double tolerance = contact_tolerance);

// Whether a view ray that has reached the relief at t_begin rises out of it again before t_end:
// somewhere between, the surface lies more than `tolerance` below the ray,
//     height_at(uv - V.xy / V.z * scale * t) < 1 - t - tolerance.
// A search that reports t_end went through a feature then.  The default tolerance is half a step of
// an 8-bit map: less is not a feature that a map could hold.  False where first_hit has no answer,
// and where t_end <= t_begin. With 8-bit weights the smooth patches are asked, not the staircase,
// whose steps are smaller than the tolerance.
bool leaves_relief(const HeightField& field, Vec2 uv, Vec3 view, double scale, double t_begin,
                   double t_end, double tolerance = 0.5 / 255);

}  // namespace intaglio::reference

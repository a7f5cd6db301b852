// Cameras as tables of four rows: clip[i] = dot(row i, float4(position, 1)), the order in which
// shaders read a `float4 view_projection[4]`.  Clip space is Vulkan's: x to the right, y DOWN (y =
// -1 is the top row of the picture), depth 0 at the near plane and 1 at the far plane.
#pragma once

#include <array>

#include "generator/base/result.h"

namespace intaglio::vulkan {

using Point = std::array<float, 3>;

struct Camera {
    std::array<float, 16> view_projection{};  // four rows of four
    Point eye{};                              // in world space; for map_quad() far above the quad
    std::array<float, 4> clip(Point position) const;
};

struct Perspective {
    float vertical_degrees = 45;  // full angle of view, above 0 and below 180
    float aspect = 1;             // width / height
    float near_plane = 0.1f;      // distances along the view direction, 0 < near < far
    float far_plane = 100;
};

// A camera at `eye` that looks at `target`, with `up` upwards in the picture; the world is
// right-handed.  Where `up` is along the view (straight down with z up), +y is upwards instead, and
// +x where that is along the view too. Errors: `bad-camera` when the eye is at the target or a
// number of the projection is out of range.
Result<Camera> look_at(Point eye, Point target, Point up, const Perspective& perspective);

// The unit quad exactly on the whole target: pixel (x, y) of a W by H picture has uv ((x + .5) / W,
// (y + .5) / H).
Camera map_quad();

}  // namespace intaglio::vulkan

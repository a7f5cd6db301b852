// View and projection multiplied into one table, in double, rounded once.
#include "src/vulkan/camera.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace intaglio::vulkan {
namespace {

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector scaled(const Vector& a, double by) { return {a[0] * by, a[1] * by, a[2] * by}; }

// An axis orthogonal to `forward`, to the right when `up` is upwards.
Vector right_of(const Vector& forward, const Vector& up) {
    // Below this sine of the angle between them the direction is mostly rounding of float input.
    constexpr double too_parallel = 1e-6;
    for (const Vector& candidate : {up, Vector{0, 1, 0}, Vector{1, 0, 0}}) {
        const Vector right = cross(forward, candidate);
        const double length = std::sqrt(dot(right, right));
        const double up_length = std::sqrt(dot(candidate, candidate));
        if (length > too_parallel * up_length) return scaled(right, 1 / length);
    }
    return {1, 0, 0};  // not reached for a finite forward: it cannot be along both +y and +x
}

bool valid(const Perspective& p) {
    return p.vertical_degrees > 0 && p.vertical_degrees < 180 && p.aspect > 0 &&
           std::isfinite(p.aspect) && p.near_plane > 0 && p.far_plane > p.near_plane &&
           std::isfinite(p.far_plane);
}

}  // namespace

std::array<float, 4> Camera::clip(Point position) const {
    std::array<float, 4> result{};
    for (std::size_t i = 0; i < 4; ++i) {
        const float* row = &view_projection[4 * i];
        result[i] = row[0] * position[0] + row[1] * position[1] + row[2] * position[2] + row[3];
    }
    return result;
}

Result<Camera> look_at(Point eye, Point target, Point up, const Perspective& perspective) {
    if (!valid(perspective)) {
        return input_error("bad-camera",
                           fmt::format("a camera needs an angle of view between 0 and 180 degrees, "
                                       "a positive aspect and 0 < near < "
                                       "far, and was given {} degrees, aspect {}, near {}, far {}",
                                       perspective.vertical_degrees, perspective.aspect,
                                       perspective.near_plane, perspective.far_plane));
    }
    const Vector from{eye[0], eye[1], eye[2]};
    Vector forward{target[0] - from[0], target[1] - from[1], target[2] - from[2]};
    const double distance = std::sqrt(dot(forward, forward));
    if (!(distance > 0) || !std::isfinite(distance)) {
        return input_error("bad-camera",
                           fmt::format("a camera at ({}, {}, {}) cannot look at ({}, {}, {})",
                                       eye[0], eye[1], eye[2], target[0], target[1], target[2]));
    }
    forward = scaled(forward, 1 / distance);
    const Vector right = right_of(forward, {up[0], up[1], up[2]});
    const Vector down = cross(forward, right);

    const double zoom = 1 / std::tan(perspective.vertical_degrees * std::numbers::pi / 360);
    const double near = perspective.near_plane, far = perspective.far_plane;
    const double depth_scale = far / (far - near);
    const std::array<Vector, 4> axes = {scaled(right, zoom / perspective.aspect),
                                        scaled(down, zoom), scaled(forward, depth_scale), forward};
    Camera camera;
    camera.eye = eye;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            camera.view_projection[4 * i + k] = static_cast<float>(axes[i][k]);
        const double offset = -dot(axes[i], from) - (i == 2 ? depth_scale * near : 0);
        camera.view_projection[4 * i + 3] = static_cast<float>(offset);
    }
    return camera;
}

Camera map_quad() {
    Camera camera;
    camera.view_projection = {2, 0, 0, -1, 0, 2, 0, -1, 0, 0, 0, 0, 0, 0, 0, 1};
    camera.eye = {0.5f, 0.5f, 1e6f};
    return camera;
}

}  // namespace intaglio::vulkan

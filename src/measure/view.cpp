// Directions to vectors and uniforms.
#include "src/measure/view.h"

#include <cmath>
#include <numbers>

#include "generator/dsl/technique.h"
#include "src/vulkan/camera.h"

namespace intaglio::measure {

std::array<float, 3> vector_of(Direction direction) {
    // Straight down is exact: cos of a rounded 90 degrees is 6e-17, and the case matters.
    if (direction.elevation == 90) return {0.0f, 0.0f, 1.0f};
    const double elevation = direction.elevation * std::numbers::pi / 180;
    const double azimuth = direction.azimuth * std::numbers::pi / 180;
    const auto snapped = [](double value) {
        return std::abs(value) < 1e-15 ? 0.0f : static_cast<float>(value);
    };
    return {snapped(std::cos(elevation) * std::cos(azimuth)),
            snapped(std::cos(elevation) * std::sin(azimuth)),
            static_cast<float>(std::sin(elevation))};
}

reference::Vec3 exact_vector(const std::array<float, 3>& vector) {
    return {vector[0], vector[1], vector[2]};
}

std::map<std::string, std::vector<float>> uniforms_of(Direction view, Direction light, double scale,
                                                      int map_width, int map_height,
                                                      const Look& look) {
    const std::array<float, 3> v = vector_of(view);
    const std::array<float, 3> l = vector_of(light);
    const vulkan::Camera camera = vulkan::map_quad();
    std::map<std::string, std::vector<float>> uniforms = {
        {"world", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
        {"view_projection", {camera.view_projection.begin(), camera.view_projection.end()}},
        {"eye", {v[0], v[1], v[2], 0}},
        {"light", {l[0], l[1], l[2], 0}},
        {"scale", {static_cast<float>(scale)}},
        {"map_size", {static_cast<float>(map_width), static_cast<float>(map_height)}},
        {"ambient", {look.ambient.begin(), look.ambient.end()}},
        {"light_colour", {look.light_colour.begin(), look.light_colour.end()}},
        {"gloss", {look.gloss}},
        {"map_tangents", {1, 0, 0, 1}},
        {"tile", {0, 0, 1, 1}},
        {"texture_span", {1}},
    };
    for (std::size_t i = 0; i < look.further.size(); ++i) {
        const FurtherLight& further = look.further[i];
        const std::array<float, 3> to_light = vector_of(further.direction);
        const int number = static_cast<int>(i) + 1;
        uniforms[dsl::name_of_light("light", number)] = {to_light[0], to_light[1], to_light[2], 0};
        uniforms[dsl::name_of_light("light_colour", number)] = {further.colour.begin(),
                                                                further.colour.end()};
    }
    return uniforms;
}

}  // namespace intaglio::measure

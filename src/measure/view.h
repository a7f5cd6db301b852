// Directions over a relief, and what a draw gets for them.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "src/reference/trace.h"

namespace intaglio::measure {

// A direction in tangent space.  Elevation 90 is straight above the surface, 0 is its horizon;
// azimuth 0 is along +u, 90 along +v.  Degrees.
struct Direction {
    double elevation = 90;
    double azimuth = 0;
    bool operator==(const Direction&) const = default;
};

// The unit vector, rounded to float as shaders get it.
std::array<float, 3> vector_of(Direction direction);
reference::Vec3 exact_vector(const std::array<float, 3>& vector);

// A light after the first; the first is aimed by whoever draws.
struct FurtherLight {
    Direction direction;
    std::array<float, 3> colour;
};

// The lights and material of every draw.
struct Look {
    std::array<float, 3> ambient = {0.25f, 0.27f, 0.33f};
    std::array<float, 3> light_colour = {2.0f, 1.92f, 1.76f};
    float gloss = 0.25f;
    std::array<FurtherLight, 3> further = {{{{30, 255}, {0.35f, 0.5f, 0.9f}},
                                            {{60, 15}, {0.8f, 0.35f, 0.2f}},
                                            {{20, 90}, {0.3f, 0.7f, 0.35f}}}};
};

// Values for every uniform of the templates, by name: the eye and the light at infinity, the world
// unmoved.
std::map<std::string, std::vector<float>> uniforms_of(Direction view, Direction light, double scale,
                                                      int map_width, int map_height,
                                                      const Look& look = {});

}  // namespace intaglio::measure

// One ray of the hard suite, and what becomes of a case's rays: fine, degraded or broken.
#pragma once

#include <map>
#include <span>
#include <string>

#include "src/measure/hard.h"
#include "src/reference/trace.h"

namespace intaglio::measure {

// What a shader was given at one pixel, and the truth about it.
struct HardRay {
    int x = 0, y = 0;  // pixel of the picture
    int aim = 0;       // index into the case's
    // What the vertex stage hands on, by name: uv, to_eye, to_light, depth_line.
    std::map<std::string, std::array<double, 4>> inputs{};
    std::array<double, 2> uv{};       // as interpolated
    reference::Vec3 view{}, light{};  // tangent space; the view no flatter than its guard makes it
    std::array<double, 2> reach{};    // how far the ray travels in texture space
    reference::Hit exact{};
    bool lit = false;
};

// The ray from where the format holds its coordinate: what is left is not the coordinate's
// rounding.
HardRay from_held_coordinate(const HardRay& ray, const reference::HeightField& field, double scale,
                             Way way);
// Whether every input of the ray is a number of the format.
bool has_numbers_for(const HardRay& ray, Way way);

// What a shader gave, and what its own formula gives in real numbers.
struct HardOutcome {
    std::array<double, 4> value{}, own{};
    double depth = 0;  // where it writes one, in the evaluator; else 0
};

// Both by ray.  `field`: the case's relief.
HardCell judge(const HardRow& row, const HardCase& hard_case, Expect expect, Way way,
               const reference::HeightField& field, std::span<const HardRay> rays,
               std::span<const HardOutcome> outcomes);

// The distance from a number of this size to the next in the way's format.
double unit_in_the_last_place(double value, Way way);
// A number as the format holds it.
double held(double value, Way way);

}  // namespace intaglio::measure

// What passes from the vertex to the pixel stage, and in which components of which register: both
// stages ask here, so that they agree.
#pragma once

#include <array>
#include <vector>

#include "generator/ir/module.h"
#include "generator/passes/hoist_to_vertex.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

struct InterpolantPlace {
    int index = 0;                         // t#, or v# and its texcoord usage in model 3
    int width = 4;                         // components of the value
    std::array<int, 4> lanes{0, 1, 2, 3};  // register component of each of them
    friend bool operator==(const InterpolantPlace&, const InterpolantPlace&) = default;
};

// What a vertex attribute is to a vertex declaration.
struct AttributeUsage {
    Usage usage = Usage::Texcoord;
    int index = 0;
};

// The index of the vertex shader's position, which is no interpolant.
inline constexpr int position_output = -1;

// For each input of the optimised pixel module its place.  No two inputs share a component.
std::vector<InterpolantPlace> interpolant_places(const ir::Module& pixel, Profile profile);

// How many interpolants may pass: as many as interpolant_places() puts into eight registers.
passes::InterpolantLimits interpolant_limits(Profile profile);

// The components of register `index` that these places cover.
Mask lanes_of_register(const std::vector<InterpolantPlace>& places, int index);

}  // namespace intaglio::d3d9

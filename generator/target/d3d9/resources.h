// What a Direct3D 9 shader uses of each limited resource, and how much is left.
#pragma once

#include <string_view>
#include <vector>

#include "generator/target/d3d9/limits.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// Registers are counted as the highest number used, plus one: that is what the limit is on.
// Definitions count as use.
struct Resources {
    int arithmetic = 0, texture = 0, total = 0;  // slots, by the validator's charge
    int temps = 0, constants = 0, integers = 0, booleans = 0, samplers = 0;
    int inputs = 0;          // v#
    int texcoords = 0;       // t# of a pixel shader, oT# of a vertex shader
    int colour_outputs = 0;  // oC#, oD#
    int outputs = 0;         // o# of vs_3_0
    int dependent_level = 0;
};
Resources count(const Shader& shader);

// The order of each texture instruction, -1 for the others: how many texture reads wait for each
// other, as Direct3D's validator counts.  Every r# carries an order, at first 0, which a write
// never lowers; a read whose coordinate is an r#, or whose destination was written before, comes
// one after both.  texkill of an r# reads and writes it.
std::vector<int> dependent_levels(const Shader& shader);

// One row for each resource that the profile limits.
struct Headroom {
    std::string_view resource;  // "arithmetic slots", "temporary registers" ...
    int used = 0;
    int limit = 0;
    int left() const { return limit - used; }
};
std::vector<Headroom> headroom(const Shader& shader);
std::vector<Headroom> headroom(const Resources& used, const Limits& limits);

}  // namespace intaglio::d3d9

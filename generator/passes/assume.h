// What a scene knows of a shader before it runs: uniforms whose value never changes, and ranges of
// values.  Constants are folded and decided comparisons, guards and selects left out; wherever what
// is assumed holds, not one bit of the result changes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/ir/module.h"

namespace intaglio::passes {

// Inclusive.
struct Interval {
    float least, most;
    bool operator==(const Interval&) const = default;
};

struct Known {
    // By the uniform's name, its components.  The uniform is gone.
    std::map<std::string, std::vector<float>> uniforms;
    // By the name a value was given in the DSL and a component ("view.z"), or a texture and its
    // channel ("height_map.x").
    std::map<std::string, Interval> ranges;
    bool empty() const { return uniforms.empty() && ranges.empty(); }
    bool operator==(const Known&) const = default;
};

}  // namespace intaglio::passes

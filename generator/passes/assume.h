// What a scene knows of a shader before it runs: uniforms whose value never changes, and ranges of
// values.  Constants are folded and decided comparisons, guards and selects left out; wherever what
// is assumed holds, not one bit of the result changes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/ir/module.h"

namespace intaglio::passes {

// Inclusive.  A range that ends at +0 holds no -0; NaN is in no range.
struct Interval {
    float least, most;
    bool operator==(const Interval&) const = default;
};

struct Known {
    // By the uniform's name, its components; of an array (a matrix is one of its rows) element by
    // element.  The uniform is gone from both stages.
    std::map<std::string, std::vector<float>> uniforms;
    // By name and component ("view.z"; of a scalar the name alone).  The name is the first of
    // these: one that the pixel stage's DSL gave to values, an interpolant or parameter, a texture
    // ("height_map.x": whatever is read from that channel), a uniform, one that the vertex stage's
    // DSL gave.  A range of one component of a value says that no component of it is NaN; where
    // derivatives are taken, it is that of the neighbouring pixels too.
    std::map<std::string, Interval> ranges;
    bool empty() const { return uniforms.empty() && ranges.empty(); }
    bool operator==(const Known&) const = default;
};

// As the command line takes it and shaders' headers show it: "scale = 0.05", "view.z = 0.25..1".
std::vector<std::string> to_strings(const Known& known);

// Folds what is known into the program as recorded: fixed uniforms become constants; of what the
// ranges decide, comparisons become constants, max, min, saturate and abs one of their operands,
// and loops lose the iterations that never come.  Sound for binary32 as the ops table has it, and
// for devices within Vulkan's bounds; where an assumption does not hold, the result may be
// anything.  Ends without dead code; the program's settings say what was assumed.  Gives a sentence
// for each thing left out.
// Errors, each a sentence with the nearest right name: "unknown-uniform", "uniform-components",
// "unknown-value", "value-component"; "range-empty" for NaN or a least above the most,
// "range-impossible" for a range that no input leads to.
Result<std::vector<std::string>> assume(ir::Program& program, const Known& known);

// What of it the program has names for: one pass of a surface does not have them all.
Known part_of(const Known& known, const ir::Program& program);

}  // namespace intaglio::passes

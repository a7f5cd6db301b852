// Prints the body of a stage or function: declarations, assignments, loops and ifs, with a comment where a step of
// the technique begins.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/base/text.h"
#include "generator/target/clike/expressions.h"
#include "generator/target/clike/names.h"

namespace intaglio::clike {

// How a body hands over its outputs.
struct Ending {
    std::vector<std::string> stores;  // for each output what stands left of "=": "color", "precise vec3 hit"
    std::string after;                // a last statement, "return hit;"; may be empty
    // With one output and no stores: "return <expression>;".
};

// `scope` holds the names that the shell has declared; `out` is inside the braces of the body.
Status print_body(TextBuilder& out, const ir::Module& module, const Spelling& spelling, const OuterNames& outer,
                  const Ending& ending, NameScope& scope);

}  // namespace intaglio::clike

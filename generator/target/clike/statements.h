// Prints the body of a stage or function: declarations, assignments, loops and ifs, with a comment
// where a step of the technique begins.
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
    std::string before;               // a first statement, "Targets result;"; may be empty
    // For each output what stands left of "=", "color", or a whole statement with %0 where the
    // value's name goes, "clip(%0);"; empty: the one output is returned.
    std::vector<std::string> stores;
    std::string result_name;          // wanted for the returned value, should it need a name
    std::string after;                // a last statement, "return result;"; may be empty
};

// `scope` holds the names that the shell has declared; `out` is inside the braces of the body.
Status print_body(TextBuilder& out, const ir::Module& module, const Spelling& spelling,
                  const OuterNames& outer, const Ending& ending, NameScope& scope);

}  // namespace intaglio::clike

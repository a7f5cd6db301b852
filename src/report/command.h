// How a variant is called in reports, and the command line that draws it again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/measure/measure.h"

namespace intaglio::report {

// For each map of a plan the arguments of `intaglio run` that stand for it, for instance
// {"--height", "wall.png"} (scene::Scene has them).  A map beyond the end has none.
using MapArguments = std::vector<std::vector<std::string>>;

// A form as scenes and command lines write it, "loop" or "unroll"; "schedule" where none is asked
// for.
std::string_view word_of(ir::LoopForm form);

// What was asked of a variant besides surface and target: "taps=8 march:unroll per_vertex".
std::string settings_of(const VariantRequest& request);

// Quoted for a POSIX shell where it must be.
std::string shell_quoted(const std::string& argument);

// The command that draws the picture of a case and the map of its errors: same variant, map, view,
// light, scale and size.  Empty where the map has no arguments.
std::string run_command(const measure::Plan& plan, const measure::CaseResult& result,
                        const MapArguments& map_arguments);

}  // namespace intaglio::report

// How a variant is called in reports, and the command line that draws it again.
#pragma once

#include <string>
#include <vector>

#include "src/measure/command.h"
#include "src/measure/measure.h"

namespace intaglio::report {

// For each map of a plan the arguments of `intaglio run` that stand for it, for instance
// {"--height", "wall.png"} (scene::Measurement has them).  A map beyond the end has none.
using MapArguments = std::vector<std::vector<std::string>>;

using measure::word_of;

// What was asked of a variant besides surface and target: "taps=8 march:unroll per_vertex".
std::string settings_of(const VariantRequest& request);

using measure::shell_quoted;

// The command that draws the picture of a case and the map of its errors: same variant, map, view,
// light, scale and size.  Empty where the map has no arguments.
std::string run_command(const measure::Plan& plan, const measure::CaseResult& result,
                        const MapArguments& map_arguments);

}  // namespace intaglio::report

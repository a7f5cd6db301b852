// A case as words: the variant it draws, and the command line that draws it again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/maps/files.h"
#include "src/measure/case.h"

namespace intaglio::measure {

// A form as scenes and command lines write it, "loop" or "unroll"; "schedule" where none is asked
// for.
std::string_view word_of(ir::LoopForm form);
// The form that a word means; Unspecified for every other.
ir::LoopForm form_of(std::string_view word);

// Surface, target, knobs by name, loops and the rest: two requests with the same text draw the
// same.
std::string text_of(const VariantRequest& request);

// The options of `intaglio run`, `emit` and `explain` that say the same, each a word, unquoted.
std::vector<std::string> variant_options(const VariantRequest& request);

using maps::shell_quoted;

// `intaglio run` with the variant, the map (its arguments), the view, light, scale, size and the
// device (part of its name; empty: lavapipe), then `more`.
std::string run_command(const Case& what, const std::vector<std::string>& map_arguments,
                        const std::string& device, const std::vector<std::string>& more);

}  // namespace intaglio::measure

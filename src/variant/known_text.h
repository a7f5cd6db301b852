// What is known of a shader before it runs, as people and results write it.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/passes/assume.h"

namespace intaglio {

// `fixed`: "scale=0.05", "ambient=0.1,0.1,0.1"; `assumed`: "view.z=0.25..1", or "view.z=0.5" for
// both ends.  Spaces around the equals sign do not count.  Error "known-syntax".
Result<passes::Known> known_in(const std::vector<std::string>& fixed,
                               const std::vector<std::string>& assumed);

// What passes::to_strings gave, bit for bit: "scale = 0.05", "view.z = 0.25..1".  Error
// "known-syntax".
Result<passes::Known> known_in(const std::vector<std::string>& lines);

}  // namespace intaglio

// The nearest of several names, for error messages that say what was probably meant.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace intaglio {

// The candidate with the least edit distance to `name`, or empty if none is near (more than half of
// it differs).
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

// "unknown KIND 'name'; did you mean 'x'?" or, if none is near, "unknown KIND 'name'; there are: a,
// b, c".
std::string unknown_name_sentence(std::string_view kind, std::string_view name,
                                  std::span<const std::string> candidates);

}  // namespace intaglio

// A depfile as Make and Ninja read it: what the build read, so that they run it again when any of
// it changes.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::build {

// "target: a b ...", each path escaped as GCC does: blanks, $, # and colons.  Neither tool has a
// way to say a line break, or a backslash at a path's end: error "depfile-path", which says which
// path.
Result<std::string> depfile_text(const std::string& target,
                                 const std::vector<std::string>& dependencies);

}  // namespace intaglio::build

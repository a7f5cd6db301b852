// Reads the text of print.h back.  Written by hand it may leave out names, comments and origins,
// may hold comments
// ("// ..."), and may call its values by words (%height) instead of numbers: a word then is the
// value's name.
#pragma once

#include <string_view>

#include "generator/base/result.h"
#include "generator/ir/module.h"

namespace intaglio::ir {

// The module, not verified (see verify.h); or the first mistake as "file:line:col: error: sentence
// [ir-parse]". Any bytes are safe to read.  A file_name is only for the message.
Result<Module> parse(std::string_view text, std::string_view file_name);

// Regions nest at most this deep in text.
constexpr int max_nesting = 64;

}  // namespace intaglio::ir

// The parts of hand-written pages that a command writes: between two comments, which say whose they
// are.
//   <!-- intaglio pages search=relief -->
//   ...
//   <!-- end of what intaglio pages wrote -->
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::report {

// The titles of a page's blocks, in order.
std::vector<std::string> blocks_of(std::string_view page);

// What stands in the block of that title; empty where there is none.
std::string block_text(std::string_view page, std::string_view title);

// The page with `text` in place of what the block held; `text` ends in a line break.  `file` is for
// the errors.  Codes: "page-block": no such block, or it does not end.
Result<std::string> with_block(std::string_view page, std::string_view title, std::string_view text,
                               const std::string& file);

}  // namespace intaglio::report

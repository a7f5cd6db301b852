// Reads sources as text and reports what the rules forbid.  Text in, sentences out: the tests feed
// it made-up files as well as the tree.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/tree/rules.h"

namespace intaglio::tree {

// One sentence for each include that `rules` forbid, each beginning with "path:line: ".  `path` is
// relative to the repository, with forward slashes.
std::vector<std::string> check_includes(const Rules& rules, std::string_view path,
                                        std::string_view text);

// One sentence for a file that is too long, and one for each line with a mark of unfinished work.
std::vector<std::string> check_text(const Rules& rules, std::string_view path,
                                    std::string_view text);

// One sentence for each row that contradicts the table: a row it sees that does not exist, or a
// circle of rows.
std::vector<std::string> check_rules(const Rules& rules);

}  // namespace intaglio::tree

// Completion in a shell: the shell's script asks the program itself what may follow, so that it
// knows the program's own techniques, and never goes stale.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"
#include "src/cli/description.h"

namespace intaglio::cli {

// The command that the scripts call; not one that people need, so it is no part of the help.
constexpr const char* complete_command = "complete-words";

// What the last of `words`, which may be empty, can become.  The words are those after the
// program's name.  A line is a whole word, a tab and what it is; where the word ends in "=" or ",",
// more of it may follow.  Or it is
//   :files TAB prefix        a file's name after the prefix, which may be empty
//   :files=png TAB prefix    one with that ending
//   :folders TAB prefix      a folder's
std::string complete_words(const CommandText& program, const dsl::Catalogue& catalogue,
                           const std::vector<std::string>& words);

// The script for a program of that name; bash or zsh.  Code "unknown-shell".
Result<std::string> completion_script(const std::string& shell, const std::string& program);

}  // namespace intaglio::cli

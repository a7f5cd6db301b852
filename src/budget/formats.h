// A verdict for a person and for the programs that CI owners have.
#pragma once

#include <string>
#include <vector>

#include "src/budget/verdict.h"

namespace intaglio::budget {

// A table in the manner of driver people's: what got worse first, the most first, then what got
// better, then totals; above it what fails, with the line that spends it and the command that shows
// it.
std::string to_text(const Verdict& verdict);
// {schema: "intaglio.check", version, passes, findings, notes}
std::string to_json(const Verdict& verdict);
// One test case for each limited metric of each variant; failures and skipped (waived) ones say
// why.
std::string to_junit(const Verdict& verdict);
// Workflow commands: ::error file=...,line=...,title=...::sentence
std::string to_github(const Verdict& verdict);
// SARIF 2.1.0: a result for each finding that is not fine, at the line of C++ where it is known,
// else at the line of the budget file.
std::string to_sarif(const Verdict& verdict);

// What `git apply --unidiff-zero` takes to turn the old text of a baseline file, lines sorted, into
// the new one; empty where they are equal.
std::string to_patch(const std::string& file, const std::string& before, const std::string& after);

}  // namespace intaglio::budget

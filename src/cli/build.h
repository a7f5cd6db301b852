// `intaglio build` and `intaglio cache`: the commands of the build step.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"

namespace CLI {
class App;
}

namespace intaglio::cli {

// Adds the commands; `chosen` is set to the work of the one that was named.
void add_build(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen);

// The arguments of a program with the compilers' -MD, -MF and -MT spelled as the parser takes them.
std::vector<std::string> with_long_names(int count, const char* const* arguments);

}  // namespace intaglio::cli

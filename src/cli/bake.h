// `intaglio bake`: the command with a subcommand for each kind of map.
#pragma once

#include <functional>

#include "generator/base/result.h"

namespace CLI {
class App;
}

namespace intaglio::cli {

// Adds the command; `chosen` is set to the work of the kind that was named.
void add_bake(CLI::App& app, std::function<Status()>& chosen);

}  // namespace intaglio::cli

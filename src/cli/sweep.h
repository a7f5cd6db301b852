// `intaglio sweep` and `intaglio merge`.
#pragma once

#include <functional>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"

namespace CLI {
class App;
}

namespace intaglio::cli {

// Adds both commands; `chosen` is set to the work of the one that was named.
void add_sweep(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen);

}  // namespace intaglio::cli

// `intaglio savings`.
#pragma once

#include <functional>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"

namespace CLI {
class App;
}

namespace intaglio::cli {

// Adds the command; `chosen` is set to its work if it was named.
void add_savings(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen);

}  // namespace intaglio::cli

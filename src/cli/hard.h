// `intaglio hard` and `intaglio stability`: the hard suite and the stable formulas as pages.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"

namespace intaglio::cli {

// Each adds its command; `chosen` is set to its work when it is named.
void add_hard(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen);
void add_stability(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen);

}  // namespace intaglio::cli

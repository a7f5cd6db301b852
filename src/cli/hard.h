// `intaglio hard`: the hard suite as a page.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"

namespace intaglio::cli {

// Adds the command; `chosen` is set to its work when it is named.
void add_hard(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen);

}  // namespace intaglio::cli

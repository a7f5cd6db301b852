// `intaglio run` of a case as sweeps measure it: in an arithmetic of its own, with a pixel explained.
#pragma once

#include <string>
#include <vector>

#include "src/cli/commands.h"
#include "src/measure/hits.h"

namespace intaglio::cli {

// Whether the options ask for more than a picture of the device.
bool is_case(const RunOptions& options);
Status run_case(const dsl::Catalogue& catalogue, const RunOptions& options);

// Says what the errors are and writes a map of them.
Status write_error_map(const std::vector<measure::HitError>& errors, const std::string& path,
                       int width);

}  // namespace intaglio::cli

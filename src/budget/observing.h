// How measurements become numbers under metrics' names.  Inside src/budget only.
#pragma once

#include <string>

#include "src/budget/observation.h"

namespace intaglio::budget {

// Keeps the worst of several cases under one name, to six digits.
void add_worst(Observation& into, const std::string& metric, double value,
               const std::string& command);
// `suffix`: of the metrics of a narrow arithmetic, "_fp24"; else empty, and all are there.
void add_hits(Observation& into, const measure::HitStatistics& hits, const std::string& suffix,
              const std::string& command);
void add_slots(Observation& into, const d3d9::Resources& used);
void add_spirv(Observation& into, const check::SpirvCost& cost);
// Who spends what of the pixel stage.
Status add_lines(Observation& into, const dsl::Catalogue& catalogue, const VariantRequest& request);

}  // namespace intaglio::budget

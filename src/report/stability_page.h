// Published formulas beside ours, and what the guards cost, as a page: docs/stability.md.
#pragma once

#include <string>
#include <vector>

#include "src/measure/guards.h"
#include "src/measure/stability.h"

namespace intaglio::report {

// Markdown; the same measurements give the same bytes.
std::string stability_page(const std::vector<measure::StabilityCurve>& curves,
                           const std::vector<measure::GuardRow>& guards);

// Its two halves, so that a test can compare one.
std::string stability_section(const std::vector<measure::StabilityCurve>& curves);
std::string guards_section(const std::vector<measure::GuardRow>& guards);

}  // namespace intaglio::report

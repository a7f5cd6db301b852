// Published formulas beside ours, and what the guards cost, as a page: docs/stability.md.
#pragma once

#include <string>
#include <vector>

#include "src/measure/far_origin.h"
#include "src/measure/guards.h"
#include "src/measure/stability.h"
#include "src/report/plot.h"

namespace intaglio::report {

struct StabilityPage {
    std::string text;  // Markdown; the same measurements give the same bytes
    std::vector<Plot> plots;
};
// Plots are found under `pictures`.
StabilityPage stability_page(const std::vector<measure::StabilityCurve>& curves,
                             const std::vector<measure::FarRow>& far,
                             const std::vector<measure::FarCost>& far_costs,
                             const std::vector<measure::GuardRow>& guards,
                             const std::string& pictures);

// Its parts, so that a test can compare one.
std::string stability_section(const std::vector<measure::StabilityCurve>& curves,
                              const std::string& pictures);
std::string far_section(const std::vector<measure::FarRow>& rows,
                        const std::vector<measure::FarCost>& costs);
std::string guards_section(const std::vector<measure::GuardRow>& guards);
// One line of its table.
std::string guard_line(const measure::GuardRow& row);
// Error of both forms, a panel for each precision.
Plot stability_plot(const measure::StabilityCurve& curve);

}  // namespace intaglio::report

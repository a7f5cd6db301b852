// Formulas as their sources publish them beside the forms that the templates use: the same
// quantity, written twice in the DSL, evaluated in fp32, fp24 and fp16 on the same inputs.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "generator/ir/evaluate.h"

namespace intaglio::measure {

inline constexpr std::array stability_precisions = {ir::Precision::Single, ir::Precision::Narrow24,
                                                    ir::Precision::Narrow16};

// Of one form in one precision: |value - truth| in the comparison's unit; NaN or Inf where the form
// gave such.
struct StabilityPoint {
    std::string at;  // the input in words: "60 degrees"
    std::array<double, stability_precisions.size()> published, ours;
};

struct StabilityCurve {
    std::string title;
    std::string source;     // who publishes it so
    std::string published;  // both forms in words
    std::string ours;
    std::string unit;     // of the errors: "of the offset", "texels of a 1024 map"
    std::string verdict;  // what to see
    std::vector<StabilityPoint> points;
};

// All comparisons, each point the greatest error over a few inputs around it.
std::vector<StabilityCurve> stability_curves();

}  // namespace intaglio::measure

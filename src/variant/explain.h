// Who spends what a variant costs, of variants that fit and of those that are refused.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/target/d3d9/explain.h"
#include "src/variant/variant.h"

namespace intaglio {

// One stage of a Direct3D 9 variant.
struct ExplainedStage {
    d3d9::Profile profile = d3d9::Profile::ps_2_0;
    d3d9::Explanation explanation;
    bool only_slots = false;  // refused for want of registers: their numbers mean nothing
};

struct ExplainedVariant {
    std::string name;                    // of the surface
    std::vector<std::string> settings;   // "taps = 8"
    std::vector<ExplainedStage> stages;  // the pixel stage first; no vertex stage for a refused one
    std::optional<Diagnostic> refusal;
    Notes notes;
};

// Errors: those of make_variant but for refusals by budget, and "not-explained" for targets other
// than the Direct3D 9 profiles.
Result<ExplainedVariant> explain_variant(const dsl::Catalogue& catalogue,
                                         const VariantRequest& request);

}  // namespace intaglio

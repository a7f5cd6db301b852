// Who spends what a variant costs, of variants that fit and of those that are refused.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/target/d3d9/explain.h"
#include "src/variant/variant.h"

namespace intaglio {

// One stage of a variant.  Of Direct3D 9 it counts slots.  Of a language it counts operations of
// the IR after all passes, each vector operation and each branch once, a loop's body once; it has
// no headroom, and its reads no level.
struct ExplainedStage {
    ir::Stage stage = ir::Stage::Pixel;
    std::optional<d3d9::Profile> profile;  // none: a language
    d3d9::Explanation explanation;
    bool only_slots = false;  // refused for want of registers: their numbers mean nothing
};

struct ExplainedVariant {
    std::string name;                    // of the surface
    std::vector<std::string> settings;   // "taps = 8"
    std::vector<ExplainedStage> stages;  // the pixel stage first; no vertex stage for a refused one
    std::optional<Diagnostic> refusal;
    Notes notes;
    Notes left_out;  // what is known made needless
};

// Errors: those of make_variant but for refusals by budget.
Result<ExplainedVariant> explain_variant(const dsl::Catalogue& catalogue,
                                         const VariantRequest& request);
// The same of what was recorded, and perhaps changed since.
Result<ExplainedVariant> explain_recorded(const Recorded& recorded);

}  // namespace intaglio

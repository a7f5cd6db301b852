// What each guard and each feature of a variant costs: the variant once more without it.  Guards
// are taken out of the recorded program (guards.h); a part of the surface gives way to the least of
// its kind, a knob or a flag to what switches its feature off.
#pragma once

#include <string>
#include <vector>

#include "src/variant/explain.h"

namespace intaglio::measure {

// The pixel stage, or the vertex stage where the target is a profile of those: slots of Direct3D 9,
// operations of a language, as in ExplainedVariant.
struct Spending {
    d3d9::Slots slots;
    bool fits = true;
    // Of a refused Direct3D 9 variant the first limit that it exceeds, of another the most used of
    // its limits on slots: "58 of 64 arithmetic slots".  Empty: a language.
    std::string limit;
};

struct Omission {
    enum class Kind { Guard, Part, Knob, Flag };
    Kind kind;
    std::string what;  // "dark light: L.z > 0", "shadow=none", "lights=1", "--per-vertex"
    Spending without;
};

struct Omissions {
    Spending with;
    std::vector<Omission> rows;  // features first; none that leaves the program as it is
};

// Costs a generation for each row; on `threads` threads, 0: as many as the machine has cores.
// Errors: those of explain_variant.
Result<Omissions> leave_out_each(const dsl::Catalogue& catalogue, const VariantRequest& request,
                                 int threads = 0);

}  // namespace intaglio::measure

// What every target makes of a technique, in Markdown: slots, instructions, or the sentence with
// which it refuses.
#pragma once

#include <string>
#include <vector>

#include "generator/dsl/catalogue.h"

namespace intaglio::report {

// Of a Direct3D 9 profile "33 + 9": arithmetic and texture slots by Direct3D's charge.  Of other
// targets "61 + 4, path 410": SPIR-V instructions of arithmetic and of textures after optimisation,
// and those of all kinds on the longest way through.  "emitted" where no SPIR-V can be made.
struct CostCell {
    std::string target;
    std::string cost;     // empty: refused
    std::string refusal;  // the sentence, without places in files, which change with every edit
};

// The pixel stage of a surface on every target that has one, in their order, with default knobs.
// Errors other than refusals are errors.  `part`: the costs of a part of the surface; where that is
// refused, so is the whole, which is not tried: neither cost nor refusal.
Result<std::vector<CostCell>> costs_of(const dsl::Catalogue& catalogue, const std::string& surface,
                                       const std::vector<CostCell>& part = {});

struct CostColumn {
    std::string heading;
    std::vector<CostCell> cells;  // of the same targets as the other columns'
};

// One line for all targets that come out the same, refusals numbered and written out below.
std::string cost_table(const std::vector<CostColumn>& columns);

}  // namespace intaglio::report

// Variants asked for by name, and what there is to ask for.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "src/variant/variant.h"
#include "templates/all_techniques.h"

namespace intaglio {

inline const dsl::Catalogue& catalogue() {
    static const dsl::Catalogue all = templates::all_techniques();
    return all;
}

inline VariantRequest request_of(const std::string& surface, const std::string& target,
                                 std::vector<std::pair<std::string, std::string>> knobs = {}) {
    VariantRequest request;
    request.surface = surface;
    request.target = target;
    request.knobs = std::move(knobs);
    return request;
}

}  // namespace intaglio

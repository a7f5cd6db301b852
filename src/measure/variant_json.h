// What a sweep's lines, a measurement and a cost say alike, as JSON.
#pragma once

#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "src/check/cost.h"
#include "src/measure/view.h"
#include "src/variant/variant.h"

namespace intaglio::measure {

// {surface, target, knobs: {name: text}, loops: {name: "loop" or "unroll"}, per_vertex}, and where
// anything is known of it, known: ["scale = 0.05", "view.z = 0.25..1"].
nlohmann::ordered_json json_of(const VariantRequest& request);
// The request that gave it; knobs may be numbers as well.  Errors: "not-results" where a member is
// missing or of another kind; "known-syntax".
Result<VariantRequest> request_of(const nlohmann::ordered_json& json);
nlohmann::ordered_json json_of(Direction direction);
nlohmann::ordered_json json_of(const check::SpirvCost& cost);
// Of a Direct3D 9 stage, else null.
nlohmann::ordered_json json_of(const std::optional<d3d9::Resources>& slots);

}  // namespace intaglio::measure

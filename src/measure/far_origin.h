// How far a hit moves when its coordinate lies whole tiles from the origin, for every search, with
// rays that start at the coordinate and with rays that start in the first tile (the knob
// local_origin); and what the knob costs.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"
#include "generator/ir/evaluate.h"

namespace intaglio::measure {

struct FarPlace {
    ir::Precision precision;
    double tiles;
};
// Where the format still holds places of 1/128 of a tile, so that nothing is lost before the shader
// begins.
inline constexpr std::array far_places = {
    FarPlace{ir::Precision::Single, 8},    FarPlace{ir::Precision::Single, 1000},
    FarPlace{ir::Precision::Single, 1e5},  FarPlace{ir::Precision::Narrow24, 8},
    FarPlace{ir::Precision::Narrow24, 64}, FarPlace{ir::Precision::Narrow24, 500},
    FarPlace{ir::Precision::Narrow16, 4}};

struct FarRow {
    std::string search;
    // Along the ray, in texels of a 1024 map: between the hit in the first tile and in that one.
    std::array<double, far_places.size()> without, with;
};
Result<std::vector<FarRow>> far_rows(const dsl::Catalogue& catalogue);

// Arithmetic slots of the pixel stage with local_origin 0, 1 and 2; empty where the target refuses.
struct FarCost {
    std::string surface, target;
    std::array<std::optional<int>, 3> slots;
};
Result<std::vector<FarCost>> far_costs(const dsl::Catalogue& catalogue);

}  // namespace intaglio::measure

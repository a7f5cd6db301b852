// The guards of the templates, one by one: what each costs on a target and what breaks without it.
// A surface without a guard is the recorded IR with the guard's instructions left out, so that the
// figures are of the guard alone.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"
#include "generator/ir/module.h"
#include "src/measure/hard_cases.h"
#include "src/vulkan/device.h"

namespace intaglio::measure {

enum class Guard {
    FlattestRay,   // max(z, 1/1024) under V.xy and L.xy
    ZeroVector,    // max(dot(v, v), 1e-18) in normalize
    ZeroDivisor,   // max(b, 1e-18) under any other division
    UnitInterval,  // the saturate of a ratio
    DarkLight,     // L.z > 0 beside a shadow's own answer
};
inline constexpr std::array all_guards = {Guard::FlattestRay, Guard::ZeroVector, Guard::ZeroDivisor,
                                          Guard::UnitInterval, Guard::DarkLight};
// "flattest ray: max(z, 1/1024)".
std::string_view name_of(Guard guard);

// Leaves the guard out wherever it stands; says how often that was.
int remove_guard(ir::Module& module, Guard guard);

// What a guard costs a surface on one target: arithmetic slots of the pixel stage by Direct3D's
// charge, or SPIR-V instructions after optimisation.
struct GuardCost {
    std::string target;
    std::optional<int> with, without;  // empty: the target refuses the surface
};

// One guard in one technique.
struct GuardRow {
    Guard guard;
    HardRow technique;    // of the hard suite; its knobs are those that are measured
    std::string surface;  // what the cost is of
    int places = 0;       // where the guard stands in the recorded pixel stage
    std::vector<GuardCost> costs = {};
    // Of the hard suite in fp32 without it: cases with NaN or Inf, cases with finite nonsense, and
    // cases that are further off than with it.
    std::vector<std::string> invalid = {}, astray = {}, worse = {};
};

// Every guard in the techniques that show what it is for, nothing measured yet.
std::vector<GuardRow> guard_rows();
// Costs, on ps_2_0, ps_2_b, ps_3_0 and glsl_450, and harm.
Status measure_guards(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                      std::vector<GuardRow>& rows);

}  // namespace intaglio::measure

// The table of targets.  A new one is a folder, and a line here.
#include <algorithm>

#include "generator/target/d3d9/rows/rows.h"
#include "generator/target/glsl/glsl.h"
#include "generator/target/hlsl/hlsl.h"
#include "generator/target/none/none.h"

namespace intaglio {
namespace {

// Made by src/check from the glsl_450 text, with tools that others wrote.
const Target spirv = {
    .name = "spirv",
    .description = "SPIR-V for Vulkan 1.1, optimised, from the text of glsl_450",
    .derived_from = "glsl_450",
    .capabilities = {.precise = true, .functions = false, .interpolants = {15, 60}},
    .legalize = {},
};
const Target msl = {
    .name = "msl",
    .description = "Metal, by SPIRV-Cross, from the text of glsl_450",
    .derived_from = "glsl_450",
    .capabilities = {.functions = false, .interpolants = {15, 60}},
    .legalize = {},
};

constexpr const Target* table[] = {&glsl_450, &glsl_330, &glsl_120, &essl_300, &essl_100, &hlsl_5_0,
                                   &hlsl_3_0, &hlsl_2_b, &hlsl_2_0, &ps_3_0,   &ps_2_b,   &ps_2_a,
                                   &ps_2_0,   &vs_3_0,   &vs_2_0,   &spirv,    &msl,      &none};

}  // namespace

std::span<const Target* const> all_targets() { return table; }

const Target* find_target(std::string_view name) {
    const auto* found = std::find_if(std::begin(table), std::end(table),
                                     [&](const Target* target) { return target->name == name; });
    return found == std::end(table) ? nullptr : *found;
}

}  // namespace intaglio

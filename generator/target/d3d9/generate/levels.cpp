// Levels that the profile cannot name, refused.
#include <fmt/format.h>

#include "generator/passes/coarser_read.h"
#include "generator/passes/rewrite.h"
#include "generator/target/d3d9/generate/lower.h"
#include "generator/target/d3d9/limits.h"

namespace intaglio::d3d9 {

Diagnostic refuse_level(const ir::Module& module, const ir::Instruction& read, Profile profile) {
    const std::string place = passes::place_of(module, read.origin);
    return input_error(
        "d3d9-level",
        fmt::format("{}{}{} cannot read {} at a mip level of the shader's choice; set level=0 (and "
                    "nyquist=0, max_leaps=0, shadow_leaps=0), or use ps_3_0",
                    place, place.empty() ? "" : ": ", name_of(profile),
                    module.samplers[static_cast<std::size_t>(read.slot)].name));
}

Status check_levels(const ir::Module& module, Profile profile) {
    if (limits_of(profile).model_3()) return Done{};
    const ir::Instruction* read = passes::find_coarser_read(module);
    if (read == nullptr) return Done{};
    return refuse_level(module, *read, profile);
}

}  // namespace intaglio::d3d9

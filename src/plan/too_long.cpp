// What need not be written out to know that its target has no room for it.
#include <fmt/format.h>

#include "generator/target/d3d9/limits.h"
#include "src/plan/surface_work.h"

namespace intaglio::plan {

std::string why_too_long(const Target& target, const Trial& written_out) {
    // Four lanes of a multiplication and an addition.
    constexpr int most_in_a_slot = 8;
    constexpr int most_operations = 20000;  // of a language without loops
    int reads = target.capabilities.texture_reads, arithmetic = 0;
    if (const auto profile = profile_of(target)) {
        const d3d9::Limits& limits = d3d9::limits_of(*profile);
        reads = limits.texture_slots;
        arithmetic = limits.arithmetic_slots;
    }
    if (reads > 0 && written_out.reads > reads)
        return fmt::format("{:.0f} texture reads written out, of at most {}", written_out.reads,
                           reads);
    const double slots = written_out.operations / most_in_a_slot;
    if (arithmetic > 0 && slots > arithmetic)
        return fmt::format("at least {:.0f} arithmetic slots, of at most {}", slots, arithmetic);
    if (arithmetic == 0 && written_out.operations > most_operations)
        return fmt::format("{:.0f} operations written out, of at most {} that are offered",
                           written_out.operations, most_operations);
    return {};
}

}  // namespace intaglio::plan

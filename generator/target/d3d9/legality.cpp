// check(): the families of rules, one after the other; and the budgets, which are counts against
// limits.
#include "generator/target/d3d9/legality.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "generator/target/d3d9/legality_rules.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace rules {
namespace {

// Rule codes of headroom()'s rows.
constexpr std::pair<std::string_view, std::string_view> budget_rules[] = {
    {"arithmetic slots", "arithmetic-slots"},
    {"texture slots", "texture-slots"},
    {"slots in total", "total-slots"},
    {"temporary registers", "temps"},
    {"float constants", "constants"},
    {"integer constants", "integer-constants"},
    {"boolean constants", "boolean-constants"},
    {"samplers", "samplers"},
    {"input registers", "inputs"},
    {"texture coordinates", "texcoords"},
    {"texture coordinate outputs", "texcoord-outputs"},
    {"colour outputs", "colour-outputs"},
    {"output registers", "outputs"},
};

std::string_view rule_of(std::string_view resource) {
    for (const auto& [name, rule] : budget_rules)
        if (name == resource) return rule;
    return {};
}

// Registers of which there is one, or which no limit of the profile covers.
bool numbered_wrong(File file, int index) {
    switch (file) {
        case File::Address:
        case File::LoopCounter:
        case File::Predicate:
        case File::DepthOut:
        case File::PositionOut:
        case File::FogOut:
        case File::PointSizeOut:
        case File::Position:
        case File::Face: return index != 0;
        case File::Label: return index < 0 || index >= 2048;
        default: return index < 0;
    }
}

bool has_wrong_number(const Shader& shader) {
    for (const Instruction& it : shader.instructions) {
        if (it.destination && numbered_wrong(it.destination->file, it.destination->index))
            return true;
        for (const Source& source : it.sources)
            if (!source.relative && numbered_wrong(source.file, source.index)) return true;
    }
    for (const Declaration& declaration : shader.declarations)
        if (numbered_wrong(declaration.target.file, declaration.target.index)) return true;
    return false;
}

}  // namespace

void budgets(const Check& check) {
    if (has_wrong_number(check.shader))
        check.refuse("register-number", "a register has a number that no register of its kind has");
    for (const Headroom& row : headroom(count(check.shader), check.limits)) {
        const std::string_view rule = rule_of(row.resource);
        if (row.left() < 0 && !rule.empty())
            check.refuse(std::string(rule),
                         fmt::format("{} {}, {} allows {}: {} too many", row.used, row.resource,
                                     check.limits.name, row.limit, -row.left()));
    }
    const std::vector<int> levels = dependent_levels(check.shader);
    for (std::size_t i = 0; i < levels.size(); ++i)
        if (levels[i] > check.limits.dependent_level)
            check.refuse(
                "dependent-reads",
                fmt::format(
                    "texture reads depend on each other {} deep here; {} allows {}, so {} too many",
                    levels[i], check.limits.name, check.limits.dependent_level,
                    levels[i] - check.limits.dependent_level),
                static_cast<int>(i));
}

}  // namespace rules

std::vector<Violation> check(const Shader& shader, const Limits& limits) {
    std::vector<Violation> violations;
    const rules::Check all{shader, limits, violations};
    rules::budgets(all);
    rules::declarations(all);
    rules::operands(all);
    rules::outputs(all);
    rules::flow(all);
    rules::lanes(all);
    std::stable_sort(
        violations.begin(), violations.end(),
        [](const Violation& a, const Violation& b) { return a.instruction < b.instruction; });
    return violations;
}

std::vector<Violation> check(const Shader& shader) {
    return check(shader, limits_of(shader.profile));
}

}  // namespace intaglio::d3d9

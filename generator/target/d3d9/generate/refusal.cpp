// Why a shader does not fit its profile, in a sentence.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "generator/target/d3d9/generate/candidate.h"
#include "generator/target/d3d9/ops.h"
#include "generator/target/d3d9/resources.h"

namespace intaglio::d3d9 {
namespace {

std::string place_of(const Shader& shader, const ir::Origin& origin) {
    if (origin.file < 0 || origin.file >= static_cast<int>(shader.files.size())) return {};
    return fmt::format("{}:{}", shader.files[static_cast<std::size_t>(origin.file)], origin.line);
}

// "march takes 61 of them, most at templates/search/steep_parallax.cpp:43"
std::string spender(const Shader& shader, std::string_view when) {
    std::map<int, int> steps;
    for (const Instruction& instruction : shader.instructions)
        steps[instruction.origin.step] += slots_of(instruction).total();
    const auto most =
        std::max_element(steps.begin(), steps.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == steps.end()) return {};
    std::map<std::string, int> lines;
    for (const Instruction& instruction : shader.instructions)
        if (instruction.origin.step == most->first)
            lines[place_of(shader, instruction.origin)] += slots_of(instruction).total();
    const auto line =
        std::max_element(lines.begin(), lines.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    const bool named = most->first >= 0 && most->first < static_cast<int>(shader.steps.size());
    return fmt::format(
        "{} takes {} of its {} slots{}, {} of them at {}",
        named ? "the step '" + shader.steps[static_cast<std::size_t>(most->first)].name + "'"
              : "work outside the steps",
        most->second, slots_of(shader).total(), when, line->second,
        line->first.empty() ? "an unknown line" : line->first);
}

std::string limit_exceeded(const Candidate& candidate) {
    const Limits& limits = limits_of(candidate.shader.profile);
    const Slots slots = candidate.at_least ? *candidate.at_least : slots_of(candidate.shader);
    const std::string_view least = candidate.at_least ? "at least " : "";
    std::vector<std::string> parts;
    const auto over = [&](std::string_view what, int used, int limit) {
        if (used > limit)
            parts.push_back(fmt::format("needs {}{} {}, {} more than the {} it has", least, used,
                                        what, used - limit, limit));
    };
    over("arithmetic slots", slots.arithmetic, limits.arithmetic_slots);
    over("texture slots", slots.texture, limits.texture_slots);
    if (parts.empty()) over("slots", slots.total(), limits.total_slots);
    if (parts.empty() && candidate.failure == AllocationFailure::Temps)
        parts.push_back(fmt::format("needs more than its {} temporary registers", limits.temps));
    if (parts.empty() && candidate.failure == AllocationFailure::DependentReads)
        parts.push_back(
            fmt::format("needs texture reads that depend on each other more than {} deep",
                        limits.dependent_level));
    if (parts.empty() && !candidate.violations.empty())
        return "refuses it: " + candidate.violations[0].message;
    return fmt::format("{}", fmt::join(parts, " and "));
}

std::string_view advice(Profile profile) {
    switch (profile) {
        case Profile::ps_2_0:
            return "try fewer taps or steps, ps_2_b or ps_2_a, or several passes: "
                   "--split shading, --split sections=2,shading";
        case Profile::ps_2_a:
        case Profile::ps_2_b:
            return "try fewer taps or steps, ps_3_0, or several passes: --split shading, "
                   "--split sections=2,shading";
        case Profile::ps_3_0:
            return "try fewer taps or steps, a target with loops, or several passes: "
                   "--split shading, --split sections=2,shading";
        case Profile::vs_2_0: return "compute less per vertex, or use vs_3_0";
        case Profile::vs_3_0: return "compute less per vertex";
    }
    return {};
}

}  // namespace

Diagnostic refuse(const std::string& name, const Candidate& candidate) {
    const Profile profile = candidate.shader.profile;
    std::string when;
    if (candidate.iterations > 0)
        when = fmt::format(
            " before packing, in at most {} iterations of a loop (what it needs at "
            "least was counted there)",
            candidate.iterations);
    else if (candidate.at_least)
        when = " before packing (what it needs at least was counted there)";
    return input_error("d3d9-limit", fmt::format("{} {} for {}: {}; {}", name_of(profile),
                                                 limit_exceeded(candidate), name,
                                                 spender(candidate.shader, when), advice(profile)));
}

}  // namespace intaglio::d3d9

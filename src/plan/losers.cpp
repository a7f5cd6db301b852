// What a choice says of rungs that lost on their ladder.
#include <fmt/format.h>

#include "src/plan/surface_work.h"

namespace intaglio::plan {

std::string over_budget(const scene::Budget& budget, const std::map<std::string, double>& costs) {
    for (const auto& [metric, limit] : budget) {
        const auto found = costs.find(metric);
        if (found == costs.end()) return fmt::format("{} is unknown", metric);
        if (found->second > limit)
            return fmt::format("{} is {:.4g}, of at most {:.4g}", metric, found->second, limit);
    }
    return {};
}

std::map<std::string, double> foreseen_errors(const Tried& search, const Tried* shadow) {
    std::map<std::string, double> errors = search.trial->errors;
    if (!shadow) return errors;
    errors.erase("shadow_wrong");
    if (const auto own = shadow->trial->errors.find("shadow_wrong");
        own != shadow->trial->errors.end())
        errors.insert(*own);
    return errors;
}

// Rungs that never came to a pair of their own.
void add_losers_of_ladders(const SurfaceWork& work, const scene::Tolerance& tolerance,
                           const std::set<const Tried*>& paired, Choice& choice) {
    const auto add = [&](const std::vector<Tried>& ladder, const char* kind, bool hits_alone) {
        std::map<std::pair<std::string, std::string>, int> skipped;
        for (const Tried& one : ladder) {
            if (!one.trial) {
                ++skipped[{one.rung.technique, one.skipped}];
                continue;
            }
            const std::string why = one.trial->refusal.empty()
                                        ? why_wrong(tolerance, *one.trial, hits_alone)
                                        : one.trial->refusal;
            if (why.empty() || paired.contains(&one)) continue;
            Candidate candidate;
            candidate.text = kind + one.rung.text();
            candidate.fate = one.trial->refusal.empty() ? Fate::Wrong : Fate::Refused;
            candidate.why = why;
            candidate.operations = one.trial->operations;
            candidate.reads = one.trial->reads;
            candidate.cost = work.cost(*one.trial);
            candidate.errors = one.trial->errors;
            choice.candidates.push_back(std::move(candidate));
        }
        for (const auto& [what, count] : skipped) {
            Candidate candidate;
            candidate.text = fmt::format("{}{}, {} more setting{}", kind, what.first, count,
                                         count == 1 ? "" : "s");
            candidate.why = what.second;
            choice.candidates.push_back(std::move(candidate));
        }
    };
    add(work.searches, "", true);
    add(work.shadows, "shadow ", false);
}

}  // namespace intaglio::plan

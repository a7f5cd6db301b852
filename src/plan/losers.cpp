// What a choice says of rungs that lost on their ladder.
#include <fmt/format.h>

#include "src/plan/surface_work.h"

namespace intaglio::plan {

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

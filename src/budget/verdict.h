// Observations against budgets and a baseline: what got worse, what got better, what is over.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/budget/budgets.h"
#include "src/budget/observation.h"

namespace intaglio::budget {

// One metric of one variant that is limited or changed.
struct Finding {
    enum class Kind {
        Fine,      // within its limits
        Over,      // above max, or grown by more than max_delta
        Waived,    // over, and forgiven
        Unknown,   // limited and not known, which is no pass: refused, no baseline, no number
        Vanished,  // in the baseline and no longer in the scene: no pass either
    } kind = Kind::Fine;
    std::string surface, target, settings;
    std::string metric;                   // empty: the variant as a whole
    std::optional<double> before, after;  // in the baseline, and now
    std::string sentence;                 // of what is not fine: what is wrong and by how much
    std::string where;                    // the line of C++ that spends more, where it is known
    std::string command;                  // shows the worst case, where it is known
    int budget_line = 0;                  // which line of the budget file says so; 0: none

    std::string name() const;
    bool fails() const {
        return kind == Kind::Over || kind == Kind::Unknown || kind == Kind::Vanished;
    }
    // More than 1: worse than before.  Nothing where either side is unknown or both are equal.
    std::optional<double> growth() const;
};

struct Verdict {
    std::string budget_file;
    std::vector<Finding> findings;   // by variant, metric in the table's order
    std::vector<std::string> notes;  // waivers that are over or forgive nothing; what got better
    bool passes() const;
};

// `today`: "2026-12-31"; a waiver counts up to its last day.  `baseline`: empty where there is
// none.
Verdict judge(const Budgets& budgets, const std::vector<Observation>& now,
              const std::vector<Observation>& baseline, const std::string& today);

// What differs between two lists of observations, in the same form; nothing fails.
Verdict difference(const std::vector<Observation>& before, const std::vector<Observation>& after);

}  // namespace intaglio::budget

// A plan for people.
#include <algorithm>

#include <fmt/format.h>

#include "src/measure/named_metric.h"
#include "src/plan/plan.h"

namespace intaglio::plan {
namespace {

constexpr std::size_t few = 6;  // losers that are shown of each fate

std::string error_text(const Candidate& candidate) {
    std::string text;
    for (const char* metric : {"p95", "missed", "shadow_wrong"}) {
        const auto found = candidate.errors.find(metric);
        if (found == candidate.errors.end()) continue;
        const std::string_view unit = measure::find_metric(metric)->unit;
        text += fmt::format("{}{} {:.3g}{}", text.empty() ? "" : ", ", metric, found->second,
                            unit.starts_with('%') ? " %" : "");
    }
    return text;
}

std::string cost_text(const Candidate& candidate) { return fmt::format("{:6.1f}", candidate.cost); }

std::string line_of(const Candidate& candidate) {
    return fmt::format("    {} {:<9} {:<58} {}\n", cost_text(candidate),
                       candidate.judged ? "" : "foreseen", candidate.text, error_text(candidate));
}

// A refusal goes on to say who spends what; `intaglio explain` does so too.
std::string in_short(const std::string& why) {
    const std::size_t more = why.find(": the step '");
    return more == std::string::npos ? why : why.substr(0, more);
}

bool is_beaten(const Candidate& candidate, const Candidate& by) {
    const auto of = [](const Candidate& each, const char* metric) {
        const auto found = each.errors.find(metric);
        return found == each.errors.end() ? 0.0 : found->second;
    };
    bool equal = by.cost == candidate.cost;
    if (by.cost > candidate.cost) return false;
    for (const char* metric : {"p95", "missed", "shadow_wrong"}) {
        if (of(by, metric) > of(candidate, metric)) return false;
        equal = equal && of(by, metric) == of(candidate, metric);
    }
    return !equal;
}

// Nothing costs as little and errs as little.
std::vector<const Candidate*> front_of(const Choice& choice) {
    std::vector<const Candidate*> front;
    for (const Candidate& one : choice.candidates) {
        if (!one.judged || one.fate == Fate::Refused || one.errors.empty()) continue;
        const bool beaten = std::any_of(choice.candidates.begin(), choice.candidates.end(),
                                        [&](const Candidate& other) {
                                            return other.judged && other.fate != Fate::Refused &&
                                                   !other.errors.empty() && is_beaten(one, other);
                                        });
        if (!beaten) front.push_back(&one);
    }
    return front;
}

std::string losers(const Choice& choice, Fate fate, const Shown& shown) {
    std::string text;
    std::size_t count = 0, left = 0;
    for (const Candidate& candidate : choice.candidates) {
        if (candidate.fate != fate) continue;
        if (!shown.all && ++count > few) {
            ++left;
            continue;
        }
        text += fmt::format("    {} {:<9} {}: {}\n",
                            candidate.cost > 0 ? cost_text(candidate) : "      ",
                            candidate.judged || candidate.cost == 0 ? "" : "foreseen",
                            candidate.text, shown.all ? candidate.why : in_short(candidate.why));
    }
    if (left > 0) text += fmt::format("    and {} more (--all)\n", left);
    return text.empty() ? text : fmt::format("  {}:\n{}", name_of(fate), text);
}

std::string dropped_text(const Choice& choice) {
    if (choice.dropped.empty()) return {};
    std::string text = "  not emitted:\n";
    for (const Dropped& dropped : choice.dropped) {
        text += fmt::format("    {} ({}): {}", dropped.what, name_of(dropped.by), dropped.why);
        if (dropped.cost_before && dropped.cost_after)
            text += fmt::format("; cost {:.4g} instead of {:.4g}", *dropped.cost_after,
                                *dropped.cost_before);
        if (dropped.error > 0) text += fmt::format(", error {:.3g} texels", dropped.error);
        text += '\n';
    }
    return text;
}

std::string choice_text(const Choice& choice, const Shown& shown) {
    std::string text = fmt::format("{} on {}\n", choice.surface, choice.target);
    if (choice.chosen) {
        const Candidate& chosen = choice.candidates[*choice.chosen];
        text += fmt::format(
            "  chosen: {}\n    cost {:.4g}: {:.4g} operations and {:.4g} reads a "
            "pixel\n    error: {}\n",
            chosen.text, chosen.cost, chosen.operations, chosen.reads, error_text(chosen));
    } else {
        text += "  nothing is right enough and fits\n";
        const auto nearest = [&](const char* what, const std::optional<std::size_t>& index) {
            if (!index) {
                text += fmt::format("  {}: there is none\n", what);
                return;
            }
            const Candidate& one = choice.candidates[*index];
            text += fmt::format("  {}: {}\n    cost {:.4g}, {}\n    {}\n", what, one.text, one.cost,
                                error_text(one), in_short(one.why));
        };
        nearest("the best that fits", choice.best_that_fits);
        nearest("the cheapest that is right", choice.cheapest_right);
    }
    text += dropped_text(choice);
    if (const auto front = front_of(choice); front.size() > 1) {
        text += "  the front, of what was judged:\n";
        for (const Candidate* candidate : front) text += line_of(*candidate);
    }
    for (const Fate fate :
         {Fate::Dearer, Fate::OverBudget, Fate::Wrong, Fate::Refused, Fate::NotTried})
        text += losers(choice, fate, shown);
    return text;
}

}  // namespace

std::string to_people(const Plan& plan, const Shown& shown) {
    std::string text;
    for (const Choice& choice : plan.choices) {
        if (!text.empty()) text += '\n';
        text += choice_text(choice, shown);
    }
    return text;
}

}  // namespace intaglio::plan

// Ladders from knobs.
#include "src/plan/candidates.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace intaglio::plan {
namespace {

constexpr double many =
    16;  // a knob that goes so far counts something that is done again and again

int most_of(const dsl::KnobBase& knob, const LadderLimits& limits) {
    int most = limits.any;
    for (const auto& [name, bound] : limits.by_knob)
        if (name == knob.name()) most = bound;
    return static_cast<int>(std::min<double>(most, knob.most()));
}

// Powers of two and, with `halves`, one and a half times them; the ends of the range are rungs.
std::vector<int> steps_of(const dsl::KnobBase& knob, const LadderLimits& limits, bool halves) {
    const int least = static_cast<int>(knob.least()), most = most_of(knob, limits);
    std::vector<int> steps;
    if (least == 0) steps.push_back(0);
    for (int power = 1; power <= most; power *= 2) {
        for (const int step : {power, halves && power > 1 ? power + power / 2 : power})
            if (step >= least && step <= most && (steps.empty() || steps.back() < step))
                steps.push_back(step);
    }
    if (steps.empty() || steps.back() < most) steps.push_back(std::max(most, least));
    return steps;
}

bool is_pinned(const Knobs& pinned, const std::string& knob) {
    return std::any_of(pinned.begin(), pinned.end(),
                       [&](const auto& pair) { return pair.first == knob; });
}

template <typename Kind>
std::vector<Rung> ladder(const std::vector<dsl::Entry<Kind>>& table, const std::string& name,
                         const Knobs& pinned, const LadderLimits& limits) {
    const auto row = std::find_if(table.begin(), table.end(),
                                  [&](const auto& entry) { return entry.name == name; });
    if (row == table.end()) return {};
    const std::unique_ptr<Kind> technique = row->make();
    std::vector<dsl::KnobBase*> counting;
    for (dsl::KnobBase* knob : technique->knobs())
        if (counts_steps(*knob) && !is_pinned(pinned, knob->name())) counting.push_back(knob);
    std::vector<Rung> all = {{name, {}}};
    for (dsl::KnobBase* knob : counting) {
        std::vector<Rung> longer;
        for (const Rung& before : all) {
            int level = before.level;
            for (const int step : steps_of(*knob, limits, counting.size() == 1)) {
                longer.push_back(before);
                longer.back().knobs.emplace_back(knob->name(), fmt::format("{}", step));
                longer.back().steps.push_back(step);
                longer.back().level = level++;
            }
        }
        all = std::move(longer);
    }
    std::vector<Rung> rungs;
    for (const Rung& rung : all) {
        bool possible = true;
        for (const auto& [knob, value] : pinned)
            for (dsl::KnobBase* own : technique->knobs())
                if (own->name() == knob) possible = possible && own->set(value).ok();
        for (const auto& [knob, value] : rung.knobs)
            for (dsl::KnobBase* own : counting)
                if (own->name() == knob) possible = possible && own->set(value).ok();
        if (possible && technique->check().ok()) rungs.push_back(rung);
    }
    return rungs;
}

}  // namespace

bool counts_steps(const dsl::KnobBase& knob) { return knob.whole() && knob.most() >= many; }

bool Rung::no_less_than(const Rung& other) const {
    if (technique != other.technique || steps.size() != other.steps.size()) return false;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (steps[i] < other.steps[i]) return false;
    return true;
}

std::string Rung::text() const {
    std::string text = technique;
    for (const auto& [knob, value] : knobs) text += fmt::format(" {}={}", knob, value);
    return text;
}

std::vector<Rung> search_ladder(const dsl::Catalogue& catalogue, const std::string& search,
                                const Knobs& pinned, const LadderLimits& limits) {
    return ladder(catalogue.searches, search, pinned, limits);
}

std::vector<Rung> shadow_ladder(const dsl::Catalogue& catalogue, const std::string& shadow,
                                const Knobs& pinned, const LadderLimits& limits) {
    return ladder(catalogue.shadows, shadow, pinned, limits);
}

}  // namespace intaglio::plan

// What there is to choose from: every search and shadow of the library with a ladder of settings,
// made from the knobs themselves.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "generator/dsl/catalogue.h"

namespace intaglio::plan {

using Knobs = std::vector<std::pair<std::string, std::string>>;

// One technique with its knobs set: one rung of its ladder.
struct Rung {
    std::string technique;     // "relief"
    Knobs knobs;               // {{"linear_steps", "12"}, {"binary_steps", "4"}}
    std::vector<int> steps{};  // the same as numbers
    int level = 0;             // how many rungs below it, over all knobs
    // Whether it does no less than another of its technique, knob by knob.
    bool no_less_than(const Rung& other) const;
    // "relief linear_steps=12 binary_steps=4"
    std::string text() const;
};

// A knob that counts steps: whole, and able to be many.
bool counts_steps(const dsl::KnobBase& knob);

// 1, 2, 3, 4, 6, 8, 12, 16, ... within the knob's range, no greater than `most`: each at least a
// third more than the one before.  A technique with several such knobs has every combination of
// theirs, in powers of two, that its own check() lets through.
//
// `pinned`: knobs that the scene sets, which have no ladder.  `most_steps`: what a ladder ends
// with where the technique's knob goes further; by knob, where a bound is known; `any` else.
struct LadderLimits {
    int any = 256;
    std::vector<std::pair<std::string, int>> by_knob;
};
std::vector<Rung> search_ladder(const dsl::Catalogue& catalogue, const std::string& search,
                                const Knobs& pinned, const LadderLimits& limits);
std::vector<Rung> shadow_ladder(const dsl::Catalogue& catalogue, const std::string& shadow,
                                const Knobs& pinned, const LadderLimits& limits);

}  // namespace intaglio::plan

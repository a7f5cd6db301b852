// A budget file says how much variants may cost and how wrong they may be.
//
//     scene = "scene.toml"                 # what is measured, from this file's folder
//     baseline = "baseline.jsonl"          # what was measured last, for max_delta; may be missing
//     [limits]                             # of every variant that has the metric
//     missed = { max = 5, max_delta = 0.5 }
//     [target.ps_2_0]                      # of one target ...
//     arithmetic = { max = 64, max_delta = 0 }
//     [surface.steep_parallax]             # ... of one surface, as the scene writes it ...
//     p95 = { max = 3 }
//     [[variant]]                          # ... of one variant; what is not named may be anything
//     surface = "parallax_occlusion"
//     target = "ps_2_0"
//     settings = "taps=8"
//     arithmetic = { max = 40 }
//     [[waiver]]                           # what is over and forgiven for a while
//     surface = "fur"                      # target, settings, metric: as above; at least one
//     metric = "arithmetic"
//     reason = "the packed march lands next week"
//     until = 2026-12-31                   # the last day that it counts
//
// The most particular limit counts: variant over surface over target over [limits]; among variants
// the last one.  `max` is on the value, `max_delta` on its growth over the baseline.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/scene/document.h"

namespace intaglio::budget {

struct Bound {
    std::optional<double> max, max_delta;
    int line = 0;  // in the budget file, of what was found last
};

// Which variants; empty: any.
struct Selector {
    std::string surface, target, settings;
    bool matches(const std::string& of_surface, const std::string& on_target,
                 const std::string& with_settings) const;
};

struct Rule {
    Selector selector;
    std::string metric;
    Bound bound;
};

struct Waiver {
    Selector selector;
    std::string metric;  // empty: any
    std::string reason;
    std::string until;  // "2026-12-31"
    int line = 0;
};

struct Budgets {
    std::string file;
    std::filesystem::path scene;
    std::optional<std::filesystem::path> baseline;
    std::vector<Rule> rules;  // the least particular first
    std::vector<Waiver> waivers;

    // What counts for a metric of a variant: nothing where nothing limits it.
    std::optional<Bound> bound(const std::string& surface, const std::string& target,
                               const std::string& settings, std::string_view metric) const;
};

// Codes: those of maps::read_file; "budget-syntax", "budget-unknown-key" (with the nearest),
// "budget-type", "budget-range", "budget-missing", and "budget-not-applicable" (slots of a target
// without slots), each with line and column.
Result<Budgets> read_budgets(const std::filesystem::path& path);

}  // namespace intaglio::budget

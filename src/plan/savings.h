// What a plan saves: each of its variants beside the same surface with everything on, as one would
// write it for any scene.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/plan/plan.h"

namespace intaglio::plan {

// The same search at the same knobs, per pixel, under every light of the scene, each of which
// throws a shadow (by march, where the order has none), with every uniform live, nothing assumed
// and loops as the technique schedules them.  `lights`: how many the scene has.
VariantRequest everything_on(const Order& order, int lights);

struct Saving {
    struct Side {
        double cost = 0;   // arithmetic and texture slots; of a language SPIR-V instructions
        double bytes = 0;  // of the pixel stage: bytecode, or SPIR-V after optimisation
        double p95 = 0, missed = 0;  // texels, per cent; the worst view
    };
    std::string surface, target;
    Side planned;
    std::optional<Side> whole;         // empty: its target refuses it
    std::string refusal;               // then the sentence
    std::optional<double> time_ratio;  // planned by whole, the mean of the views' medians
};

struct SavingOptions {
    int size = 127;   // pixels a side, a prime as in scenes
    int rounds = 15;  // of interleaved timing; 0: no times
    std::function<void(const std::string& what, int done, int all)> progress = {};
};

struct Savings {
    std::string device;  // whose times these are
    std::vector<Saving> rows;
};

// Every order of the plan, in its order, drawn and measured.  Errors: those of measure::measure.
Result<Savings> measure_savings(const dsl::Catalogue& catalogue, const scene::Scene& scene,
                                const Plan& plan, const SavingOptions& options);

// As a table of Markdown.
std::string to_markdown(const Savings& savings);

}  // namespace intaglio::plan

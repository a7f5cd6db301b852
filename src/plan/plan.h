// From a scene to orders: for every surface and target the cheapest variant that is right enough,
// with what it was chosen from, why each of the others lost, and what is not emitted at all.
// docs/plan.md says how, with the formula of the cost.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "generator/dsl/catalogue.h"
#include "src/plan/order.h"
#include "src/scene/scene.h"

namespace intaglio::plan {

enum class Fate {
    Chosen,
    Dearer,      // right, and costs more
    Wrong,       // more wrong than the scene tolerates
    OverBudget,  // right, and over a limit of the scene
    Refused,     // the target cannot have it
    NotTried,    // cannot win, for the reason that `why` gives
};
// "chosen", "dearer", "wrong", "over budget", "refused", "not tried".
std::string_view name_of(Fate fate);

struct Candidate {
    VariantRequest request;
    std::string text;  // "relief linear_steps=12 binary_steps=4, shadow march shadow_max_steps=8"
    Fate fate = Fate::NotTried;
    std::string why;  // one sentence without its full stop
    // Operations and reads carried out for a pixel, and their cost; predicted where not judged.
    double cost = 0, operations = 0, reads = 0;
    bool judged = false;
    std::map<std::string, double> costs, errors;  // by the names of docs/budgets.md
};

// Something that is not emitted, or not offered to begin with.
struct Dropped {
    std::string what;  // "light lamp", "shadow of sun", "uniform scale"
    enum class By {
        Bound,     // proven for all rays
        Measured,  // on the surface's rays
        Fixed,     // the scene says so
    } by = By::Fixed;
    std::string why;
    // Of the chosen variant, with it and without: empty where nothing was chosen, or nothing was
    // there to be left out.
    std::optional<double> cost_before, cost_after;
    double error = 0;  // what leaving it out adds to the error, texels; 0: nothing, to the bit
};
// "bound", "measured", "fixed".
std::string_view name_of(Dropped::By by);

struct Choice {
    std::string surface, target;
    std::vector<Candidate> candidates;  // by cost; those never tried behind the others
    std::vector<Dropped> dropped;
    std::optional<std::size_t> chosen;  // of the candidates
    // Where nothing was chosen: the most accurate that its target and budget hold, and the cheapest
    // that is accurate enough.
    std::optional<std::size_t> best_that_fits, cheapest_right;
    std::optional<Order> order;  // of the chosen one
};

struct Plan {
    std::string scene;
    std::vector<Choice> choices;  // by surface and target in the order of the scene
    int tried = 0, kept = 0;      // variants that were run, and that were known from before

    bool is_satisfied() const;
};

struct PlanOptions {
    int workers = 1;
    std::filesystem::path cache;  // folder of what was measured; empty: nothing is kept
    bool exhaustive = false;      // tries what cannot win as well
    int most_steps = 256;         // at which ladders of knobs that count steps end
    std::string surface, target;  // of the scene; empty: all
    // Told from one thread at a time what is worked on.  May be empty.
    std::function<void(const std::string& what, int done, int all)> progress = {};
};

// The same plan for any number of workers.  A surface that cannot be satisfied is no error: its
// choice has no order.  Errors: "unknown-surface", "unknown-target" for the options' names,
// "unknown-technique", "unknown-knob" of what the scene pins; our own, and those of the maps.
Result<Plan> plan_scene(const dsl::Catalogue& catalogue, const scene::Scene& scene,
                        const PlanOptions& options);

// The code of the error that is no fault: a surface has no order.  Exit code 1.
inline constexpr std::string_view unsatisfied = "plan-unsatisfied";

// $INTAGLIO_CACHE, else $XDG_CACHE_HOME/intaglio, else ~/.cache/intaglio; with `measured` below it.
std::filesystem::path default_cache();

// JSON; the schema is docs/plan.md's.
std::string to_text(const Plan& plan);
struct Shown {
    bool all = false;  // every candidate
};
// For people.
std::string to_people(const Plan& plan, const Shown& shown = {});

}  // namespace intaglio::plan

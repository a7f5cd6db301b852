// One surface of a scene on its way to its choices: what is asked of every variant of it, and what
// was tried.  Internal to src/plan.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "src/measure/relief_facts.h"
#include "src/plan/candidates.h"
#include "src/plan/kept.h"
#include "src/plan/plan.h"
#include "src/plan/rays.h"

namespace intaglio::plan {

// What all variants of a surface have in common.
struct Common {
    std::string search, shadow;  // pinned; empty: to be chosen
    std::string rest;            // ",normal=map,shading=phong,output=colour"
    Knobs knobs;                 // pinned, or asked for by a feature
    std::map<std::string, ir::LoopForm> loop_forms;
    passes::Known known;                 // more than any one variant has names for
    std::vector<std::size_t> lights;     // of the surface, by number in the shader
    std::vector<std::size_t> shadowing;  // the first of them, which can throw shadows
};

// A rung, tried or not.
struct Tried {
    Rung rung;
    std::optional<Trial> trial;  // Ask::Errors
    std::string skipped;         // why not tried
    bool right = false;
    bool above = false;               // skipped for what a rung below it is
    std::optional<Trial> best_lit{};  // of a right search: with the most accurate shadow
};

// A schedule beside the technique's own.
struct Schedule {
    bool unrolled = false;  // every loop written out
    bool per_vertex = false;
};

struct SurfaceWork {
    const dsl::Catalogue& catalogue;
    const scene::SceneSurface& surface;
    double read_weight;
    const PlanOptions& options;
    Kept& kept;
    Site& site;
    Common common{};
    measure::ReliefFacts facts{};
    measure::Directions views{};
    scene::Tolerance strictest{}, loosest{};  // of all its targets
    Rays hit_rays{};                          // without a light
    Rays shadow_rays{};                       // with those that can shadow
    std::vector<Tried> searches{}, shadows{};
    std::size_t base = 0;  // of searches: the most accurate, whose hits the shadows were tried on
    Trial shading{};       // what all that is neither search nor shadow costs
    std::vector<Dropped> dropped{};
    mutable measure::SharedCache<Result<Trial>> sizes{1 << 16};  // of written_out()

    bool wants_shadow() const { return !common.shadowing.empty(); }
    const Rays& rays() const { return wants_shadow() ? shadow_rays : hit_rays; }

    // Sets knobs that the composition does not have aside.  `shadow` null: none.
    VariantRequest request(const std::string& target, const Rung& search, const Rung* shadow,
                           const Schedule& schedule = {}) const;
    // What finds the hits and whether one light reaches them, with all that is known of it or as
    // for any scene: the same pixels, and the second is tried once for all.
    static VariantRequest one_light(VariantRequest request);
    static VariantRequest unpruned(VariantRequest request);
    // The same with other things known, as far as the variant has names for them.
    VariantRequest knowing(VariantRequest request, const passes::Known& known) const;
    // Operations and reads of the shaded surface where its target has it.
    Result<Trial> price(const VariantRequest& request) const;
    // Ask::Size of both, recorded once for all pairs and targets that ask.
    Result<Trial> written_out(const Rung& search, const Rung* shadow) const;
    // Whose trial stands for this one: glsl_450's wherever the techniques record the same for it.
    std::string like(const VariantRequest& request, Ask ask) const;
    // What the passes make of it, as text.
    std::string optimized(const VariantRequest& request) const;
    double cost(const Trial& trial) const { return trial.cost(read_weight); }
};

// What the surface pins: "unknown-knob", "unknown-technique", "unknown-uniform", "unknown-loop",
// each with the nearest; "scene-conflict" where it says two things at once.
Status check_pinned(const SurfaceWork& work);

// Fills `common` and `dropped` with what the scene alone decides.  Errors: unknown names.
Status derive(SurfaceWork& work);

// Tries searches, then shadows on the hits of the cheapest right search; `exhaustive` or what could
// still win.
Status climb_ladders(SurfaceWork& work);

// How much too wrong a trial is: the greatest share of a tolerance, 1 at most where it is right.
// `hits_alone`: whatever the lights do.
double wrongness(const scene::Tolerance& tolerance, const Trial& trial, bool hits_alone);
// "p95 is 3.2 texels, of at most 1", of the metric that is the most over.
std::string why_wrong(const scene::Tolerance& tolerance, const Trial& trial, bool hits_alone);

// Which cost is over its limit, and by how much; empty: none is.
std::string over_budget(const scene::Budget& budget, const std::map<std::string, double>& costs);

// Of a pair that was not measured: the search's hits, and the shadow's visibility on those of
// another search.  `shadow` null: none.
std::map<std::string, double> foreseen_errors(const Tried& search, const Tried* shadow);

// Of a target without loops: why what Ask::Size counted cannot fit; empty where it may.
std::string why_too_long(const Target& target, const Trial& written_out);

// Rungs that never came to a pair of their own, behind the candidates.
void add_losers_of_ladders(const SurfaceWork& work, const scene::Tolerance& tolerance,
                           const std::set<const Tried*>& paired, Choice& choice);

Result<Choice> choose(const SurfaceWork& work, const std::string& target);

}  // namespace intaglio::plan

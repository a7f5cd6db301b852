// Ladders from their lowest rungs upwards: where a rung is right, no higher one of its technique
// can be chosen, since it does the same and more.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "src/measure/named_metric.h"
#include "src/plan/parallel.h"
#include "src/plan/surface_work.h"

namespace intaglio::plan {
namespace {

// Above the cheapest right one by so much a ladder is not climbed on: whatever the target, its
// slots and operations never turn a ratio like this around.
constexpr double hopeless = 4;
// More texels of baked maps than this for each of the height map's are not offered unless pinned:
// a volume of a 256 x 256 map over this has more than 2.6 million.
constexpr double most_baked_texels = 40;

bool of_narrow(const std::string& metric) {
    return metric.ends_with("_fp24") || metric.ends_with("_fp16");
}

// Tries what is left of one level.
template <typename Request>
Status try_level(SurfaceWork& work, std::vector<Tried>& all, const std::vector<std::size_t>& which,
                 const Rays& rays, const Request& request) {
    std::vector<std::optional<Diagnostic>> errors(which.size());
    in_parallel(which.size(), work.options.workers, [&](std::size_t i) {
        Tried& one = all[which[i]];
        Result<Trial> trial = work.kept.run(work.site, request(one.rung), rays, Ask::Errors);
        if (trial)
            one.trial = std::move(*trial);
        else
            errors[i] = trial.error();
    });
    for (const auto& error : errors)
        if (error) return *error;
    return Done{};
}

// What is certain before trying.
void skip_needless(const SurfaceWork& work, std::vector<Tried>& all, Tried& one, double cheapest) {
    for (const Tried& lower : all) {
        if (!lower.trial || !one.rung.no_less_than(lower.rung)) continue;
        if (lower.right) {
            one.skipped = fmt::format("{} does less and is right", lower.rung.text());
            return;
        }
        const double cost = work.cost(*lower.trial);
        if (cheapest > 0 && cost > hopeless * cheapest) {
            one.skipped = fmt::format(
                "{} does less and costs {:.0f} already, {:.0f} times what "
                "the cheapest right one does",
                lower.rung.text(), cost, cost / cheapest);
            return;
        }
    }
}

template <typename Request, typename Right>
Status climb(SurfaceWork& work, std::vector<Tried>& all, const Rays& rays, const Request& request,
             const Right& right) {
    int levels = 0;
    for (const Tried& one : all) levels = std::max(levels, one.rung.level + 1);
    for (int level = 0; level < levels; ++level) {
        double cheapest = 0;
        for (const Tried& one : all)
            if (one.trial && one.right && (cheapest == 0 || work.cost(*one.trial) < cheapest))
                cheapest = work.cost(*one.trial);
        std::vector<std::size_t> which;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (all[i].rung.level != level || !all[i].skipped.empty()) continue;
            if (!work.options.exhaustive) skip_needless(work, all, all[i], cheapest);
            if (all[i].skipped.empty()) which.push_back(i);
        }
        if (Status status = try_level(work, all, which, rays, request); !status) return status;
        for (const std::size_t i : which)
            all[i].right = all[i].trial->refusal.empty() && right(*all[i].trial);
    }
    return Done{};
}

// By this metric, of those that were tried; the cheaper of two that are as good.
std::size_t most_accurate(const SurfaceWork& work, const std::vector<Tried>& all,
                          const std::string& metric) {
    std::size_t best = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].trial || !all[i].trial->errors.contains(metric)) continue;
        const double value = all[i].trial->errors.at(metric);
        const bool cheaper = value == least && all[best].trial &&
                             work.cost(*all[i].trial) < work.cost(*all[best].trial);
        if (value < least || cheaper) {
            best = i;
            least = value;
        }
    }
    return best;
}

template <typename Entries>
std::vector<std::string> names_in(const Entries& entries, const std::string& pinned) {
    std::vector<std::string> names;
    for (const auto& entry : entries)
        if (pinned.empty() || entry.name == pinned) names.push_back(entry.name);
    return names;
}

Status measure_shading(SurfaceWork& work) {
    if (work.searches.empty() || !work.searches[work.base].trial)
        return input_error("nothing-to-choose",
                           fmt::format("no search is left for the surface {}", work.surface.name));
    const Tried& under = work.searches[work.base];
    const Result<Trial> whole = work.kept.run(
        work.site, work.request("glsl_450", under.rung, nullptr), work.hit_rays, Ask::Cost);
    if (!whole) return whole.error();
    work.shading.operations = whole->operations - under.trial->operations;
    work.shading.reads = whole->reads - under.trial->reads;
    return Done{};
}

// How wrong a search that is right makes even the best shadow.
Status light_searches(SurfaceWork& work, const Tried& best) {
    std::vector<Tried*> right;
    for (Tried& search : work.searches)
        if (search.trial && wrongness(work.loosest, *search.trial, true) <= 1)
            right.push_back(&search);
    std::vector<std::optional<Diagnostic>> errors(right.size());
    in_parallel(right.size(), work.options.workers, [&](std::size_t i) {
        const VariantRequest request =
            SurfaceWork::unpruned(work.request("glsl_450", right[i]->rung, &best.rung));
        Result<Trial> trial = work.kept.run(work.site, request, work.shadow_rays, Ask::Errors);
        if (trial)
            right[i]->best_lit = std::move(*trial);
        else
            errors[i] = trial.error();
    });
    for (const auto& error : errors)
        if (error) return *error;
    return Done{};
}

// Where ladders end: steps that the relief and the directions cannot use.
LadderLimits limits_of(SurfaceWork& work) {
    const measure::RayReach down = measure::view_reach(work.facts, work.surface.scale, work.views);
    const int most = work.options.most_steps;
    LadderLimits limits;
    // Two samples for each texel that a ray passes over, and eight at least.
    limits.any = std::clamp(2 * down.steps(), std::min(8, most), most);
    const auto cells = [&](const char* knob, const measure::RayReach& reach) {
        limits.by_knob.emplace_back(knob, std::min(reach.cells(), most));
    };
    cells("max_cells", down);
    cells("max_leaps", down);
    measure::RayReach up;
    for (const std::size_t light : work.common.shadowing) {
        const measure::RayReach one = measure::light_reach(
            work.facts, work.surface.scale, directions_of(work.surface.lights[light]));
        if (one.cells() > up.cells()) up = one;
    }
    if (work.wants_shadow()) {
        cells("shadow_cells", up);
        cells("shadow_leaps", up);
    }
    if (limits.any < most)
        work.dropped.push_back(
            {fmt::format("steps beyond {}", limits.any),
             Dropped::By::Bound,
             fmt::format("with {} no step of a view ray is longer than a texel", down.steps()),
             {},
             {}});
    if (down.cells() < most)
        work.dropped.push_back({fmt::format("cells beyond {}", down.cells()),
                                Dropped::By::Bound,
                                "no view ray crosses more of the map's",
                                {},
                                {}});
    return limits;
}

}  // namespace

double wrongness(const scene::Tolerance& tolerance, const Trial& trial, bool hits_alone) {
    double most = 0;
    for (const auto& [metric, limit] : tolerance) {
        if (hits_alone && (metric == "shadow_wrong" || of_narrow(metric))) continue;
        const auto found = trial.errors.find(metric);
        // Of another kind of target.
        if (found == trial.errors.end() && of_narrow(metric)) continue;
        // Not a single ray gave a number.
        if (found == trial.errors.end()) return INFINITY;
        if (found->second <= limit)
            most = std::max(most, limit > 0 ? found->second / limit : 0);
        else
            most = std::max(most, limit > 0 ? found->second / limit : 1 + found->second);
    }
    return most;
}

std::string why_wrong(const scene::Tolerance& tolerance, const Trial& trial, bool hits_alone) {
    std::string sentence;
    double most = 0;
    for (const auto& [metric, limit] : tolerance) {
        const double over = wrongness({{metric, limit}}, trial, hits_alone);
        if (over <= 1 || over <= most) continue;
        most = over;
        const measure::Metric* known = measure::find_metric(metric);
        const auto found = trial.errors.find(metric);
        if (found == trial.errors.end()) return fmt::format("{} is unknown", metric);
        sentence = fmt::format("{} is {:.3g} {}, of at most {:.3g}", metric, found->second,
                               known == nullptr ? "" : known->unit, limit);
    }
    return sentence;
}

Status climb_ladders(SurfaceWork& work) {
    const Knobs& pinned = work.common.knobs;
    const LadderLimits limits = limits_of(work);
    const std::string target = "glsl_450";
    for (const std::string& name : names_in(work.catalogue.searches, work.common.search)) {
        std::string too_large;
        for (const Rung& rung : search_ladder(work.catalogue, name, pinned, limits)) {
            Tried tried{rung, {}, too_large};
            if (work.common.search.empty() && too_large.empty()) {
                const double texels = work.site.baked_texels(work.request(target, rung, nullptr));
                if (texels > most_baked_texels)
                    tried.skipped = too_large = fmt::format(
                        "its baked map holds {:.0f} texels for each of the height map's, of at "
                        "most {:.0f} that are offered; pin search={} to have it",
                        texels, most_baked_texels, name);
            }
            work.searches.push_back(std::move(tried));
        }
    }
    const scene::Tolerance& tolerance = work.strictest;
    Status status = climb(
        work, work.searches, work.hit_rays,
        [&](const Rung& rung) {
            return SurfaceWork::unpruned(work.request(target, rung, nullptr));
        },
        [&](const Trial& trial) { return wrongness(tolerance, trial, true) <= 1; });
    if (!status) return status;
    work.base = most_accurate(work, work.searches, "p95");
    if (Status shaded = measure_shading(work); !shaded) return shaded;
    if (!work.wants_shadow()) return Done{};

    for (const dsl::Entry<dsl::Shadow>& entry : work.catalogue.shadows) {
        const std::string& name = entry.name;
        if (!work.common.shadow.empty() && name != work.common.shadow) continue;
        // To be rid of a shadow takes a tolerance that says how wrong it may be.
        if (!entry.make()->depends_on_light() && work.common.shadow.empty() &&
            (name != "none" || !tolerance.contains("shadow_wrong")))
            continue;
        for (const Rung& rung : shadow_ladder(work.catalogue, name, pinned, limits))
            work.shadows.push_back({rung, {}, {}});
    }
    const Rung& under = work.searches[work.base].rung;
    status = climb(
        work, work.shadows, work.shadow_rays,
        [&](const Rung& rung) { return SurfaceWork::unpruned(work.request(target, under, &rung)); },
        [&](const Trial& trial) {
            const auto limit = tolerance.find("shadow_wrong");
            return limit == tolerance.end() ||
                   wrongness({{limit->first, limit->second}}, trial, false) <= 1;
        });
    if (!status || work.shadows.empty()) return status;
    return light_searches(work, work.shadows[most_accurate(work, work.shadows, "shadow_wrong")]);
}

}  // namespace intaglio::plan

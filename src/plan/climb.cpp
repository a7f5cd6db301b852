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
// Texels: hits so near to the exact ones leave shadows their own errors.
constexpr double sharp = 0.25;
// More texels of baked maps than this for each of the height map's are not offered unless pinned:
// a volume of a 256 x 256 map over this has more than 2.6 million.
constexpr double most_baked_texels = 40;

bool of_narrow(const std::string& metric) {
    return metric.ends_with("_fp24") || metric.ends_with("_fp16");
}

// Tries what is left of one level.  `attempt` fills a rung's trial, and whether it is right.
template <typename Attempt>
Status try_level(SurfaceWork& work, std::vector<Tried>& all, const std::vector<std::size_t>& which,
                 const Attempt& attempt) {
    std::vector<std::optional<Diagnostic>> errors(which.size());
    in_parallel(which.size(), work.options.workers, [&](std::size_t i) {
        if (Status status = attempt(all[which[i]]); !status) errors[i] = status.error();
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
            one.above = true;
            one.skipped = fmt::format("{} does less and is right", lower.rung.text());
            return;
        }
        const double cost = work.cost(*lower.trial);
        if (cheapest > 0 && cost > hopeless * cheapest) {
            one.above = true;
            one.skipped = fmt::format(
                "{} does less and costs {:.0f} already, {:.0f} times what "
                "the cheapest right one does",
                lower.rung.text(), cost, cost / cheapest);
            return;
        }
    }
}

template <typename Attempt>
Status climb(SurfaceWork& work, std::vector<Tried>& all, const Attempt& attempt) {
    int levels = 0;
    for (const Tried& one : all) levels = std::max(levels, one.rung.level + 1);
    for (int level = 0; level < levels; ++level) {
        double cheapest = 0;
        for (const Tried& one : all)
            if (one.trial && one.right && (cheapest == 0 || work.cost(*one.trial) < cheapest))
                cheapest = work.cost(*one.trial);
        std::vector<std::size_t> which;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (all[i].rung.level != level || !all[i].skipped.empty() || all[i].trial) continue;
            if (!work.options.exhaustive) skip_needless(work, all, all[i], cheapest);
            if (all[i].skipped.empty()) which.push_back(i);
        }
        if (Status status = try_level(work, all, which, attempt); !status) return status;
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

scene::Tolerance only_shadow(const scene::Tolerance& tolerance) {
    const auto limit = tolerance.find("shadow_wrong");
    return limit == tolerance.end() ? scene::Tolerance() : scene::Tolerance{*limit};
}

VariantRequest request_of(const SurfaceWork& work, const Rung& search, const Rung* shadow) {
    return SurfaceWork::unpruned(work.request("glsl_450", search, shadow));
}

// A shadow is no better than the point it falls on: how wrong a search that is right for some
// target makes even the best shadow.  Null: that is not known yet.
Status light_search(const SurfaceWork& work, const Tried* best, Tried& search) {
    if (best == nullptr || !search.trial || wrongness(work.loosest, *search.trial, true) > 1)
        return Done{};
    Result<Trial> trial = work.kept.run(work.site, request_of(work, search.rung, &best->rung),
                                        work.shadow_rays, Ask::Errors);
    if (!trial) return trial.error();
    search.best_lit = std::move(*trial);
    search.right =
        search.right && wrongness(only_shadow(work.strictest), *search.best_lit, false) <= 1;
    return Done{};
}

Status try_search(const SurfaceWork& work, const Tried* best, Tried& search) {
    Result<Trial> trial = work.kept.run(work.site, request_of(work, search.rung, nullptr),
                                        work.hit_rays, Ask::Errors);
    if (!trial) return trial.error();
    search.right = trial->refusal.empty() && wrongness(work.strictest, *trial, true) <= 1;
    search.trial = std::move(*trial);
    return light_search(work, best, search);
}

Status climb_searches(SurfaceWork& work, const Tried* best) {
    return climb(work, work.searches,
                 [&](Tried& search) { return try_search(work, best, search); });
}

// Shadows are tried on hits that are no trouble themselves: where tolerances are loose, on a rung
// above those that would do.
Status sharpen_base(SurfaceWork& work) {
    work.base = most_accurate(work, work.searches, "p95");
    const auto p95 = [](const Tried& search) {
        const auto found = search.trial->errors.find("p95");
        return found == search.trial->errors.end() ? 0 : found->second;
    };
    if (!work.searches[work.base].trial) return Done{};
    for (std::size_t i = 0; i < work.searches.size(); ++i) {
        Tried& higher = work.searches[i];
        const Tried& base = work.searches[work.base];
        if (p95(base) <= sharp) break;
        if (higher.trial || !higher.above || !higher.rung.no_less_than(base.rung)) continue;
        higher.skipped.clear();
        if (Status status = try_search(work, nullptr, higher); !status) return status;
        if (p95(higher) < p95(base)) work.base = i;
    }
    return Done{};
}

Status climb_shadows(SurfaceWork& work) {
    const Rung& under = work.searches[work.base].rung;
    return climb(work, work.shadows, [&](Tried& shadow) -> Status {
        Result<Trial> trial = work.kept.run(work.site, request_of(work, under, &shadow.rung),
                                            work.shadow_rays, Ask::Errors);
        if (!trial) return trial.error();
        shadow.right =
            trial->refusal.empty() && wrongness(only_shadow(work.strictest), *trial, false) <= 1;
        shadow.trial = std::move(*trial);
        return Done{};
    });
}

// Searches under the best of the shadows.  Where one that was right makes it too wrong, what is
// above it is tried as well.
Status light_searches(SurfaceWork& work) {
    const Tried& best = work.shadows[most_accurate(work, work.shadows, "shadow_wrong")];
    std::vector<std::size_t> tried;
    std::vector<bool> was_right;
    for (std::size_t i = 0; i < work.searches.size(); ++i) {
        was_right.push_back(work.searches[i].right);
        if (work.searches[i].trial) tried.push_back(i);
    }
    Status status = try_level(work, work.searches, tried,
                              [&](Tried& search) { return light_search(work, &best, search); });
    if (!status) return status;
    bool any = false;
    for (const std::size_t i : tried) any |= was_right[i] && !work.searches[i].right;
    if (!any) return Done{};
    for (Tried& search : work.searches)
        if (search.above) search.skipped.clear();
    return climb_searches(work, &best);
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
    if (Status status = climb_searches(work, nullptr); !status) return status;
    if (Status status = sharpen_base(work); !status) return status;
    if (Status status = measure_shading(work); !status) return status;
    if (!work.wants_shadow()) return Done{};

    for (const dsl::Entry<dsl::Shadow>& entry : work.catalogue.shadows) {
        const std::string& name = entry.name;
        if (!work.common.shadow.empty() && name != work.common.shadow) continue;
        // To be rid of a shadow takes a tolerance that says how wrong it may be.
        if (!entry.make()->depends_on_light() && work.common.shadow.empty() &&
            (name != "none" || !work.strictest.contains("shadow_wrong")))
            continue;
        for (const Rung& rung : shadow_ladder(work.catalogue, name, pinned, limits))
            work.shadows.push_back({rung, {}, {}});
    }
    if (work.shadows.empty()) return Done{};
    if (Status status = climb_shadows(work); !status) return status;
    return light_searches(work);
}

}  // namespace intaglio::plan

// One target's choice.  Pairs of a search and a shadow are judged in the order of what they will
// cost as the evaluator counts it, until none that is left can be cheaper than the best.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "src/measure/named_metric.h"
#include "src/plan/finish.h"
#include "src/plan/parallel.h"
#include "src/plan/surface_work.h"

namespace intaglio::plan {
namespace {

// So much cheaper than what the ratios of others to their prediction say a variant may be.
// `plan --exhaustive` measures what it is: docs/plan.md.
constexpr double surprise = 0.8;
// The same of a variant whose techniques others have in other settings.
constexpr double kin_surprise = 0.9;
constexpr std::size_t batch = 4;  // judged at once, whatever the number of workers
// On the shadows' ladder a little wrong on one search's hits may be right on another's.
constexpr double shadow_slack = 1.25;
// Schedules change costs by less than this.
constexpr double near = 1.25;
// A text longer than this is not offered where the language has loops.
constexpr int most_unrolled = 1000;
constexpr std::size_t most_fits = 60;  // tried in search of the best that fits
constexpr const char* per_vertex_text = ", per vertex";

struct Pair {
    const Tried* search;
    const Tried* shadow;  // null: none is wanted
    double predicted = 0, wrong = 0;
    Trial size{};  // written out, of a target without loops
    Candidate candidate{};
    bool measured = false;  // its errors are its own
};

class Chooser {
  public:
    Chooser(const SurfaceWork& work, const std::string& target)
        : work_(work),
          target_(*find_target(target)),
          tolerance_(work.surface.tolerance_on(target)),
          budget_(work.surface.budget_on(target)) {}

    Result<Choice> run();

  private:
    Status pair_up(bool right, bool others);
    Status predict(Pair& pair);
    Status judge(Pair& pair);
    Status judge_batch(const std::vector<Pair*>& some);
    Status measure(Pair& pair);
    Status find_best();
    Status try_schedules();
    Status find_nearest();
    // Without loops everything is written out, and runs.
    bool straight() const { return !target_.capabilities.loops; }
    bool bytecode() const { return profile_of(target_).has_value(); }
    VariantRequest request(const Pair& pair, const Schedule& schedule = {}) const {
        return work_.request(std::string(target_.name), pair.search->rung,
                             pair.shadow ? &pair.shadow->rung : nullptr, schedule);
    }
    std::string far_too_long(const Pair& pair) const {
        return straight() ? why_too_long(target_, pair.size) : std::string();
    }
    const Pair* dearer_below(const Pair& pair) const;
    double foreseen(const Pair& pair) const;
    const Pair* refused_below(const Pair& pair) const;

    const SurfaceWork& work_;
    const Target& target_;
    const scene::Tolerance tolerance_;
    const scene::Budget budget_;
    std::vector<Pair> pairs_;
    std::vector<const Pair*> refused_;
    Pair* best_ = nullptr;
    double least_ratio_ = 0;  // of costs to their predictions; 0: none is known
};

std::string text_of(const Pair& pair) {
    std::string text = pair.search->rung.text();
    if (pair.shadow) text += ", shadow " + pair.shadow->rung.text();
    return text;
}

// Whether `high` does at least what `low` does.
bool no_less_than(const Pair& high, const Pair& low) {
    if (!high.search->rung.no_less_than(low.search->rung)) return false;
    return high.shadow == nullptr || high.shadow->rung.no_less_than(low.shadow->rung);
}

// Where two are as good, the more accurate, then the first by name.
bool better(const Pair& a, const Pair& b) {
    return std::tie(a.candidate.cost, a.wrong, a.candidate.text) <
           std::tie(b.candidate.cost, b.wrong, b.candidate.text);
}

// What a shadow adds to one search it adds to another with nearly the same hits.
Status Chooser::predict(Pair& pair) {
    pair.candidate.text = text_of(pair);
    const Tried& base = work_.searches[work_.base];
    Trial alone = *pair.search->trial, under = *base.trial, shadowed = under;
    if (pair.shadow) shadowed = *pair.shadow->trial;
    if (straight()) {
        const auto size = [&](const Tried& search, const Tried* shadow, Trial& into) -> Status {
            const Result<Trial> trial =
                work_.written_out(search.rung, shadow ? &shadow->rung : nullptr);
            if (!trial) return trial.error();
            into = *trial;
            return Done{};
        };
        if (Status status = size(*pair.search, nullptr, alone); !status) return status;
        if (pair.shadow) {
            if (Status status = size(base, nullptr, under); !status) return status;
            if (Status status = size(base, pair.shadow, shadowed); !status) return status;
        } else {
            shadowed = under;
        }
    }
    Candidate& candidate = pair.candidate;
    candidate.operations = alone.operations + shadowed.operations - under.operations;
    candidate.reads = alone.reads + shadowed.reads - under.reads;
    if (straight()) {
        pair.size.operations = candidate.operations;
        pair.size.reads = candidate.reads;
    } else {
        candidate.operations += work_.shading.operations;
        candidate.reads += work_.shading.reads;
    }
    pair.predicted = candidate.operations + work_.read_weight * candidate.reads;
    candidate.cost = pair.predicted;
    return Done{};
}

// Pairs that are right as far as their parts say; `others`: those that are not.
Status Chooser::pair_up(bool right, bool others) {
    const std::size_t before = pairs_.size();
    const auto limit = tolerance_.find("shadow_wrong");
    const auto of_shadow = [&](const std::optional<Trial>& trial) {
        if (limit == tolerance_.end() || !trial) return 0.0;
        return wrongness({{limit->first, limit->second}}, *trial, false);
    };
    const auto add = [&](const Tried& search, const Tried* shadow, double wrong) {
        if (wrong <= 1 ? right : others) pairs_.push_back({&search, shadow, 0, wrong, {}});
    };
    for (const Tried& search : work_.searches) {
        if (!search.trial || !search.trial->refusal.empty()) continue;
        const double wrong = wrongness(tolerance_, *search.trial, true);
        if (!work_.wants_shadow()) {
            add(search, nullptr, wrong);
            continue;
        }
        // Under the best of shadows its hits are still where they are.
        const double least = of_shadow(search.best_lit);
        for (const Tried& shadow : work_.shadows) {
            if (!shadow.trial || !shadow.trial->refusal.empty()) continue;
            const double own = of_shadow(shadow.trial);
            add(search, &shadow, std::max({wrong, least / shadow_slack, own / shadow_slack}));
        }
    }
    std::vector<std::optional<Diagnostic>> errors(pairs_.size());
    in_parallel(pairs_.size() - before, work_.options.workers, [&](std::size_t i) {
        if (Status status = predict(pairs_[before + i]); !status) errors[i] = status.error();
    });
    for (const auto& error : errors)
        if (error) return *error;
    std::stable_sort(pairs_.begin() + static_cast<std::ptrdiff_t>(before), pairs_.end(), better);
    return Done{};
}

// The same setting that was refused, or one with less to do.
const Pair* Chooser::refused_below(const Pair& pair) const {
    for (const Pair* lower : refused_)
        if (no_less_than(pair, *lower)) return lower;
    return nullptr;
}

// What does less and costs no less than the best.
const Pair* Chooser::dearer_below(const Pair& pair) const {
    for (const Pair& lower : pairs_)
        if (lower.candidate.judged && lower.candidate.fate != Fate::Refused && &lower != &pair &&
            lower.candidate.cost >= best_->candidate.cost && no_less_than(pair, lower))
            return &lower;
    return nullptr;
}

// The least that it may cost, as the others' forecasts were right: those of the same techniques,
// or where there is none of any.
double Chooser::foreseen(const Pair& pair) const {
    double least = 0;
    for (const Pair& other : pairs_) {
        if (!other.candidate.judged || other.candidate.fate == Fate::Refused) continue;
        if (other.search->rung.technique != pair.search->rung.technique) continue;
        if (pair.shadow && other.shadow->rung.technique != pair.shadow->rung.technique) continue;
        const double ratio = other.candidate.cost / std::max(other.predicted, 1.0);
        least = least == 0 ? ratio : std::min(least, ratio);
    }
    return pair.predicted * (least == 0 ? least_ratio_ * surprise : least * kin_surprise);
}

// Whether the target has it, and what it costs there.
Status Chooser::judge(Pair& pair) {
    Candidate& candidate = pair.candidate;
    if (candidate.request.surface.empty()) candidate.request = request(pair);
    if (candidate.why = far_too_long(pair); !candidate.why.empty()) {
        candidate.fate = Fate::Refused;
        candidate.judged = true;
        return Done{};
    }
    Result<Trial> price = work_.price(candidate.request);
    if (!price) return price.error();
    candidate.judged = true;
    // What is too long for a pixel stage may fit when the vertex stage does its part.
    const bool too_long =
        price->refusal_code == "d3d9-limit" || price->refusal_code == "target-limit";
    if (straight() && too_long && !candidate.request.per_vertex) {
        const VariantRequest lighter = request(pair, {false, true});
        Result<Trial> other = work_.price(lighter);
        if (!other) return other.error();
        if (other->refusal.empty()) {
            candidate.request = lighter;
            candidate.text += per_vertex_text;
            price = std::move(other);
        }
    }
    if (!price->refusal.empty()) {
        candidate.fate = Fate::Refused;
        candidate.why = price->refusal;
        return Done{};
    }
    candidate.costs = price->costs;
    candidate.operations = price->operations;
    candidate.reads = price->reads;
    candidate.cost = candidate.operations + work_.read_weight * candidate.reads;
    candidate.fate = Fate::Dearer;
    if (!bytecode() || work_.options.exhaustive) return measure(pair);
    return Done{};
}

// Its own errors, in place of its parts'.
Status Chooser::measure(Pair& pair) {
    Candidate& candidate = pair.candidate;
    VariantRequest same = SurfaceWork::one_light(candidate.request);
    if (!bytecode()) {
        same = SurfaceWork::unpruned(same);
        same.target = work_.like(same, Ask::Errors);
    }
    const Result<Trial> trial = work_.kept.run(work_.site, same, work_.rays(), Ask::Errors);
    if (!trial) return trial.error();
    pair.measured = true;
    if (!trial->refusal.empty()) {
        // Of the shader that writes the hit, which can be the longer one.
        candidate.fate = Fate::Refused;
        candidate.why = "its hits cannot be measured: " + trial->refusal;
        return Done{};
    }
    candidate.errors = trial->errors;
    candidate.costs["reads"] = trial->costs.at("reads");
    pair.wrong = wrongness(tolerance_, *trial, false);
    if (pair.wrong > 1) {
        candidate.fate = Fate::Wrong;
        candidate.why = why_wrong(tolerance_, *trial, false);
    } else if (const std::string over = over_budget(budget_, candidate.costs); !over.empty()) {
        candidate.fate = Fate::OverBudget;
        candidate.why = over;
    }
    return Done{};
}

Status Chooser::judge_batch(const std::vector<Pair*>& some) {
    std::vector<std::optional<Diagnostic>> errors(some.size());
    in_parallel(some.size(), work_.options.workers, [&](std::size_t i) {
        if (Status status = judge(*some[i]); !status) errors[i] = status.error();
    });
    for (const auto& error : errors)
        if (error) return *error;
    std::vector<Pair*> fitting;
    for (Pair* pair : some) {
        if (pair->candidate.fate == Fate::Refused) {
            refused_.push_back(pair);
            continue;
        }
        const double ratio = pair->candidate.cost / std::max(pair->predicted, 1.0);
        least_ratio_ = least_ratio_ == 0 ? ratio : std::min(least_ratio_, ratio);
        fitting.push_back(pair);
    }
    // Bytecode is run where it would be the best.
    std::stable_sort(fitting.begin(), fitting.end(),
                     [](const Pair* a, const Pair* b) { return better(*a, *b); });
    for (Pair* pair : fitting) {
        if (best_ != nullptr && !better(*pair, *best_)) continue;
        if (!pair->measured)
            if (Status status = measure(*pair); !status) return status;
        if (pair->candidate.fate == Fate::Dearer) best_ = pair;
    }
    return Done{};
}

Status Chooser::find_best() {
    std::vector<Pair*> some;
    for (std::size_t i = 0; i <= pairs_.size(); ++i) {
        if (some.size() == batch || i == pairs_.size()) {
            if (Status status = judge_batch(some); !status) return status;
            some.clear();
        }
        if (i == pairs_.size()) break;
        Pair& pair = pairs_[i];
        if (pair.wrong > 1 && !work_.options.exhaustive) continue;
        if (pair.candidate.why = far_too_long(pair); !pair.candidate.why.empty()) {
            pair.candidate.fate = Fate::Refused;
        } else if (const Pair* lower = refused_below(pair)) {
            pair.candidate.fate = Fate::Refused;
            pair.candidate.why = fmt::format("{} does less and is refused", text_of(*lower));
        } else if (best_ != nullptr && !work_.options.exhaustive &&
                   foreseen(pair) > best_->candidate.cost) {
            pair.candidate.why = fmt::format("foreseen to cost at least {:.0f}, against {:.0f}",
                                             foreseen(pair), best_->candidate.cost);
        } else if (const Pair* dearer = best_ == nullptr || work_.options.exhaustive
                                            ? nullptr
                                            : dearer_below(pair)) {
            pair.candidate.why =
                fmt::format("{} does less and costs {:.0f}, against {:.0f}", text_of(*dearer),
                            dearer->candidate.cost, best_->candidate.cost);
        } else {
            some.push_back(&pair);
        }
    }
    return Done{};
}

// The best and what is nearly as cheap, with other schedules.
Status Chooser::try_schedules() {
    if (best_ == nullptr) return Done{};
    std::vector<Schedule> schedules = {{false, true}};
    if (target_.capabilities.loops) {
        schedules.push_back({true, false});
        schedules.push_back({true, true});
    }
    std::vector<Pair> more;
    std::vector<std::string> seen = {work_.optimized(best_->candidate.request)};
    for (const Pair& pair : pairs_) {
        if (pair.candidate.fate != Fate::Dearer || !pair.candidate.judged) continue;
        if (pair.candidate.request.per_vertex) continue;  // it fits no other way
        if (pair.candidate.cost > near * best_->candidate.cost && !work_.options.exhaustive)
            continue;
        const Result<Trial> size =
            work_.kept.run(work_.site, pair.candidate.request, work_.hit_rays, Ask::Size);
        if (!size) return size.error();
        for (const Schedule& schedule : schedules) {
            if (schedule.unrolled && size->operations > most_unrolled) continue;
            Pair other = pair;
            other.measured = false;
            other.candidate.request = request(pair, schedule);
            // A schedule that changes nothing is none.
            const std::string made = work_.optimized(other.candidate.request);
            if (std::find(seen.begin(), seen.end(), made) != seen.end()) continue;
            seen.push_back(made);
            other.candidate.text = text_of(pair);
            other.candidate.text += schedule.unrolled ? ", unrolled" : "";
            other.candidate.text += schedule.per_vertex ? per_vertex_text : "";
            more.push_back(std::move(other));
        }
    }
    const std::size_t before = pairs_.size();
    const std::size_t best = static_cast<std::size_t>(best_ - pairs_.data());
    pairs_.insert(pairs_.end(), more.begin(), more.end());
    refused_.clear();  // which pointed into pairs_
    best_ = &pairs_[best];
    std::vector<Pair*> some;
    for (std::size_t i = before; i < pairs_.size(); ++i) some.push_back(&pairs_[i]);
    return judge_batch(some);
}

// Nothing is right and fits: the most accurate that fits.  Where one had too many slots, what is as
// long is not tried, which leads to what is short enough in few steps.
Status Chooser::find_nearest() {
    double too_long = INFINITY;  // operations, written out
    const auto look_at = [&](const Pair& pair) {
        if (straight() && pair.candidate.judged && pair.candidate.fate == Fate::Refused &&
            pair.candidate.why.find(" slots") != std::string::npos)
            too_long = std::min(too_long, pair.size.operations);
    };
    std::vector<Pair*> by_wrong;
    for (Pair& pair : pairs_) {
        by_wrong.push_back(&pair);
        look_at(pair);
    }
    std::stable_sort(by_wrong.begin(), by_wrong.end(), [](const Pair* a, const Pair* b) {
        return std::tie(a->wrong, a->predicted) < std::tie(b->wrong, b->predicted);
    });
    std::size_t tried = 0;
    for (Pair* pair : by_wrong) {
        if (pair->candidate.judged || pair->size.operations >= too_long ||
            refused_below(*pair) != nullptr || !far_too_long(*pair).empty())
            continue;
        if (++tried > most_fits) break;
        if (Status status = judge(*pair); !status) return status;
        if (pair->candidate.fate == Fate::Refused) {
            refused_.push_back(pair);
            look_at(*pair);
            continue;
        }
        if (!pair->measured)
            if (Status status = measure(*pair); !status) return status;
        if (pair->candidate.fate == Fate::Wrong &&
            over_budget(budget_, pair->candidate.costs).empty())
            return Done{};
    }
    return Done{};
}

Result<Choice> Chooser::run() {
    Choice choice;
    choice.surface = work_.surface.name;
    choice.target = target_.name;
    if (Status status = pair_up(true, work_.options.exhaustive); !status) return status.error();
    if (Status status = find_best(); !status) return status.error();
    if (Status status = try_schedules(); !status) return status.error();
    if (best_ == nullptr) {
        refused_.clear();  // which pointed into pairs_
        if (!work_.options.exhaustive)
            if (Status status = pair_up(false, true); !status) return status.error();
        if (Status status = find_nearest(); !status) return status.error();
    }

    std::stable_sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
        if (a.candidate.judged != b.candidate.judged) return a.candidate.judged;
        return better(a, b);
    });
    double least_wrong = INFINITY, least_cost = INFINITY;
    for (Pair& pair : pairs_) {
        Candidate& candidate = pair.candidate;
        const std::size_t index = choice.candidates.size();
        const bool right = pair.wrong <= 1;
        if (candidate.errors.empty()) candidate.errors = foreseen_errors(*pair.search, pair.shadow);
        // Of a light that has no shadow here it says nothing.
        if (!work_.wants_shadow()) candidate.errors.erase("shadow_wrong");
        if (!candidate.judged && candidate.fate == Fate::NotTried) {
            if (!right) candidate.fate = Fate::Wrong;
            if (candidate.why.empty())
                candidate.why = why_wrong(tolerance_, *pair.search->trial, true);
            if (candidate.why.empty() && pair.shadow && !right)
                candidate.why = why_wrong(tolerance_, *pair.shadow->trial, false);
        }
        if (candidate.fate == Fate::Dearer && right) {
            if (!choice.chosen) {
                choice.chosen = index;
                candidate.fate = Fate::Chosen;
                candidate.why = "the cheapest that is right";
            } else {
                candidate.why = fmt::format("costs {:.3g} against {:.3g}", candidate.cost,
                                            choice.candidates[*choice.chosen].cost);
            }
        }
        const bool fits = candidate.judged && candidate.fate != Fate::Refused &&
                          candidate.fate != Fate::OverBudget &&
                          over_budget(budget_, candidate.costs).empty();
        if (fits && pair.wrong < least_wrong) {
            least_wrong = pair.wrong;
            choice.best_that_fits = index;
        }
        if (right && candidate.cost < least_cost) {
            least_cost = candidate.cost;
            choice.cheapest_right = index;
        }
        choice.candidates.push_back(std::move(candidate));
    }
    if (choice.chosen) choice.best_that_fits = choice.cheapest_right = {};
    std::set<const Tried*> paired;
    for (const Pair& pair : pairs_) paired.insert({pair.search, pair.shadow});
    add_losers_of_ladders(work_, tolerance_, paired, choice);
    choice.dropped = work_.dropped;
    if (choice.chosen)
        if (Status status = finish(work_, choice); !status) return status.error();
    return choice;
}

}  // namespace

Result<Choice> choose(const SurfaceWork& work, const std::string& target) {
    if (find_target(target) == nullptr)
        return input_error("unknown-target", "unknown target '" + target + "'");
    return Chooser(work, target).run();
}

}  // namespace intaglio::plan

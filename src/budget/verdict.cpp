// One walk over metrics and variants; every limit is looked at in one function.
#include "src/budget/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "generator/target/target.h"
#include "src/measure/named_metric.h"
#include "src/variant/variant.h"

namespace intaglio::budget {
namespace {

const Observation* find(const std::vector<Observation>& all, const Observation& wanted) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Observation& o) {
        return !(o < wanted) && !(wanted < o);
    });
    return found == all.end() ? nullptr : &*found;
}

std::optional<double> value_of(const Observation* observation, std::string_view metric) {
    if (!observation) return std::nullopt;
    const auto found = observation->values.find(std::string(metric));
    return found == observation->values.end() ? std::nullopt : std::optional(found->second);
}

// Slots are not asked of a language that has none.
bool applies(const measure::Metric& metric, const std::string& target_name) {
    const Target* target = find_target(target_name);
    if (metric.of == measure::Metric::Of::Both || !target) return true;
    return profile_of(*target).has_value() == (metric.of == measure::Metric::Of::Direct3D9);
}

// The line whose spending grew most; where the baseline has none of its lines, the greatest.
std::string dearest_line(const Observation& now, const Observation* before) {
    std::string dearest;
    double most = 0, was = 0;
    for (const auto& [line, spent] : now.lines) {
        double old = 0;
        if (before)
            if (const auto found = before->lines.find(line); found != before->lines.end())
                old = found->second;
        if (spent - old > most) {
            most = spent - old;
            was = old;
            dearest = line;
        }
    }
    if (dearest.empty()) return {};
    const double is = now.lines.at(dearest);
    return before && !before->lines.empty() ? fmt::format("{}: {:g}, before {:g}", dearest, is, was)
                                            : fmt::format("{}: {:g}", dearest, is);
}

Finding finding_of(const Observation& now, const Observation* before,
                   const measure::Metric& metric) {
    Finding finding;
    finding.surface = now.surface;
    finding.target = now.target;
    finding.settings = now.settings;
    finding.metric = metric.name;
    finding.before = value_of(before, metric.name);
    finding.after = value_of(&now, metric.name);
    if (const auto command = now.commands.find(finding.metric); command != now.commands.end())
        finding.command = command->second;
    const bool grew = finding.before && finding.after && *finding.after > *finding.before;
    if (grew && !metric.is_error && metric.name != "reads")
        finding.where = dearest_line(now, before);
    return finding;
}

void apply(Finding& finding, const Bound& bound, const Observation& now, const Observation* before,
           bool has_baseline) {
    const measure::Metric& metric = *measure::find_metric(finding.metric);
    const auto say = [&](Finding::Kind kind, std::string sentence) {
        finding.kind = kind;
        finding.sentence = std::move(sentence);
        finding.budget_line = bound.line;
        if (finding.where.empty() && !metric.is_error) finding.where = dearest_line(now, before);
    };
    if (!finding.after) {
        say(Finding::Kind::Unknown, fmt::format("{} is not known", metric.name));
        return;
    }
    if (bound.max && *finding.after > *bound.max) {
        say(Finding::Kind::Over,
            fmt::format("{} is {:g} {}, {:g} more than the {:g} allowed", metric.name,
                        *finding.after, metric.unit, *finding.after - *bound.max, *bound.max));
        return;
    }
    if (!bound.max_delta) return;
    if (!finding.before) {
        say(Finding::Kind::Unknown,
            fmt::format("how {} grew is not known: {}", metric.name,
                        has_baseline ? "the baseline does not have it" : "there is no baseline"));
        return;
    }
    if (*finding.after - *finding.before > *bound.max_delta)
        say(Finding::Kind::Over,
            fmt::format("{} grew from {:g} to {:g} {}, by more than the {:g} allowed", metric.name,
                        *finding.before, *finding.after, metric.unit, *bound.max_delta));
}

// Forgives what is over; `used` counts what each waiver forgave.
void forgive(Finding& finding, const Budgets& budgets, const std::string& today,
             std::vector<int>& used) {
    if (!finding.fails()) return;
    for (std::size_t i = 0; i < budgets.waivers.size(); ++i) {
        const Waiver& waiver = budgets.waivers[i];
        if (!waiver.selector.matches(finding.surface, finding.target, finding.settings)) continue;
        if (!waiver.metric.empty() && waiver.metric != finding.metric) continue;
        ++used[i];
        if (waiver.until < today) continue;
        finding.kind = Finding::Kind::Waived;
        finding.sentence += fmt::format("; forgiven until {}: {}", waiver.until, waiver.reason);
        return;
    }
}

Finding whole(const Observation& observation, Finding::Kind kind, std::string sentence) {
    Finding finding;
    finding.kind = kind;
    finding.surface = observation.surface;
    finding.target = observation.target;
    finding.settings = observation.settings;
    finding.sentence = std::move(sentence);
    return finding;
}

// A limit of a surface, target or variant that is not measured: misspelled, or no longer there.
std::vector<Finding> idle_limits(const Budgets& budgets, const std::vector<Observation>& now) {
    std::vector<Finding> findings;
    std::set<std::tuple<std::string, std::string, std::string>> said;
    for (const Rule& rule : budgets.rules) {
        const auto& [surface, target, settings] = rule.selector;
        if (std::any_of(now.begin(), now.end(), [&](const Observation& each) {
                return rule.selector.matches(each.surface, each.target, each.settings);
            }))
            continue;
        if (!said.insert({surface, target, settings}).second) continue;
        std::vector<std::string> surfaces;
        for (const Observation& each : now)
            if (surfaces.empty() || surfaces.back() != each.surface)
                surfaces.push_back(each.surface);
        const bool known = surface.empty() ||
                           std::find(surfaces.begin(), surfaces.end(), surface) != surfaces.end();
        Finding finding;
        finding.kind = Finding::Kind::Unknown;
        finding.surface = surface.empty() ? "any surface" : surface;
        finding.target = target.empty() ? "any target" : target;
        finding.settings = settings;
        finding.budget_line = rule.bound.line;
        finding.sentence =
            known ? "it is limited, and the scene has no such variant"
                  : "it is limited, and not measured: " +
                        unknown_name_sentence("surface of the scene", surface, surfaces);
        findings.push_back(std::move(finding));
    }
    return findings;
}

bool changed(const Finding& finding) { return finding.before != finding.after; }

}  // namespace

std::string Finding::name() const {
    return Observation{surface, target, settings, {}, {}, {}, {}}.name();
}

std::optional<double> Finding::growth() const {
    if (!before || !after || *before == *after) return std::nullopt;
    // From nothing to something is worse than any factor.
    if (*before == 0) return std::numeric_limits<double>::infinity();
    return *after / *before;
}

bool Verdict::passes() const {
    return std::none_of(findings.begin(), findings.end(),
                        [](const Finding& finding) { return finding.fails(); });
}

Verdict judge(const Budgets& budgets, const std::vector<Observation>& now,
              const std::vector<Observation>& baseline, const std::string& today) {
    Verdict verdict;
    verdict.budget_file = budgets.file;
    std::vector<int> used(budgets.waivers.size(), 0);
    const auto add = [&](Finding finding) {
        forgive(finding, budgets, today, used);
        verdict.findings.push_back(std::move(finding));
    };
    for (const Observation& observation : now) {
        const Observation* before = find(baseline, observation);
        if (!observation.refusal.empty()) {
            // A variant that was refused before, too, is what the scene's owner knows.
            if (!before || before->refusal.empty() || observation.wanted)
                add(whole(observation, Finding::Kind::Unknown,
                          fmt::format("refused: {}", observation.refusal)));
            continue;
        }
        for (const measure::Metric& metric : measure::metrics()) {
            if (!applies(metric, observation.target)) continue;
            Finding finding = finding_of(observation, before, metric);
            const auto bound = budgets.bound(observation.surface, observation.target,
                                             observation.settings, metric.name);
            if (bound) apply(finding, *bound, observation, before, !baseline.empty());
            if (bound || changed(finding)) add(std::move(finding));
        }
    }
    for (const Observation& before : baseline)
        if (!find(now, before))
            add(whole(before, Finding::Kind::Vanished,
                      "it is in the baseline, and the scene no longer has it"));
    for (Finding& idle : idle_limits(budgets, now)) add(std::move(idle));
    for (std::size_t i = 0; i < used.size(); ++i) {
        const Waiver& waiver = budgets.waivers[i];
        const std::string place = fmt::format("{}:{}", budgets.file, waiver.line);
        if (waiver.until < today)
            verdict.notes.push_back(
                fmt::format("{}: the waiver ended on {}: {}", place, waiver.until, waiver.reason));
        else if (used[i] == 0)
            verdict.notes.push_back(fmt::format("{}: the waiver forgives nothing", place));
    }
    const auto better = std::count_if(
        verdict.findings.begin(), verdict.findings.end(),
        [](const Finding& finding) { return finding.growth() && *finding.growth() < 1; });
    if (verdict.passes() && better > 0)
        verdict.notes.push_back(fmt::format(
            "{} got better: intaglio check {} --update holds them to it", better, budgets.file));
    return verdict;
}

Verdict difference(const std::vector<Observation>& before, const std::vector<Observation>& after) {
    Verdict verdict;
    for (const Observation& observation : after) {
        const Observation* old = find(before, observation);
        if (!old) {
            verdict.findings.push_back(whole(observation, Finding::Kind::Fine, "new"));
            continue;
        }
        if (old->refusal != observation.refusal)
            verdict.findings.push_back(whole(observation, Finding::Kind::Fine,
                                             observation.refusal.empty()
                                                 ? "no longer refused"
                                                 : "refused: " + observation.refusal));
        for (const measure::Metric& metric : measure::metrics()) {
            Finding finding = finding_of(observation, old, metric);
            if (changed(finding)) verdict.findings.push_back(std::move(finding));
        }
    }
    for (const Observation& old : before)
        if (!find(after, old)) verdict.findings.push_back(whole(old, Finding::Kind::Fine, "gone"));
    return verdict;
}

}  // namespace intaglio::budget

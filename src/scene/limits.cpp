// Tolerances and budgets from the tree of a scene file.
#include "src/scene/limits.h"

#include <fmt/format.h>

#include <limits>
#include <vector>

#include "generator/base/nearest.h"
#include "generator/target/target.h"
#include "src/measure/named_metric.h"
#include "src/variant/variant.h"

namespace intaglio::scene {
namespace {

using measure::Metric;

// Whether variants of the target have it.
bool applies(const Metric& metric, const std::string& target_name) {
    const Target* target = find_target(target_name);
    if (!target || metric.of == Metric::Of::Both) return true;
    return profile_of(*target).has_value() == (metric.of == Metric::Of::Direct3D9);
}

void read_metrics(Reader& reader, const Value& table, std::string_view title,
                  const std::string& target, Limited what, std::map<std::string, double>& into) {
    std::vector<std::string> names;
    for (const Metric& metric : measure::metrics())
        if (metric.is_error == (what == Limited::Error)) names.emplace_back(metric.name);
    for (const Member& member : table.members) {
        if (member.value.kind == Kind::Table) continue;
        const Metric* metric = measure::find_metric(member.key);
        if (!metric) {
            reader.refuse(
                member.position, "unknown-metric",
                unknown_name_sentence(fmt::format("metric of {}", title), member.key, names));
        } else if (metric->is_error != (what == Limited::Error)) {
            reader.refuse(member.position, "unknown-metric",
                          fmt::format("{} is {}: it belongs into {}", member.key,
                                      metric->is_error ? "an error" : "a cost",
                                      metric->is_error ? "[tolerance]" : "[budget]"));
        } else if (!applies(*metric, target)) {
            reader.refuse(member.position, "scene-not-applicable",
                          fmt::format("{} has no {}: {}", target, member.key, metric->about));
        }
        into[member.key] =
            reader.number_of(member.value, member.key, {0, std::numeric_limits<double>::max()});
    }
}

}  // namespace

void check_target(Reader& reader, Position position, const std::string& name) {
    std::vector<std::string> names;
    for (const Target* target : all_targets())
        if (target->pixel_stage && is_judged(*target)) names.emplace_back(target->name);
    const Target* target = find_target(name);
    if (target && !target->pixel_stage)
        reader.refuse(position, "unknown-target",
                      fmt::format("{} has no pixel stage; name the pixel shaders' profile", name));
    else if (!target || !is_judged(*target))
        reader.refuse(position, "unknown-target", unknown_name_sentence("target", name, names));
}

Limits read_limits(Reader& reader, const Value& parent, std::string_view key,
                   std::string_view title, Limited what) {
    Limits limits;
    const Value& table = reader.table(parent, key);
    read_metrics(reader, table, title, "*", what, limits["*"]);
    for (const Member& member : table.members) {
        if (member.value.kind != Kind::Table) continue;
        check_target(reader, member.position, member.key);
        read_metrics(reader, member.value, title, member.key, what, limits[member.key]);
        for (const Member& inner : member.value.members)
            if (inner.value.kind == Kind::Table)
                reader.refuse(inner.position, "scene-type",
                              fmt::format("{} must be a number, and is a table", inner.key));
    }
    return limits;
}

Limits merged(const Limits& scene, const Limits& surface) {
    Limits all;
    const auto put = [](std::map<std::string, double>& into, const Limits& from,
                        const std::string& target) {
        const auto found = from.find(target);
        if (found == from.end()) return;
        for (const auto& [metric, value] : found->second) into[metric] = value;
    };
    for (const Limits* limits : {&scene, &surface})
        for (const auto& [target, unused] : *limits) all[target];
    for (auto& [target, into] : all) {
        put(into, scene, "*");
        if (target != "*") put(into, scene, target);
        put(into, surface, "*");
        if (target != "*") put(into, surface, target);
    }
    return all;
}

std::map<std::string, double> limits_on(const Limits& limits, const std::string& target) {
    std::map<std::string, double> on;
    for (const std::string& key : {std::string("*"), target}) {
        const auto found = limits.find(key);
        if (found == limits.end()) continue;
        for (const auto& [name, value] : found->second)
            if (const Metric* metric = measure::find_metric(name);
                metric && applies(*metric, target))
                on[name] = value;
    }
    return on;
}

}  // namespace intaglio::scene

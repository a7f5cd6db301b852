// Measurements to numbers under names, and their file.
#include "src/budget/observation.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/budget/observing.h"
#include "src/maps/files.h"
#include "src/measure/named_metric.h"
#include "src/report/command.h"
#include "src/variant/explain.h"

namespace intaglio::budget {
namespace {

using Json = nlohmann::ordered_json;
using measure::CaseResult;

constexpr std::size_t largest_file = std::size_t{64} << 20;

// Six digits: what files hold, so that a run that changes nothing differs by nothing.
double rounded(double value) { return std::stod(fmt::format("{:.6g}", value)); }

void add_case(Observation& into, const CaseResult& result, const std::string& command) {
    add_worst(into, "reads", result.reads_mean, "");
    add_hits(into, result.hits, "", command);
    if (result.narrow_hits.size() == measure::narrow_arithmetics.size()) {
        add_hits(into, result.narrow_hits[0], "_fp24", command);
        add_hits(into, result.narrow_hits[1], "_fp16", command);
    }
    into.values["invalid"] += static_cast<double>(result.hits.invalid + result.invalid_colours);
}

std::tuple<const std::string&, const std::string&, const std::string&> key(const Observation& o) {
    return std::tie(o.surface, o.target, o.settings);
}

Observation observation_of(const Json& json) {
    Observation made;
    made.surface = json.at("surface");
    made.target = json.at("target");
    made.settings = json.at("settings");
    if (json.contains("refusal")) made.refusal = json.at("refusal");
    for (const auto& [name, value] : json.at("metrics").items()) made.values[name] = value;
    if (json.contains("lines"))
        for (const auto& [name, value] : json.at("lines").items()) made.lines[name] = value;
    return made;
}

}  // namespace

void add_worst(Observation& into, const std::string& metric, double value,
               const std::string& command) {
    if (!std::isfinite(value)) return;
    const double number = rounded(value);
    const auto [place, is_new] = into.values.try_emplace(metric, number);
    if (!is_new && place->second >= number) return;
    place->second = number;
    if (!command.empty()) into.commands[metric] = command;
}

void add_hits(Observation& into, const measure::HitStatistics& hits, const std::string& suffix,
              const std::string& command) {
    const auto percent = [&](std::int64_t part) {
        return 100.0 * static_cast<double>(part) / static_cast<double>(hits.pixels);
    };
    // Without a valid pixel there is no error to speak of: unknown, which is never a pass.
    if (hits.pixels > hits.invalid) {
        add_worst(into, "p95" + suffix, hits.p95, command);
        add_worst(into, "missed" + suffix, percent(hits.missed), command);
    }
    if (!suffix.empty() || hits.pixels <= hits.invalid) return;
    add_worst(into, "median", hits.median, command);
    add_worst(into, "p99", hits.p99, command);
    add_worst(into, "height", hits.height_max, command);
    add_worst(into, "shadow_wrong", percent(hits.shadow_wrong), command);
}

void add_slots(Observation& into, const d3d9::Resources& used) {
    for (const auto& [metric, value] : measure::metrics_of(used))
        into.values[std::string(metric)] = value;
}

void add_spirv(Observation& into, const check::SpirvCost& cost) {
    into.values["spirv_alu"] = cost.alu;
    into.values["spirv_texture"] = cost.texture;
    into.values["spirv_branch"] = cost.branch;
    into.values["longest_path"] = static_cast<double>(cost.longest_path);
}

Status add_lines(Observation& into, const dsl::Catalogue& catalogue,
                 const VariantRequest& request) {
    const auto explained = explain_variant(catalogue, request);
    if (!explained) return explained.error();
    for (const d3d9::Spent& spent : explained->stages.front().explanation.lines) {
        const std::string place =
            spent.file.empty() ? "unknown line" : fmt::format("{}:{}", spent.file, spent.line);
        const std::string step = spent.step.empty() ? "outside steps" : spent.step;
        into.lines[fmt::format("{} at {}", step, place)] +=
            spent.slots.arithmetic + spent.slots.texture;
    }
    return Done{};
}

std::string Observation::name() const {
    return fmt::format("{}{}{} on {}", surface, settings.empty() ? "" : " ", settings, target);
}

bool operator<(const Observation& a, const Observation& b) { return key(a) < key(b); }

Result<std::vector<Observation>> observe(const dsl::Catalogue& catalogue,
                                         const scene::Measurement& scene,
                                         const std::function<void(int, int)>& progress) {
    std::vector<Observation> observations;
    std::vector<std::size_t> place;  // of each row that its target holds
    measure::Plan plan = scene.plan;
    plan.rounds = 0;
    plan.rows.clear();
    for (const VariantRequest& row : scene.plan.rows) {
        Observation observation{row.surface, row.target, report::settings_of(row), {}, {}, {}, {}};
        const auto variant = make_variant(catalogue, row);
        if (!variant) {
            if (!is_refusal(variant.error())) return variant.error();
            observation.refusal = variant.error().message;
        } else {
            if (Status status = add_lines(observation, catalogue, row); !status)
                return status.error();
            place.push_back(observations.size());
            plan.rows.push_back(row);
        }
        observations.push_back(std::move(observation));
    }
    if (!plan.rows.empty()) {
        const auto measured = measure::measure(catalogue, plan, progress);
        if (!measured) return measured.error();
        for (std::size_t row = 0; row < plan.rows.size(); ++row) {
            Observation& into = observations[place[row]];
            if (measured->slots[row])
                add_slots(into, *measured->slots[row]);
            else
                add_spirv(into, measured->costs[row]);
        }
        for (const CaseResult& result : measured->cases)
            add_case(observations[place[static_cast<std::size_t>(result.row)]], result,
                     report::run_command(plan, result, scene.map_arguments));
    }
    std::sort(observations.begin(), observations.end());
    return observations;
}

std::string to_lines(const std::vector<Observation>& observations) {
    std::vector<const Observation*> sorted;
    for (const Observation& observation : observations) sorted.push_back(&observation);
    std::sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) { return *a < *b; });
    std::string text;
    for (const Observation* o : sorted) {
        Json json = {{"surface", o->surface}, {"target", o->target}, {"settings", o->settings}};
        if (!o->refusal.empty()) json["refusal"] = o->refusal;
        json["metrics"] = o->values;
        if (!o->lines.empty()) json["lines"] = o->lines;
        text += json.dump() + "\n";
    }
    return text;
}

Result<std::vector<Observation>> read_lines(const std::filesystem::path& path) {
    const auto bytes = maps::read_file(path, largest_file);
    if (!bytes) return bytes.error();
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    std::vector<Observation> observations;
    int line = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view row = text.substr(at, end - at);
        at = end + 1;
        ++line;
        if (row.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        try {
            Observation made = observation_of(Json::parse(row));
            for (const Observation& other : observations)
                if (key(other) == key(made))
                    return input_error("baseline-duplicate",
                                       fmt::format("{} stands here twice", made.name()),
                                       path.string(), line, 1);
            observations.push_back(std::move(made));
        } catch (const nlohmann::json::exception&) {
            return input_error(
                "baseline-syntax",
                "this line is no variant with its metrics; `intaglio check --update` "
                "writes the file anew",
                path.string(), line, 1);
        }
    }
    return observations;
}

}  // namespace intaglio::budget

// The CSV form: one list of columns, each a name and how a case fills it.
#include <fmt/format.h>

#include "src/report/report.h"

namespace intaglio::report {
namespace {

using measure::CaseResult;
using measure::Measurement;
using measure::Plan;

// Everything a cell can come from.
struct Record {
    const Plan& plan;
    const Measurement& measurement;
    const MapArguments& map_arguments;
    const CaseResult& result;

    const VariantRequest& request() const {
        return plan.rows[static_cast<std::size_t>(result.row)];
    }
    const check::SpirvCost& cost() const {
        return measurement.costs[static_cast<std::size_t>(result.row)];
    }
    const measure::MapSet& map() const { return plan.maps[static_cast<std::size_t>(result.map)]; }
};

template <typename Number>
std::string text_of(Number number) {
    return fmt::format("{}", number);
}

// Of a case where some pixel reported a hit, else empty.
template <typename Number>
std::string of_hits(const Record& record, Number number) {
    return record.result.hits.pixels > record.result.hits.invalid ? text_of(number) : "";
}

std::string of_times(const Record& record, double number) {
    return record.result.nanoseconds > 0 ? text_of(number) : "";
}

// Of Direct3D 9 rows, else empty.
std::string of_slots(const Record& record, int d3d9::Resources::*which) {
    const auto& slots = record.measurement.slots[static_cast<std::size_t>(record.result.row)];
    return slots ? text_of((*slots).*which) : "";
}

// Errors in one of narrow_arithmetics, of Direct3D 9 rows.
std::string missed_in(const Record& record, std::size_t arithmetic) {
    if (arithmetic >= record.result.narrow_hits.size()) return "";
    return text_of(record.result.narrow_hits[arithmetic].missed);
}
std::string p95_in(const Record& record, std::size_t arithmetic) {
    if (arithmetic >= record.result.narrow_hits.size()) return "";
    const measure::HitStatistics& hits = record.result.narrow_hits[arithmetic];
    return hits.pixels > hits.invalid ? text_of(hits.p95) : "";
}

struct Column {
    const char* name;
    std::string (*cell)(const Record&);
};

constexpr Column columns[] = {
    {"version", [](const Record&) { return text_of(schema_version); }},
    {"map", [](const Record& r) { return r.map().name; }},
    {"map_width", [](const Record& r) { return text_of(r.map().heights.width); }},
    {"map_height", [](const Record& r) { return text_of(r.map().heights.height); }},
    {"view_elevation", [](const Record& r) { return text_of(r.result.view.elevation); }},
    {"view_azimuth", [](const Record& r) { return text_of(r.result.view.azimuth); }},
    {"light_elevation", [](const Record& r) { return text_of(r.result.light.elevation); }},
    {"light_azimuth", [](const Record& r) { return text_of(r.result.light.azimuth); }},
    {"row", [](const Record& r) { return text_of(r.result.row); }},
    {"surface", [](const Record& r) { return r.request().surface; }},
    {"target", [](const Record& r) { return r.request().target; }},
    {"asked", [](const Record& r) { return settings_of(r.request()); }},
    {"settings",
     [](const Record& r) {
         return fmt::format(
             "{}", fmt::join(r.measurement.settings[static_cast<std::size_t>(r.result.row)], "; "));
     }},
    {"scale", [](const Record& r) { return text_of(r.plan.scale); }},
    {"size", [](const Record& r) { return text_of(r.plan.size); }},
    {"filtering", [](const Record& r) { return std::string(name_of(r.plan.filtering)); }},
    {"spirv_alu", [](const Record& r) { return text_of(r.cost().alu); }},
    {"spirv_texture", [](const Record& r) { return text_of(r.cost().texture); }},
    {"spirv_branch", [](const Record& r) { return text_of(r.cost().branch); }},
    {"spirv_memory", [](const Record& r) { return text_of(r.cost().memory); }},
    {"spirv_total", [](const Record& r) { return text_of(r.cost().total); }},
    {"spirv_shortest_path", [](const Record& r) { return text_of(r.cost().shortest_path); }},
    {"spirv_longest_path", [](const Record& r) { return text_of(r.cost().longest_path); }},
    {"reads_mean", [](const Record& r) { return text_of(r.result.reads_mean); }},
    {"reads_max", [](const Record& r) { return text_of(r.result.reads_max); }},
    {"rounds", [](const Record& r) { return text_of(r.plan.rounds); }},
    {"nanoseconds_per_pixel", [](const Record& r) { return of_times(r, r.result.nanoseconds); }},
    {"time_ratio", [](const Record& r) { return of_times(r, r.result.ratio); }},
    {"time_ratio_low", [](const Record& r) { return of_times(r, r.result.ratio_low); }},
    {"time_ratio_high", [](const Record& r) { return of_times(r, r.result.ratio_high); }},
    {"pixels", [](const Record& r) { return text_of(r.result.hits.pixels); }},
    {"hit_median", [](const Record& r) { return of_hits(r, r.result.hits.median); }},
    {"hit_p95", [](const Record& r) { return of_hits(r, r.result.hits.p95); }},
    {"hit_p99", [](const Record& r) { return of_hits(r, r.result.hits.p99); }},
    {"hit_max", [](const Record& r) { return of_hits(r, r.result.hits.max); }},
    {"height_median", [](const Record& r) { return of_hits(r, r.result.hits.height_median); }},
    {"height_max", [](const Record& r) { return of_hits(r, r.result.hits.height_max); }},
    {"missed", [](const Record& r) { return text_of(r.result.hits.missed); }},
    {"far", [](const Record& r) { return text_of(r.result.hits.far); }},
    {"shadow_wrong", [](const Record& r) { return text_of(r.result.hits.shadow_wrong); }},
    {"invalid", [](const Record& r) { return text_of(r.result.hits.invalid); }},
    {"invalid_colours", [](const Record& r) { return text_of(r.result.invalid_colours); }},
    {"worst_x", [](const Record& r) { return of_hits(r, r.result.hits.worst_x); }},
    {"worst_y", [](const Record& r) { return of_hits(r, r.result.hits.worst_y); }},
    {"worst_u",
     [](const Record& r) { return of_hits(r, (r.result.hits.worst_x + 0.5) / r.plan.size); }},
    {"worst_v",
     [](const Record& r) { return of_hits(r, (r.result.hits.worst_y + 0.5) / r.plan.size); }},
    {"d3d9_arithmetic", [](const Record& r) { return of_slots(r, &d3d9::Resources::arithmetic); }},
    {"d3d9_texture", [](const Record& r) { return of_slots(r, &d3d9::Resources::texture); }},
    {"d3d9_temps", [](const Record& r) { return of_slots(r, &d3d9::Resources::temps); }},
    {"d3d9_level", [](const Record& r) { return of_slots(r, &d3d9::Resources::dependent_level); }},
    {"hit_p95_fp24", [](const Record& r) { return p95_in(r, 0); }},
    {"hit_p95_fp16", [](const Record& r) { return p95_in(r, 1); }},
    {"missed_fp24", [](const Record& r) { return missed_in(r, 0); }},
    {"missed_fp16", [](const Record& r) { return missed_in(r, 1); }},
    {"device", [](const Record& r) { return r.measurement.device; }},
    {"command", [](const Record& r) { return run_command(r.plan, r.result, r.map_arguments); }},
};

}  // namespace

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string to_csv(const Plan& plan, const Measurement& measurement,
                   const MapArguments& map_arguments) {
    std::string text;
    const auto add = [&](const std::string& field, bool last) {
        text += csv_field(field) + (last ? "\r\n" : ",");
    };
    for (const Column& column : columns) add(column.name, &column == std::end(columns) - 1);
    for (const CaseResult& result : measurement.cases)
        for (const Column& column : columns)
            add(column.cell({plan, measurement, map_arguments, result}),
                &column == std::end(columns) - 1);
    return text;
}

}  // namespace intaglio::report

// The JSON form.
#include <nlohmann/json.hpp>

#include "src/measure/variant_json.h"
#include "src/report/report.h"

namespace intaglio::report {
namespace {

using Json = nlohmann::ordered_json;
using measure::CaseResult;
using measure::Measurement;
using measure::Plan;

Json plan_of(const Plan& plan) {
    Json views = Json::array(), lights = Json::array();
    for (measure::Direction view : plan.views) views.push_back(json_of(view));
    for (measure::Direction light : plan.lights) lights.push_back(json_of(light));
    return {{"scale", plan.scale},   {"size", plan.size},
            {"rounds", plan.rounds}, {"filtering", name_of(plan.filtering)},
            {"device", plan.device}, {"views", views},
            {"lights", lights}};
}

Json maps_of(const Plan& plan) {
    Json maps = Json::array();
    for (const measure::MapSet& map : plan.maps)
        maps.push_back({{"name", map.name},
                        {"width", map.heights.width},
                        {"height", map.heights.height},
                        {"bits", map.heights.bits}});
    return maps;
}

Json row_of(const VariantRequest& request, const check::SpirvCost& cost,
            const std::optional<d3d9::Resources>& slots, const std::vector<std::string>& settings) {
    Json row = measure::json_of(request);
    row.update({{"settings", settings},
                {"spirv", measure::json_of(cost)},
                {"d3d9", measure::json_of(slots)}});
    return row;
}

Json hits_of(const measure::HitStatistics& hits, int size) {
    Json json = {{"pixels", hits.pixels},
                 {"missed", hits.missed},
                 {"far", hits.far},
                 {"invalid", hits.invalid},
                 {"shadow_wrong", hits.shadow_wrong}};
    const bool known = hits.pixels > hits.invalid;
    const auto put = [&](const char* name, double value) {
        json[name] = known ? Json(value) : Json();
    };
    put("median", hits.median);
    put("p95", hits.p95);
    put("p99", hits.p99);
    put("max", hits.max);
    put("height_median", hits.height_median);
    put("height_max", hits.height_max);
    json["worst"] = known ? Json{{"x", hits.worst_x},
                                 {"y", hits.worst_y},
                                 {"u", (hits.worst_x + 0.5) / size},
                                 {"v", (hits.worst_y + 0.5) / size}}
                          : Json();
    return json;
}

// Of a Direct3D 9 row, else null.
Json narrow_hits_of(const CaseResult& result, int size) {
    if (result.narrow_hits.size() != measure::narrow_arithmetics.size()) return {};
    return {{"fp24", hits_of(result.narrow_hits[0], size)},
            {"fp16", hits_of(result.narrow_hits[1], size)}};
}

Json case_of(const Plan& plan, const CaseResult& result, const MapArguments& map_arguments) {
    const bool timed = result.nanoseconds > 0;
    const std::string command = run_command(plan, result, map_arguments);
    return {{"map", plan.maps[static_cast<std::size_t>(result.map)].name},
            {"view", json_of(result.view)},
            {"light", json_of(result.light)},
            {"row", result.row},
            {"reads", {{"mean", result.reads_mean}, {"max", result.reads_max}}},
            {"time",
             {{"nanoseconds_per_pixel", timed ? Json(result.nanoseconds) : Json()},
              {"ratio", timed ? Json(result.ratio) : Json()},
              {"ratio_low", timed ? Json(result.ratio_low) : Json()},
              {"ratio_high", timed ? Json(result.ratio_high) : Json()}}},
            {"hits", hits_of(result.hits, plan.size)},
            {"narrow_hits", narrow_hits_of(result, plan.size)},
            {"invalid_colours", result.invalid_colours},
            {"command", command.empty() ? Json() : Json(command)}};
}

}  // namespace

std::string to_json(const Plan& plan, const Measurement& measurement,
                    const MapArguments& map_arguments) {
    Json rows = Json::array(), cases = Json::array();
    for (std::size_t row = 0; row < plan.rows.size(); ++row)
        rows.push_back(row_of(plan.rows[row], measurement.costs[row], measurement.slots[row],
                              measurement.settings[row]));
    for (const CaseResult& result : measurement.cases)
        cases.push_back(case_of(plan, result, map_arguments));
    const Json json = {
        {"schema", "intaglio.measurement"},
        {"version", schema_version},
        {"made_by",
         {{"spirv", "instructions of the shaded pixel stage after spirv-opt"},
          {"d3d9",
           "slots and registers of a ps_* row's shaded pixel stage by Direct3D's charge; its hits "
           "in fp32, narrow_hits in R300's s16e7 and with _pp everywhere"},
          {"reads", "counted on the run: search and shadow, per pixel"},
          {"time",
           "median of interleaved rounds on the device; ratio to the first row of the same map, "
           "view and light"},
          {"hits",
           "texels from the exact first hit, double precision reference; pixels without NaN"}}},
        {"device", measurement.device},
        {"plan", plan_of(plan)},
        {"maps", maps_of(plan)},
        {"rows", rows},
        {"cases", cases}};
    // File names need not be UTF-8; JSON must be.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace intaglio::report

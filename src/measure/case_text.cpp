// Lines and keys.
#include "src/measure/case_text.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "generator/ir/print.h"
#include "src/measure/command.h"
#include "src/measure/hash.h"
#include "src/measure/hits_request.h"
#include "src/measure/variant_json.h"

namespace intaglio::measure {
namespace {

using Json = nlohmann::ordered_json;

template <typename T>
Json json_of(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

Json cost_of(const CaseMetrics& metrics) {
    const Executed& executed = metrics.executed;
    return {{"d3d9", measure::json_of(metrics.slots)},
            {"spirv", measure::json_of(metrics.spirv)},
            {"reads_mean", executed.reads_mean},
            {"reads_max", executed.reads_max},
            {"instructions_mean", json_of(executed.instructions_mean)},
            {"instructions_max", json_of(executed.instructions_max)}};
}

Json pixel(int x, int y) { return Json::array({x, y}); }

// What is not known is null.
Json json_of(const HitStatistics& hits) {
    const bool known = hits.pixels > hits.invalid;
    const auto number = [&](double value) { return known ? Json(value) : Json(); };
    return {{"pixels", hits.pixels},
            {"median", number(hits.median)},
            {"p95", number(hits.p95)},
            {"p99", number(hits.p99)},
            {"max", number(hits.max)},
            {"max_at", known ? pixel(hits.worst_x, hits.worst_y) : Json()},
            {"height_median", number(hits.height_median)},
            {"height_max", number(hits.height_max)},
            {"missed", hits.missed},
            {"shadow_wrong", hits.shadow_wrong},
            {"invalid", hits.invalid}};
}

Json json_of(const Swim& swim) {
    if (swim.pixels == 0) return {};
    return {{"median", swim.median},
            {"p95", swim.p95},
            {"max", swim.max},
            {"max_at", pixel(swim.worst_x, swim.worst_y)}};
}

Json json_of(const PictureError& picture) {
    return {{"psnr", std::isfinite(picture.psnr) ? Json(picture.psnr) : Json()},
            {"flip_mean", picture.flip_mean},
            {"flip_p95", picture.flip_p95},
            {"flip_max", picture.flip_max},
            {"flip_max_at", pixel(picture.flip_worst_x, picture.flip_worst_y)},
            {"invalid", picture.invalid}};
}

Json json_of(const std::optional<ErrorSplit>& split) {
    if (!split || split->rays == 0) return {};
    return {{"rays", split->rays},
            {"invalid", split->invalid},
            {"total", split->total},
            {"technique", split->technique},
            {"filter", split->filter},
            {"arithmetic", split->arithmetic},
            {"interaction", split->interaction},
            {"technique_alone", split->technique_alone},
            {"filter_alone", split->filter_alone},
            {"arithmetic_alone", split->arithmetic_alone}};
}

Json json_of(const WorstPixel& worst, std::string command) {
    return {{"pixel", pixel(worst.x, worst.y)},
            {"texels", worst.texels},
            {"missed", worst.missed},
            {"uv", worst.uv},
            {"view", worst.view},
            {"exact", worst.exact},
            {"reported", worst.reported},
            {"command", std::move(command)}};
}

void add_metrics(Json& line, const Case& what, const CaseMap& map, const CaseMetrics& metrics,
                 const MeasuredOn& on) {
    if (metrics.refusal) {
        line["refused"] = {{"code", metrics.refusal->code}, {"sentence", metrics.refusal->message}};
        return;
    }
    const WorstPixel& worst = metrics.worst;
    line["refused"] = nullptr;
    line["made_by"] = name_of(metrics.maker);
    line["settings"] = metrics.settings;
    line["cost"] = cost_of(metrics);
    line["hits"] = json_of(metrics.hits);
    line["swim"] = json_of(metrics.swim);
    line["picture"] = json_of(metrics.picture);
    line["split"] = json_of(metrics.split);
    line["worst"] = json_of(worst, run_command(what, map.arguments, on.asked,
                                               {"--pixel", fmt::format("{},{}", worst.x, worst.y),
                                                "--error-map", "errors.png", "-o", "picture.png"}));
}

// The variant, view, light and so on: as a line says them.
Json inputs_of(const Case& what, const CaseMap& map, const MeasuredOn& on) {
    Json inputs = measure::json_of(what.request);
    if (!what.scene_surface.empty()) inputs["scene_surface"] = what.scene_surface;
    inputs.update({{"arithmetic", name_of(what.arithmetic)},
                   {"map",
                    {{"name", map.set.name},
                     {"class", map.map_class},
                     {"width", map.set.heights.width},
                     {"height", map.set.heights.height},
                     {"bits", map.set.heights.bits},
                     {"hash", map.hash},
                     {"arguments", map.arguments}}},
                   {"view", measure::json_of(what.view)},
                   {"light", measure::json_of(what.light)},
                   {"scale", what.scale},
                   {"size", what.size},
                   {"split_size", what.split_size},
                   {"filtering", name_of(what.filtering)},
                   {"device", on.device}});
    return inputs;
}

}  // namespace

Result<std::string> recorded_hash(const dsl::Catalogue& catalogue, const VariantRequest& request) {
    Hash hash;
    for (const VariantRequest& each : {request, hits_request(catalogue, request)}) {
        Result<Recorded> recorded = record_variant(catalogue, each);
        if (!recorded) {
            if (recorded.error().code == "target-limit") return std::string();
            return recorded.error();
        }
        for (ir::Module* module : {&recorded->program.vertex, &recorded->program.pixel}) {
            module->files.clear();  // wherever somebody's checkout lies
            hash.add(ir::print(*module));
        }
    }
    return hash.hex();
}

std::string key_of(const Case& what, const CaseMap& map, const std::string& recorded,
                   const MeasuredOn& on) {
    Hash hash;
    hash.add(fmt::format("{} {} {} {} {}\n", line_schema, source_id(), recorded,
                         text_of(what.request), on.asked));
    hash.add(inputs_of(what, map, on).dump());
    return hash.hex();
}

std::string line_of(const std::string& key, const Case& what, const CaseMap& map,
                    const CaseMetrics& metrics, const MeasuredOn& on) {
    Json line = {{"schema", line_schema}, {"key", key}};
    line.update(inputs_of(what, map, on));
    add_metrics(line, what, map, metrics, on);
    return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<std::string> key_in(std::string_view line) {
    const auto json = Json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("key") || !json["key"].is_string()) return {};
    return json["key"].get<std::string>();
}

bool is_refusal(std::string_view line) {
    const auto json = Json::parse(line, nullptr, false);
    return json.is_object() && json.contains("refused") && !json["refused"].is_null();
}

}  // namespace intaglio::measure

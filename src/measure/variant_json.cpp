// Members in the order in which a person reads them.
#include "src/measure/variant_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/measure/command.h"
#include "src/measure/named_metric.h"
#include "src/variant/known_text.h"

namespace intaglio::measure {

using Json = nlohmann::ordered_json;

Json json_of(const VariantRequest& request) {
    Json knobs = Json::object(), loops = Json::object();
    for (const auto& [knob, value] : request.knobs) knobs[knob] = value;
    for (const auto& [loop, form] : request.loop_forms) loops[loop] = word_of(form);
    Json json = {{"surface", request.surface},
                 {"target", request.target},
                 {"knobs", knobs},
                 {"loops", loops},
                 {"per_vertex", request.per_vertex}};
    if (!request.known.empty()) json["known"] = passes::to_strings(request.known);
    return json;
}

Result<VariantRequest> request_of(const Json& json) try {
    VariantRequest request;
    request.surface = json.at("surface");
    request.target = json.at("target");
    for (const auto& [knob, value] : json.at("knobs").items())
        request.knobs.emplace_back(knob,
                                   value.is_string() ? value.get<std::string>() : value.dump());
    const Json loops = json.value("loops", Json::object());
    for (const auto& [loop, word] : loops.items())
        request.loop_forms[loop] = form_of(word.get<std::string>());
    request.per_vertex = json.value("per_vertex", false);
    Result<passes::Known> known =
        known_in(json.value("known", Json::array()).get<std::vector<std::string>>());
    if (!known) return known.error();
    request.known = std::move(*known);
    return request;
} catch (const Json::exception& error) {
    return input_error("not-results", fmt::format("a member of a variant is missing or of another "
                                                  "kind: {}",
                                                  error.what()));
}

Json json_of(Direction direction) {
    return {{"elevation", direction.elevation}, {"azimuth", direction.azimuth}};
}

Json json_of(const check::SpirvCost& cost) {
    return {{"alu", cost.alu},
            {"texture", cost.texture},
            {"branch", cost.branch},
            {"memory", cost.memory},
            {"total", cost.total},
            {"shortest_path", cost.shortest_path},
            {"longest_path", cost.longest_path}};
}

Json json_of(const std::optional<d3d9::Resources>& slots) {
    if (!slots) return {};
    Json json = Json::object();
    for (const auto& [metric, value] : metrics_of(*slots)) json[std::string(metric)] = value;
    return json;
}

}  // namespace intaglio::measure

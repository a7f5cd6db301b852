// Members in the order in which a person reads them.
#include "src/measure/variant_json.h"

#include <nlohmann/json.hpp>

#include "src/measure/command.h"
#include "src/measure/named_metric.h"

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

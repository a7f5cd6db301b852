// Orders, trials and plans as JSON.  Floats are written with the fewest digits that read back as
// they were.
#include "src/plan/order.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/measure/command.h"
#include "src/plan/plan.h"
#include "src/plan/trial_text.h"

namespace intaglio::plan {
namespace {

using Json = nlohmann::ordered_json;

// Raised when a member goes or changes its meaning.
constexpr int order_schema = 1, plan_schema = 1;

// An end of a range that is open is null.
Json number(float value) {
    if (!std::isfinite(value)) return {};
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

float number(const Json& json, float open) { return json.is_null() ? open : json.get<float>(); }

Json json_of(const passes::Known& known) {
    Json json = {{"uniforms", Json::object()}, {"ranges", Json::object()}};
    for (const auto& [name, components] : known.uniforms) {
        Json& values = json["uniforms"][name] = Json::array();
        for (const float component : components) values.push_back(number(component));
    }
    for (const auto& [name, range] : known.ranges)
        json["ranges"][name] = {number(range.least), number(range.most)};
    return json;
}

passes::Known known_of(const Json& json) {
    constexpr float open = std::numeric_limits<float>::infinity();
    passes::Known known;
    for (const auto& [name, values] : json.at("uniforms").items())
        known.uniforms[name] = values.get<std::vector<float>>();
    for (const auto& [name, range] : json.at("ranges").items())
        known.ranges[name] = {number(range.at(0), -open), number(range.at(1), open)};
    return known;
}

Json json_of(const VariantRequest& request) {
    Json knobs = Json::array(), loops = Json::object();
    for (const auto& [knob, value] : request.knobs) knobs.push_back({knob, value});
    for (const auto& [loop, form] : request.loop_forms) loops[loop] = measure::word_of(form);
    return {{"surface", request.surface},
            {"target", request.target},
            {"knobs", knobs},
            {"loops", loops},
            {"per_vertex", request.per_vertex},
            {"count_reads", request.count_reads},
            {"split", dsl::to_string(request.split)},
            {"pass", request.pass},
            {"known", json_of(request.known)}};
}

VariantRequest request_of(const Json& json) {
    VariantRequest request;
    request.surface = json.at("surface");
    request.target = json.at("target");
    for (const Json& knob : json.at("knobs"))
        request.knobs.emplace_back(knob.at(0).get<std::string>(), knob.at(1).get<std::string>());
    for (const auto& [loop, word] : json.at("loops").items())
        request.loop_forms[loop] = measure::form_of(word.get<std::string>());
    request.per_vertex = json.at("per_vertex");
    request.count_reads = json.at("count_reads");
    request.pass = json.at("pass");
    request.known = known_of(json.at("known"));
    return request;
}

Json json_of(const std::vector<Figure>& figures) {
    Json json = Json::array();
    for (const Figure& each : figures)
        json.push_back({{"metric", each.metric},
                        {"value", std::isfinite(each.value) ? Json(each.value) : Json()},
                        {"maker", each.maker}});
    return json;
}

Json json_of(const Order& order) {
    Json maps = Json::array();
    for (const MapOrder& map : order.maps)
        maps.push_back({{"uniform", map.uniform}, {"kind", map.kind}, {"file", map.file}});
    return {{"schema", order_schema},
            {"surface", order.surface},
            {"request", json_of(order.request)},
            {"costs", json_of(order.costs)},
            {"errors", json_of(order.errors)},
            {"maps", maps},
            {"lights", order.lights}};
}

std::string dumped(const Json& json) {
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

template <typename T>
Json json_of(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

Json json_of(const Candidate& candidate) {
    return {{"variant", candidate.text},          {"request", json_of(candidate.request)},
            {"fate", name_of(candidate.fate)},    {"why", candidate.why},
            {"judged", candidate.judged},         {"cost", candidate.cost},
            {"operations", candidate.operations}, {"reads", candidate.reads},
            {"costs", candidate.costs},           {"errors", candidate.errors}};
}

Json json_of(const Dropped& dropped) {
    return {{"what", dropped.what},
            {"by", name_of(dropped.by)},
            {"why", dropped.why},
            {"cost_before", json_of(dropped.cost_before)},
            {"cost_after", json_of(dropped.cost_after)},
            {"error", dropped.error}};
}

Json json_of(const Choice& choice) {
    Json candidates = Json::array(), dropped = Json::array();
    for (const Candidate& each : choice.candidates) candidates.push_back(json_of(each));
    for (const Dropped& each : choice.dropped) dropped.push_back(json_of(each));
    return {{"surface", choice.surface},
            {"target", choice.target},
            {"chosen", json_of(choice.chosen)},
            {"best_that_fits", json_of(choice.best_that_fits)},
            {"cheapest_right", json_of(choice.cheapest_right)},
            {"order", choice.order ? json_of(*choice.order) : Json()},
            {"dropped", dropped},
            {"candidates", candidates}};
}

std::vector<Figure> figures_of(const Json& json) {
    std::vector<Figure> figures;
    for (const Json& each : json) {
        const Json& value = each.at("value");
        figures.push_back(
            {each.at("metric"),
             value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>(),
             each.at("maker")});
    }
    return figures;
}

Diagnostic syntax_error(const std::string& text, std::size_t byte, const std::string& file,
                        const std::string& why) {
    const std::size_t end = std::min(byte, text.size());
    const auto begin = text.begin();
    const auto here = begin + static_cast<std::ptrdiff_t>(end);
    const auto line = static_cast<int>(std::count(begin, here, '\n')) + 1;
    const std::size_t newline = text.substr(0, end).rfind('\n');
    const std::size_t column = newline == std::string::npos ? end : end - newline - 1;
    return input_error("order-syntax", "this is no order: " + why, file, line,
                       static_cast<int>(std::max<std::size_t>(column, 1)));
}

}  // namespace

std::string to_text(const Order& order) { return dumped(json_of(order)); }

Result<Order> read_order(const std::string& text, const std::string& file) {
    try {
        const Json json = Json::parse(text);
        if (json.at("schema") != order_schema)
            return input_error("order-syntax",
                               fmt::format("this order is of schema {}; this tool reads schema {}",
                                           json.at("schema").dump(), order_schema),
                               file, 1, 1);
        Order order;
        order.surface = json.at("surface");
        order.request = request_of(json.at("request"));
        const std::string split = json.at("request").at("split");
        if (!split.empty()) {
            const Result<dsl::Split> parsed = dsl::parse_split(split);
            if (!parsed) return syntax_error(text, 0, file, parsed.error().message);
            order.request.split = *parsed;
        }
        order.costs = figures_of(json.at("costs"));
        order.errors = figures_of(json.at("errors"));
        for (const Json& map : json.at("maps"))
            order.maps.push_back({map.at("uniform"), map.at("kind"), map.at("file")});
        order.lights = json.at("lights").get<std::vector<std::string>>();
        return order;
    } catch (const Json::parse_error& error) {
        return syntax_error(text, error.byte, file, "it is not JSON");
    } catch (const Json::exception&) {
        return syntax_error(text, 0, file,
                            "a member is missing or of another type; `intaglio plan --orders` "
                            "writes it anew");
    }
}

std::string to_text(const Plan& plan) {
    Json choices = Json::array();
    for (const Choice& choice : plan.choices) choices.push_back(json_of(choice));
    return dumped({{"schema", plan_schema},
                   {"scene", plan.scene},
                   {"satisfied", plan.is_satisfied()},
                   {"choices", choices}});
}

std::string to_text(const Trial& trial) {
    const Json json = {{"refusal", trial.refusal},       {"refusal_code", trial.refusal_code},
                       {"operations", trial.operations}, {"reads", trial.reads},
                       {"costs", trial.costs},           {"errors", trial.errors}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<Trial> read_trial(std::string_view text) {
    try {
        const Json json = Json::parse(text);
        Trial trial;
        trial.refusal = json.at("refusal");
        trial.refusal_code = json.at("refusal_code");
        trial.operations = json.at("operations");
        trial.reads = json.at("reads");
        trial.costs = json.at("costs").get<std::map<std::string, double>>();
        trial.errors = json.at("errors").get<std::map<std::string, double>>();
        return trial;
    } catch (const Json::exception&) {
        return {};
    }
}

}  // namespace intaglio::plan

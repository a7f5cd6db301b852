// A project's own limits on a page: what src/budget reads from its file, as plain numbers.
#include <algorithm>

#include <fmt/format.h>

#include "src/measure/named_metric.h"
#include "src/report/page_data.h"

namespace intaglio::report {
namespace {

using Json = nlohmann::ordered_json;

// Metrics that profiles limit too, as add_sources names them.
constexpr std::pair<std::string_view, std::string_view> resources[] = {
    {"arithmetic", "arithmetic slots"},
    {"texture", "texture slots"},
    {"total", "slots in total"},
    {"temps", "temporary registers"},
    {"constants", "float constants"},
    {"samplers", "samplers"},
    {"dependent_level", "dependent texture reads"}};

std::string resource_of(const std::string& metric) {
    for (const auto& [name, resource] : resources)
        if (name == metric) return std::string(resource);
    const measure::Metric* known = measure::find_metric(metric);
    return known == nullptr ? metric : fmt::format("{}, {}", metric, known->unit);
}

// Of one case; null where it has no such number.
Json of_case(const Json& item, const std::string& metric) {
    const Json& hits = item.at("hits");
    if (metric == "reads") return item.at("reads").at("mean");
    if (metric == "height") return hits.at("height_max");
    if (metric == "missed" || metric == "shadow_wrong")
        return 100 * hits.at(metric).get<double>() / hits.at("pixels").get<double>();
    return hits.contains(metric) ? hits.at(metric) : Json();
}

// The worst of the variant's cases, in fp32 where the metric's name does not end otherwise; null
// where nobody measured it.
Json worst_of(const Json& page, std::size_t variant, std::string metric) {
    std::string arithmetic = "fp32";
    for (const char* narrow : {"fp24", "fp16"})
        if (metric.ends_with(std::string("_") + narrow)) {
            arithmetic = narrow;
            metric.resize(metric.size() - 1 - arithmetic.size());
        }
    Json worst;
    for (const Json& item : page.at("cases")) {
        if (item.at("variant") != variant || item.value("arithmetic", "fp32") != arithmetic)
            continue;
        const Json value = of_case(item, metric);
        if (!value.is_null() && (worst.is_null() || value > worst)) worst = value;
    }
    return worst;
}

Json used_of(const Json& page, std::size_t variant, const std::string& metric) {
    const Json &row = page.at("variants")[variant], none;
    const auto member = [&](const char* part, const std::string& name) {
        const Json cost = row.value(part, Json());
        return cost.is_object() && cost.contains(name) ? cost.at(name) : Json();
    };
    const measure::Metric* known = measure::find_metric(metric);
    if (known == nullptr) return none;
    constexpr std::string_view spirv = "spirv_";
    if (known->of == measure::Metric::Of::Spirv)
        return member("spirv", metric.starts_with(spirv) ? metric.substr(spirv.size()) : metric);
    if (known->of == measure::Metric::Of::Direct3D9 && !known->is_error)
        return member("d3d9", metric);
    return worst_of(page, variant, metric);
}

}  // namespace

void add_limits(PageData& page, const std::vector<PageLimit>& limits, const std::string& file) {
    for (const PageLimit& limit : limits) {
        Json& rows = page.json["variants"][limit.variant]["resources"];
        if (rows.is_null()) rows = Json::array();
        const std::string resource = resource_of(limit.metric);
        auto row = std::find_if(rows.begin(), rows.end(),
                                [&](const Json& one) { return one.at("resource") == resource; });
        if (row == rows.end()) {
            rows.push_back({{"resource", resource},
                            {"used", used_of(page.json, limit.variant, limit.metric)}});
            row = std::prev(rows.end());
        }
        (*row)["limit"] = limit.max;
        (*row)["by"] = file;
    }
}

}  // namespace intaglio::report

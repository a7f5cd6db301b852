// From the tree of a budget file to rules.
#include "src/budget/budgets.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "generator/target/target.h"
#include "src/maps/files.h"
#include "src/measure/named_metric.h"
#include "src/scene/reader.h"
#include "src/variant/variant.h"

namespace intaglio::budget {
namespace {

using scene::Member;
using scene::Reader;
using scene::Value;

constexpr std::size_t largest_file = std::size_t{1} << 20;
constexpr double any = std::numeric_limits<double>::max();
constexpr std::string_view selecting[] = {"surface", "target", "settings"};

bool is_selecting(std::string_view key) {
    return std::find(std::begin(selecting), std::end(selecting), key) != std::end(selecting);
}

void check_target(Reader& reader, const Value& at, const std::string& name) {
    std::vector<std::string> names;
    for (const Target* target : all_targets()) names.emplace_back(target->name);
    if (std::find(names.begin(), names.end(), name) == names.end())
        reader.refuse(at.position, "unknown-target", unknown_name_sentence("target", name, names));
}

Selector read_selector(Reader& reader, const Value& table) {
    Selector selector{reader.text(table, "surface", ""), reader.text(table, "target", ""),
                      reader.text(table, "settings", "")};
    if (!selector.target.empty())
        check_target(reader, table.find("target")->value, selector.target);
    return selector;
}

// A limit on slots of a language that has none would never be looked at.
void check_applies(Reader& reader, const Member& member, const measure::Metric& metric,
                   const std::string& target_name) {
    if (target_name.empty() || metric.of == measure::Metric::Of::Both) return;
    const Target* target = find_target(target_name);
    if (!target) return;
    const bool direct3d = profile_of(*target).has_value();
    if (direct3d == (metric.of == measure::Metric::Of::Direct3D9)) return;
    reader.refuse(member.position, "budget-not-applicable",
                  fmt::format("{} has no {}: {}", target_name, metric.name, metric.about));
}

void read_rules(Reader& reader, const Value& table, std::string_view title,
                const Selector& selector, std::vector<Rule>& rules) {
    for (const Member& member : table.members) {
        if (is_selecting(member.key) && title == "[[variant]]") continue;
        const measure::Metric* metric = measure::find_metric(member.key);
        if (!metric) {
            reader.refuse(member.position, "budget-unknown-key",
                          unknown_name_sentence(fmt::format("metric in {}", title), member.key,
                                                measure::metric_names()));
            continue;
        }
        check_applies(reader, member, *metric, selector.target);
        const Value& bounds = reader.table(table, member.key);
        reader.check_keys(bounds, member.key, {"max", "max_delta"});
        if (bounds.members.empty() && member.value.kind == scene::Kind::Table)
            reader.refuse(member.position, "budget-missing",
                          fmt::format("{} needs a max or a max_delta", member.key));
        Bound bound;
        bound.line = member.position.line;
        if (bounds.find("max")) bound.max = reader.number(bounds, "max", 0, {-any, any});
        if (bounds.find("max_delta"))
            bound.max_delta = reader.number(bounds, "max_delta", 0, {0, any});
        rules.push_back({selector, member.key, bound});
    }
}

void read_waiver(Reader& reader, const Value& table, std::vector<Waiver>& waivers) {
    const bool known = reader.check_keys(
        table, "[[waiver]]", {"surface", "target", "settings", "metric", "reason", "until"});
    Waiver waiver{read_selector(reader, table), reader.text(table, "metric", ""),
                  reader.text(table, "reason", ""), reader.date(table, "until"),
                  table.position.line};
    if (!waiver.metric.empty() && !measure::find_metric(waiver.metric))
        reader.refuse(table.find("metric")->value.position, "budget-unknown-key",
                      unknown_name_sentence("metric", waiver.metric, measure::metric_names()));
    for (const char* key : {"reason", "until"})
        if (known &&
            (!table.find(key) || (std::string_view(key) == "reason" && waiver.reason.empty())))
            reader.refuse(table.position, "budget-missing",
                          fmt::format("a [[waiver]] needs {}", key));
    const Selector& selector = waiver.selector;
    if (known && selector.surface.empty() && selector.target.empty() && selector.settings.empty() &&
        waiver.metric.empty())
        reader.refuse(table.position, "budget-missing",
                      "a [[waiver]] needs a surface, target, settings or metric: it would forgive "
                      "everything");
    waivers.push_back(std::move(waiver));
}

std::filesystem::path read_path(Reader& reader, const Value& document, std::string_view key,
                                const std::filesystem::path& folder) {
    const Member* member = document.find(key);
    const std::string text = reader.text(document, key, "");
    if (member && text.empty())
        reader.refuse(member->value.position, "budget-empty", fmt::format("{} names no file", key));
    return folder / text;
}

}  // namespace

bool Selector::matches(const std::string& of_surface, const std::string& on_target,
                       const std::string& with_settings) const {
    return (surface.empty() || surface == of_surface) && (target.empty() || target == on_target) &&
           (settings.empty() || settings == with_settings);
}

std::optional<Bound> Budgets::bound(const std::string& surface, const std::string& target,
                                    const std::string& settings, std::string_view metric) const {
    std::optional<Bound> found;
    for (const Rule& rule : rules) {
        if (rule.metric != metric || !rule.selector.matches(surface, target, settings)) continue;
        if (!found) found.emplace();
        if (rule.bound.max) found->max = rule.bound.max;
        if (rule.bound.max_delta) found->max_delta = rule.bound.max_delta;
        found->line = rule.bound.line;
    }
    return found;
}

Result<Budgets> read_budgets(const std::filesystem::path& path) {
    const auto bytes = maps::read_file(path, largest_file);
    if (!bytes) return bytes.error();
    auto document = scene::parse_toml({reinterpret_cast<const char*>(bytes->data()), bytes->size()},
                                      path.string());
    if (!document) {
        Diagnostic error = document.error();
        error.code = "budget-syntax";
        return error;
    }
    Reader reader(path.string(), "budget");
    reader.check_keys(*document, "the budgets",
                      {"scene", "baseline", "limits", "target", "surface", "variant", "waiver"});
    Budgets budgets;
    budgets.file = path.string();
    const std::filesystem::path folder = path.parent_path();
    budgets.scene = read_path(reader, *document, "scene", folder);
    if (document->find("baseline"))
        budgets.baseline = read_path(reader, *document, "baseline", folder);
    read_rules(reader, reader.table(*document, "limits"), "[limits]", {}, budgets.rules);
    for (const Member& member : reader.table(*document, "target").members) {
        check_target(reader, member.value, member.key);
        read_rules(reader, reader.table(reader.table(*document, "target"), member.key),
                   fmt::format("[target.{}]", member.key), {"", member.key, ""}, budgets.rules);
    }
    for (const Member& member : reader.table(*document, "surface").members)
        read_rules(reader, reader.table(reader.table(*document, "surface"), member.key),
                   fmt::format("[surface.{}]", member.key), {member.key, "", ""}, budgets.rules);
    for (const Value* table : reader.tables(*document, "variant"))
        read_rules(reader, *table, "[[variant]]", read_selector(reader, *table), budgets.rules);
    for (const Value* table : reader.tables(*document, "waiver"))
        read_waiver(reader, *table, budgets.waivers);
    if (reader.error()) return *reader.error();
    if (!document->find("scene"))
        return input_error("budget-missing", "the budgets name no scene", path.string(), 1, 1);
    if (budgets.rules.empty())
        return input_error("budget-missing", "the budgets limit nothing", path.string(), 1, 1);
    return budgets;
}

}  // namespace intaglio::budget

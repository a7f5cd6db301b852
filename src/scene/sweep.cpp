// From the tree of a sweep file to its cases.
#include "src/scene/sweep.h"

#include <fmt/format.h>

#include "src/scene/parts.h"

namespace intaglio::scene {
namespace {

// A sweep that nobody would wait for.
constexpr std::size_t most_cases = 1000000;

// What [relief], [views], [lights] and [run] say.
struct Axes {
    std::vector<double> scales;
    measure::Filtering filtering = measure::Filtering::Float;
    std::vector<measure::Direction> views, lights;
    int size = 128, split = 31;
    std::vector<measure::Arithmetic> arithmetics = {measure::Arithmetic::Fp32};
    std::string device;
};

std::vector<measure::Arithmetic> read_arithmetics(Reader& reader, const Value& table,
                                                  std::vector<measure::Arithmetic> fallback) {
    const Member* member = table.find("arithmetics");
    if (member == nullptr) return fallback;
    std::vector<measure::Arithmetic> arithmetics;
    for (const std::string& name : reader.texts(table, "arithmetics")) {
        const Result<measure::Arithmetic> arithmetic = measure::arithmetic_named(name);
        if (arithmetic)
            arithmetics.push_back(*arithmetic);
        else
            reader.refuse(member->value.position, arithmetic.error().code,
                          arithmetic.error().message);
    }
    return arithmetics;
}

// 0 or a power of two between the bounds.
int read_side(Reader& reader, const Value& table, std::string_view key, int fallback, Range range) {
    const int side = static_cast<int>(reader.whole(table, key, fallback, range));
    if (side > 0 && (side & (side - 1)) != 0)
        reader.refuse(table.find(key)->value.position, "scene-range",
                      fmt::format("{} is {}, and must be a power of two", key, side));
    return side;
}

Axes read_axes(Reader& reader, const Value& document) {
    Axes axes;
    const Value& relief = reader.table(document, "relief");
    reader.check_keys(relief, "[relief]", {"scale", "filtering"});
    axes.scales = reader.numbers(relief, "scale", {0.08}, {0, 1});
    axes.filtering = reader.choice(relief, "filtering", 0, {"float", "native"}) == 0
                         ? measure::Filtering::Float
                         : measure::Filtering::Native;
    axes.views = read_directions(reader, document, "views", {90, 60, 45, 30, 15}, {20});
    axes.lights = read_directions(reader, document, "lights", {45}, {135});
    const Value& run = reader.table(document, "run");
    reader.check_keys(run, "[run]", {"size", "split", "rounds", "arithmetics", "device"});
    axes.size = read_side(reader, run, "size", axes.size, {8, 2048});
    axes.split = static_cast<int>(reader.whole(run, "split", axes.split, {0, 2048}));
    reader.whole(run, "rounds", 0, {0, 1000});
    axes.arithmetics = read_arithmetics(reader, run, axes.arithmetics);
    axes.device = reader.text(run, "device", "");
    return axes;
}

// A variant's rows share their arithmetics.
struct Row {
    measure::SweepRow row;
    std::vector<measure::Arithmetic> arithmetics;
};

std::vector<Row> read_rows(Reader& reader, const Value& document, const Axes& axes,
                           const std::string& file) {
    std::vector<Row> rows;
    std::vector<VariantRequest> requests;
    for (const Value* table : reader.tables(document, "variant")) {
        const std::size_t before = requests.size();
        read_variant(reader, *table, requests);
        const auto arithmetics = read_arithmetics(reader, *table, axes.arithmetics);
        for (std::size_t i = before; i < requests.size(); ++i)
            rows.push_back(
                {{requests[i], file, table->position.line, table->position.column}, arithmetics});
    }
    return rows;
}

// Each map at each scale: normals that are baked depend on it.
Status load_maps(const std::vector<MapEntry>& entries, const Axes& axes,
                 const std::filesystem::path& path, measure::SweepPlan& plan) {
    const std::string file = path.string();
    for (double scale : axes.scales) {
        const std::size_t first = plan.maps.size();
        for (const MapEntry& entry : entries) {
            Result<measure::CaseMap> map = load_case_map(entry, scale, path.parent_path());
            if (!map) return placed(map.error(), file, entry.position);
            const std::string& name = map->set.name;
            for (std::size_t i = first; i < plan.maps.size(); ++i)
                if (plan.maps[i].set.name == name)
                    return input_error(
                        "scene-duplicate",
                        fmt::format("two maps are called '{}': give one another name", name), file,
                        entry.position.line, entry.position.column);
            plan.maps.push_back(std::move(*map));
        }
    }
    return Done{};
}

void add_cases(const Axes& axes, const std::vector<Row>& rows, measure::SweepPlan& plan) {
    const std::size_t maps = plan.maps.size() / axes.scales.size();
    for (std::size_t map = 0; map < plan.maps.size(); ++map)
        for (std::size_t row = 0; row < rows.size(); ++row)
            for (measure::Arithmetic arithmetic : rows[row].arithmetics)
                for (measure::Direction view : axes.views)
                    for (measure::Direction light : axes.lights)
                        plan.cases.push_back(
                            {row, map,
                             measure::Case{rows[row].row.request, view, light,
                                           axes.scales[map / maps], axes.size, axes.filtering,
                                           arithmetic, axes.split}});
}

}  // namespace

Result<measure::SweepPlan> read_sweep(const std::filesystem::path& path) {
    const Result<Value> document = read_document(path);
    if (!document) return document.error();
    const std::string file = path.string();
    Reader reader(file);
    reader.check_keys(*document, "the sweep",
                      {"relief", "views", "lights", "run", "map", "variant"});
    const Axes axes = read_axes(reader, *document);
    const std::vector<MapEntry> entries = read_maps(reader, *document, path.parent_path());
    const std::vector<Row> rows = read_rows(reader, *document, axes, file);
    if (reader.error()) return *reader.error();
    if (entries.empty())
        return input_error("scene-missing", "the sweep has no [[map]]", file, 1, 1);
    if (rows.empty())
        return input_error("scene-missing", "the sweep has no [[variant]]", file, 1, 1);
    std::size_t cases = 0;
    for (const Row& row : rows) cases += row.arithmetics.size();
    cases *= axes.scales.size() * entries.size() * axes.views.size() * axes.lights.size();
    if (cases > most_cases)
        return input_error("scene-range",
                           fmt::format("the sweep has {} cases, more than {}", cases, most_cases),
                           file, 1, 1);

    measure::SweepPlan plan;
    plan.device = axes.device;
    if (Status status = load_maps(entries, axes, path, plan); !status) return status.error();
    for (const Row& row : rows) plan.rows.push_back(row.row);
    add_cases(axes, rows, plan);
    return plan;
}

}  // namespace intaglio::scene

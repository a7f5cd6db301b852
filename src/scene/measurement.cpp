// From the tree of a scene file to a plan: first every word is checked, then the maps are loaded.
#include "src/scene/measurement.h"

#include <fmt/format.h>

#include "src/scene/parts.h"

namespace intaglio::scene {
namespace {

void read_relief(Reader& reader, const Value& document, measure::Plan& plan) {
    const Value& table = reader.table(document, "relief");
    reader.check_keys(table, "[relief]", {"scale", "filtering"});
    plan.scale = reader.number(table, "scale", plan.scale, {0, 1});
    plan.filtering = reader.choice(table, "filtering", 0, {"float", "native"}) == 0
                         ? measure::Filtering::Float
                         : measure::Filtering::Native;
}

void read_run(Reader& reader, const Value& document, measure::Plan& plan) {
    const Value& table = reader.table(document, "run");
    reader.check_keys(table, "[run]", {"size", "rounds", "device"});
    plan.size = static_cast<int>(reader.whole(table, "size", plan.size, {8, 2048}));
    if (plan.size <= 0 || (plan.size & (plan.size - 1)) != 0)
        reader.refuse(table.find("size")->value.position, "scene-range",
                      fmt::format("size is {}, and must be a power of two", plan.size));
    plan.rounds = static_cast<int>(reader.whole(table, "rounds", plan.rounds, {0, 1000}));
    plan.device = reader.text(table, "device", plan.device);
}

Status load_maps(const std::vector<MapEntry>& entries, const std::string& file,
                 Measurement& scene) {
    for (const MapEntry& entry : entries) {
        Result<measure::MapSet> set = load_map(entry, scene.plan.scale);
        if (!set) return placed(set.error(), file, entry.position);
        for (const measure::MapSet& other : scene.plan.maps)
            if (other.name == set->name)
                return input_error(
                    "scene-duplicate",
                    fmt::format("two maps are called '{}': give one another name", set->name), file,
                    entry.position.line, entry.position.column);
        scene.plan.maps.push_back(std::move(*set));
        scene.map_arguments.push_back(arguments_of(entry));
        add_inputs(entry, scene.inputs);
    }
    return Done{};
}

}  // namespace

Result<Measurement> read_measurement_with_sources(const std::filesystem::path& path,
                                                  const std::optional<measure::MapFiles>& own_map) {
    const Result<Value> document = read_document(path);
    if (!document) return document.error();
    const std::string file = path.string();
    Reader reader(file);
    reader.check_keys(*document, "the scene",
                      {"relief", "views", "lights", "run", "map", "variant"});
    Measurement scene;
    scene.inputs.push_back(path);
    measure::Plan& plan = scene.plan;
    read_relief(reader, *document, plan);
    plan.views = read_directions(reader, *document, "views", {90, 60, 45, 30, 15}, {20});
    plan.lights = read_directions(reader, *document, "lights", {45}, {135});
    read_run(reader, *document, plan);
    const std::vector<MapEntry> entries = read_maps(reader, *document, path.parent_path());
    for (const Value* table : reader.tables(*document, "variant"))
        read_variant(reader, *table, plan.rows);
    if (reader.error()) return *reader.error();
    if (entries.empty() && !own_map)
        return input_error("scene-missing", "the scene has no [[map]]", file, 1, 1);
    if (plan.rows.empty())
        return input_error("scene-missing", "the scene has no [[variant]]", file, 1, 1);

    if (!own_map) {
        if (Status status = load_maps(entries, file, scene); !status) return status.error();
        return scene;
    }
    Result<measure::MapSet> set = measure::load_map_set(*own_map, plan.scale);
    if (!set) return set.error();
    plan.maps.push_back(std::move(*set));
    scene.map_arguments.push_back(arguments_of(*own_map));
    return scene;
}

Result<measure::Plan> read_measurement(const std::filesystem::path& path,
                                       const std::optional<measure::MapFiles>& own_map) {
    Result<Measurement> scene = read_measurement_with_sources(path, own_map);
    if (!scene) return scene.error();
    return std::move(scene->plan);
}

}  // namespace intaglio::scene

// From the tree of a scene file to a plan: first every word is checked, then the maps are loaded.
#include "src/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "generator/base/nearest.h"
#include "src/maps/files.h"
#include "src/maps/makers.h"
#include "src/scene/reader.h"

namespace intaglio::scene {
namespace {

constexpr std::size_t largest_file = std::size_t{1} << 20;
// More rows than anyone reads; a sweep of three long lists would reach it by mistake.
constexpr std::size_t most_rows = 4096;

// Bounds are inclusive, and an elevation lies above -90.
constexpr Range elevation_range{-89.999999, 90};
constexpr Range azimuth_range{-360, 360};

// A map as the file describes it.
struct MapEntry {
    Position position;
    std::string name;  // empty: what loading gives it
    std::string maker;
    std::int64_t width = 256, height = 256, seed = 1;
    std::optional<measure::MapFiles> files;
};

std::vector<measure::Direction> read_directions(Reader& reader, const Value& document,
                                                std::string_view key,
                                                std::vector<double> elevations,
                                                std::vector<double> azimuths) {
    const Value& table = reader.table(document, key);
    reader.check_keys(table, fmt::format("[{}]", key), {"elevations", "azimuths"});
    elevations = reader.numbers(table, "elevations", std::move(elevations), elevation_range);
    azimuths = reader.numbers(table, "azimuths", std::move(azimuths), azimuth_range);
    std::vector<measure::Direction> directions;
    for (double elevation : elevations) {
        for (double azimuth : azimuths) {
            directions.push_back({elevation, azimuth});
            if (elevation == 90) break;
        }
    }
    return directions;
}

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

std::optional<std::filesystem::path> read_path(Reader& reader, const Value& table,
                                               std::string_view key,
                                               const std::filesystem::path& folder) {
    const Member* member = table.find(key);
    if (!member) return std::nullopt;
    const std::string text = reader.text(table, key, "");
    if (text.empty() && member->value.kind == Kind::String)
        reader.refuse(member->value.position, "scene-empty", fmt::format("{} names no file", key));
    return folder / text;
}

void check_maker(Reader& reader, const Value& table, const std::string& maker) {
    std::vector<std::string> names;
    for (const maps::Maker& known : maps::makers()) names.emplace_back(known.name);
    const Value& value = table.find("maker")->value;
    if (value.kind == Kind::String && std::find(names.begin(), names.end(), maker) == names.end())
        reader.refuse(value.position, "unknown-map", unknown_name_sentence("maker", maker, names));
}

MapEntry read_map(Reader& reader, const Value& table, const std::filesystem::path& folder) {
    const bool known = reader.check_keys(
        table, "[[map]]",
        {"name", "maker", "width", "height", "seed", "height_map", "normal_map", "colour_map"});
    MapEntry entry;
    entry.position = table.position;
    entry.name = reader.text(table, "name", "");
    const bool made = table.find("maker") != nullptr;
    for (const char* key : {"width", "height", "seed"})
        if (const Member* member = table.find(key); member && !made)
            reader.refuse(member->position, "scene-conflict",
                          fmt::format("{} is for procedural maps, which name a maker", key));
    for (const char* key : {"height_map", "normal_map", "colour_map"})
        if (const Member* member = table.find(key); member && made)
            reader.refuse(member->position, "scene-conflict",
                          fmt::format("a map has either a maker or a {}, not both", key));
    if (made) {
        entry.maker = reader.text(table, "maker", "");
        check_maker(reader, table, entry.maker);
        const Range side{1, maps::largest_side};
        entry.width = reader.whole(table, "width", entry.width, side);
        entry.height = reader.whole(table, "height", entry.width, side);
        entry.seed =
            reader.whole(table, "seed", entry.seed, {0, std::numeric_limits<std::uint32_t>::max()});
        return entry;
    }
    const auto height = read_path(reader, table, "height_map", folder);
    if (!height && known)
        reader.refuse(table.position, "scene-missing",
                      "a [[map]] needs a maker (procedural) or a height_map (a PNG file)");
    entry.files =
        measure::MapFiles{height.value_or(""), read_path(reader, table, "normal_map", folder),
                          read_path(reader, table, "colour_map", folder)};
    return entry;
}

std::vector<MapEntry> read_maps(Reader& reader, const Value& document,
                                const std::filesystem::path& folder) {
    std::vector<MapEntry> entries;
    for (const Value* table : reader.tables(document, "map"))
        entries.push_back(read_map(reader, *table, folder));
    return entries;
}

// A knob and the values it takes, as written: 8 stays 8, 0.50 becomes 0.5.
struct Sweep {
    std::string knob;
    std::vector<std::string> values;
};

std::vector<Sweep> read_knobs(Reader& reader, const Value& variant) {
    constexpr double most = std::numeric_limits<double>::max();
    const Value& table = reader.table(variant, "knobs");
    std::vector<Sweep> sweeps;
    for (const Member& member : table.members) {
        Sweep sweep{member.key, {}};
        for (double value : reader.numbers(table, member.key, {}, {-most, most}))
            sweep.values.push_back(fmt::format("{}", value));
        sweeps.push_back(std::move(sweep));
    }
    return sweeps;
}

std::map<std::string, ir::LoopForm> read_loops(Reader& reader, const Value& variant) {
    const Value& table = reader.table(variant, "loops");
    std::map<std::string, ir::LoopForm> forms;
    for (const Member& member : table.members)
        forms[member.key] = reader.choice(table, member.key, 0, {"loop", "unroll"}) == 0
                                ? ir::LoopForm::Rolled
                                : ir::LoopForm::Unrolled;
    return forms;
}

// Every combination of the knobs' values, the first knob slowest.
std::vector<VariantRequest> combinations(const VariantRequest& variant,
                                         const std::vector<Sweep>& sweeps) {
    std::vector<VariantRequest> rows{variant};
    for (const Sweep& sweep : sweeps) {
        std::vector<VariantRequest> longer;
        for (const VariantRequest& row : rows) {
            for (const std::string& value : sweep.values) {
                longer.push_back(row);
                longer.back().knobs.emplace_back(sweep.knob, value);
            }
        }
        rows = std::move(longer);
    }
    return rows;
}

void read_variant(Reader& reader, const Value& table, std::vector<VariantRequest>& rows) {
    const bool known = reader.check_keys(table, "[[variant]]",
                                         {"surface", "targets", "knobs", "loops", "per_vertex"});
    for (const char* key : {"surface", "targets"})
        if (known && !table.find(key))
            reader.refuse(table.position, "scene-missing",
                          fmt::format("a [[variant]] needs {}", key));
    VariantRequest variant;
    variant.surface = reader.text(table, "surface", "");
    if (const Member* member = table.find("surface");
        member && member->value.kind == Kind::String && member->value.text.empty())
        reader.refuse(member->value.position, "scene-empty", "surface names nothing");
    variant.loop_forms = read_loops(reader, table);
    variant.per_vertex = reader.boolean(table, "per_vertex", false);
    const std::vector<std::string> targets = reader.texts(table, "targets");
    const std::vector<Sweep> sweeps = read_knobs(reader, table);

    std::size_t count = targets.size();
    for (const Sweep& sweep : sweeps) count = std::min(most_rows + 1, count * sweep.values.size());
    if (rows.size() + count > most_rows) {
        reader.refuse(table.position, "scene-range",
                      fmt::format("the variants have more than {} combinations", most_rows));
        return;
    }
    for (VariantRequest& row : combinations(variant, sweeps)) {
        for (const std::string& target : targets) {
            row.target = target;
            rows.push_back(row);
        }
    }
}

std::vector<std::string> arguments_of(const measure::MapFiles& files) {
    std::vector<std::string> arguments{"--height", files.height.string()};
    if (files.normal) arguments.insert(arguments.end(), {"--normal", files.normal->string()});
    if (files.colour) arguments.insert(arguments.end(), {"--colour", files.colour->string()});
    return arguments;
}

std::vector<std::string> arguments_of(const MapEntry& entry) {
    if (entry.files) return arguments_of(*entry.files);
    std::vector<std::string> arguments{"--maker", entry.maker, "--map-size",
                                       fmt::format("{}x{}", entry.width, entry.height)};
    if (entry.seed != 1)
        arguments.insert(arguments.end(), {"--seed", fmt::format("{}", entry.seed)});
    return arguments;
}

// An error of loading points at the scene: with its own place where it has none, else in a note.
Diagnostic placed(Diagnostic error, const std::string& scene, Position position) {
    if (error.file.empty()) {
        error.file = scene;
        error.line = position.line;
        error.column = position.column;
    } else {
        error.notes.push_back(
            fmt::format("note: named in {}:{}:{}", scene, position.line, position.column));
    }
    return error;
}

Status load_maps(const std::vector<MapEntry>& entries, const std::string& file, Scene& scene) {
    for (const MapEntry& entry : entries) {
        Result<measure::MapSet> set =
            entry.files ? measure::load_map_set(*entry.files, scene.plan.scale)
                        : measure::make_map_set(entry.maker, static_cast<int>(entry.width),
                                                static_cast<int>(entry.height), scene.plan.scale,
                                                static_cast<std::uint32_t>(entry.seed));
        if (!set) return placed(set.error(), file, entry.position);
        if (!entry.name.empty()) set->name = entry.name;
        for (const measure::MapSet& other : scene.plan.maps)
            if (other.name == set->name)
                return input_error(
                    "scene-duplicate",
                    fmt::format("two maps are called '{}': give one another name", set->name), file,
                    entry.position.line, entry.position.column);
        scene.plan.maps.push_back(std::move(*set));
        scene.map_arguments.push_back(arguments_of(entry));
    }
    return Done{};
}

Result<Value> read_document(const std::filesystem::path& path) {
    const Result<std::vector<unsigned char>> bytes = maps::read_file(path, largest_file);
    if (!bytes) return bytes.error();
    return parse_toml({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path.string());
}

}  // namespace

Result<Scene> read_scene_with_sources(const std::filesystem::path& path,
                                      const std::optional<measure::MapFiles>& own_map) {
    const Result<Value> document = read_document(path);
    if (!document) return document.error();
    const std::string file = path.string();
    Reader reader(file);
    reader.check_keys(*document, "the scene",
                      {"relief", "views", "lights", "run", "map", "variant"});
    Scene scene;
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

Result<measure::Plan> read_scene(const std::filesystem::path& path,
                                 const std::optional<measure::MapFiles>& own_map) {
    Result<Scene> scene = read_scene_with_sources(path, own_map);
    if (!scene) return scene.error();
    return std::move(scene->plan);
}

}  // namespace intaglio::scene

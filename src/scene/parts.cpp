// The pieces of scene files that sweeps have too.
#include "src/scene/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "generator/base/nearest.h"
#include "src/maps/files.h"
#include "src/maps/makers.h"
#include "src/measure/baked_maps.h"

namespace intaglio::scene {
namespace {

constexpr std::size_t largest_file = std::size_t{1} << 20;
// More rows than anyone reads; a sweep of three long lists would reach it by mistake.
constexpr std::size_t most_rows = 4096;

// Bounds are inclusive, and an elevation lies above -90.
constexpr Range elevation_range{-89.999999, 90};
constexpr Range azimuth_range{-360, 360};

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

std::map<std::string, std::filesystem::path> read_baked(Reader& reader, const Value& map,
                                                        const std::filesystem::path& folder) {
    const Value& table = reader.table(map, "baked");
    std::map<std::string, std::filesystem::path> files;
    for (const Member& member : table.members) {
        if (const auto kind = measure::wanted_bake(member.key, "", "");
            !kind && member.key != "normal")
            reader.refuse(member.position, kind.error().code, kind.error().message);
        if (const auto path = read_path(reader, table, member.key, folder))
            files[member.key] = *path;
    }
    if (const Member* normal = map.find("normal_map"); normal && files.contains("normal"))
        reader.refuse(normal->position, "scene-conflict",
                      "a map has either a normal_map or a baked normal, not both");
    return files;
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

// Of baked maps only normals, which a file rounds; the others are the same when they are baked
// again.
void add_normal(const std::map<std::string, std::filesystem::path>& baked,
                std::vector<std::string>& arguments) {
    if (const auto normal = baked.find("normal"); normal != baked.end())
        arguments.insert(arguments.end(), {"--baked", "normal=" + normal->second.string()});
}

// The map's files as the file that names them wrote them, whatever folder it was read from.
std::vector<std::string> arguments_in(MapEntry entry, const std::filesystem::path& folder) {
    const auto as_written = [&](std::filesystem::path& file) {
        const std::filesystem::path written = file.lexically_relative(folder);
        if (!written.empty()) file = written;
    };
    if (entry.files) {
        as_written(entry.files->height);
        if (entry.files->normal) as_written(*entry.files->normal);
        if (entry.files->colour) as_written(*entry.files->colour);
    }
    for (auto& [kind, file] : entry.baked) as_written(file);
    return arguments_of(entry);
}

}  // namespace

std::map<std::string, ir::LoopForm> read_loops(Reader& reader, const Value& variant) {
    const Value& table = reader.table(variant, "loops");
    std::map<std::string, ir::LoopForm> forms;
    for (const Member& member : table.members)
        forms[member.key] = reader.choice(table, member.key, 0, {"loop", "unroll"}) == 0
                                ? ir::LoopForm::Rolled
                                : ir::LoopForm::Unrolled;
    return forms;
}

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

MapEntry read_map_entry(Reader& reader, const Value& table, std::string_view title, bool known,
                        const std::filesystem::path& folder) {
    MapEntry entry;
    entry.position = table.position;
    entry.baked = read_baked(reader, table, folder);
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
        reader.refuse(
            table.position, "scene-missing",
            fmt::format("a {} needs a maker (procedural) or a height_map (a PNG file)", title));
    entry.files = measure::MapFiles{height.value_or(""),
                                    read_path(reader, table, "normal_map", folder),
                                    read_path(reader, table, "colour_map", folder),
                                    {}};
    return entry;
}

std::vector<MapEntry> read_maps(Reader& reader, const Value& document,
                                const std::filesystem::path& folder) {
    std::vector<MapEntry> entries;
    for (const Value* table : reader.tables(document, "map")) {
        const bool known = reader.check_keys(*table, "[[map]]",
                                             {"name", "class", "maker", "width", "height", "seed",
                                              "height_map", "normal_map", "colour_map", "baked"});
        MapEntry entry = read_map_entry(reader, *table, "[[map]]", known, folder);
        entry.name = reader.text(*table, "name", "");
        entry.map_class = reader.text(*table, "class", "");
        entries.push_back(std::move(entry));
    }
    return entries;
}

void read_variant(Reader& reader, const Value& table, std::vector<VariantRequest>& rows) {
    const bool known =
        reader.check_keys(table, "[[variant]]",
                          {"surface", "targets", "knobs", "loops", "per_vertex", "arithmetics"});
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
    add_normal(files.baked, arguments);
    return arguments;
}

std::vector<std::string> arguments_of(const MapEntry& entry) {
    if (entry.files) {
        std::vector<std::string> arguments = arguments_of(*entry.files);
        add_normal(entry.baked, arguments);
        return arguments;
    }
    std::vector<std::string> arguments{"--maker", entry.maker, "--map-size",
                                       fmt::format("{}x{}", entry.width, entry.height)};
    if (entry.seed != 1)
        arguments.insert(arguments.end(), {"--seed", fmt::format("{}", entry.seed)});
    add_normal(entry.baked, arguments);
    return arguments;
}

void add_inputs(const MapEntry& map, std::vector<std::filesystem::path>& inputs) {
    const auto add = [&](const std::filesystem::path& path) {
        if (std::find(inputs.begin(), inputs.end(), path) == inputs.end()) inputs.push_back(path);
    };
    if (map.files) {
        add(map.files->height);
        if (map.files->normal) add(*map.files->normal);
        if (map.files->colour) add(*map.files->colour);
    }
    for (const auto& [kind, path] : map.baked) add(path);
}

Result<measure::MapSet> load_map(const MapEntry& entry, double scale) {
    Result<measure::MapSet> set =
        entry.files ? measure::load_map_set(*entry.files, scale)
                    : measure::make_map_set(entry.maker, static_cast<int>(entry.width),
                                            static_cast<int>(entry.height), scale,
                                            static_cast<std::uint32_t>(entry.seed));
    if (!set) return set;
    if (Status status = measure::add_baked_files(*set, entry.baked, scale); !status)
        return status.error();
    if (!entry.name.empty()) set->name = entry.name;
    return set;
}

Result<measure::CaseMap> load_case_map(const MapEntry& entry, double scale,
                                       const std::filesystem::path& folder) {
    Result<measure::MapSet> set = load_map(entry, scale);
    if (!set) return set.error();
    measure::CaseMap map;
    map.hash = measure::content_hash(*set);
    map.map_class = entry.map_class.empty() ? set->name : entry.map_class;
    map.arguments = arguments_in(entry, folder);
    map.set = std::move(*set);
    return map;
}

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

Result<Value> read_document(const std::filesystem::path& path) {
    const Result<std::vector<unsigned char>> bytes = maps::read_file(path, largest_file);
    if (!bytes) return bytes.error();
    return parse_toml({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path.string());
}

}  // namespace intaglio::scene

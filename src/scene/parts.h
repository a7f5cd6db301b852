// The pieces of scene files that sweeps have too: maps, directions, variants.  Inside src/scene
// only.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "src/measure/case.h"
#include "src/measure/view.h"
#include "src/scene/reader.h"
#include "src/variant/variant.h"

namespace intaglio::scene {

// A map as the file describes it.
struct MapEntry {
    Position position;
    std::string name;  // empty: what loading gives it
    std::string map_class;
    std::string maker;
    std::int64_t width = 256, height = 256, seed = 1;
    std::optional<measure::MapFiles> files;
    std::map<std::string, std::filesystem::path> baked = {};  // by kind, of either sort of map
};

// The tree of a file.  Errors: those of maps::read_file and parse_toml.
Result<Value> read_document(const std::filesystem::path& path);

// Every elevation with every azimuth of the table `key`; straight down once.
std::vector<measure::Direction> read_directions(Reader& reader, const Value& document,
                                                std::string_view key,
                                                std::vector<double> elevations,
                                                std::vector<double> azimuths);

// The tables of [[map]]; files are relative to `folder`.
std::vector<MapEntry> read_maps(Reader& reader, const Value& document,
                                const std::filesystem::path& folder);
// The same keys in a table of another kind, whose keys were checked: `known` is what check_keys
// said, `title` as in "[[map]]".
MapEntry read_map_entry(Reader& reader, const Value& table, std::string_view title, bool known,
                        const std::filesystem::path& folder);
Result<measure::MapSet> load_map(const MapEntry& entry, double scale);
// The same as cases have it, its arguments for `folder`, in which the entry was found.
Result<measure::CaseMap> load_case_map(const MapEntry& entry, double scale,
                                       const std::filesystem::path& folder);
// What `intaglio run` takes for it.
std::vector<std::string> arguments_of(const MapEntry& entry);
// The files of a map behind those of others, each once.
void add_inputs(const MapEntry& map, std::vector<std::filesystem::path>& inputs);
std::vector<std::string> arguments_of(const measure::MapFiles& files);

// One table of [[variant]], as the rows it stands for, behind those that are there.
void read_variant(Reader& reader, const Value& table, std::vector<VariantRequest>& rows);

// The forms of loops by name under `loops`.
std::map<std::string, ir::LoopForm> read_loops(Reader& reader, const Value& table);

// An error of loading points at the scene: with its own place where it has none, else in a note.
Diagnostic placed(Diagnostic error, const std::string& scene, Position position);

}  // namespace intaglio::scene

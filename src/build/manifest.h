// manifest.json: what a build made, for programs: files with hashes, interfaces, costs and errors.
// docs/manifest.schema.json is its schema.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/build/header.h"
#include "src/build/maps.h"

namespace intaglio::build {

// Raised when a member goes or changes its meaning; new ones may come.
inline constexpr int manifest_schema = 1;

struct BuiltSurface {
    std::string name;
    std::vector<BuiltVariant> variants;  // in the order of the scene's targets
    std::vector<MapRecord> maps;
    std::string header_hash;
};

// The same bytes for the same build, on every machine: nothing of time, place or threads.
std::string manifest_text(const std::string& scene, const std::vector<BuiltSurface>& surfaces);

// The names of all files that a manifest lists, itself not among them.  Error "manifest-syntax".
Result<std::vector<std::string>> files_listed(const std::string& manifest, const std::string& file);

// What was made of a surface's maps, between the actions of a build.
std::string to_text(const std::vector<MapRecord>& maps);
// Error "maps-syntax".
Result<std::vector<MapRecord>> read_maps(const std::string& text, const std::string& file);

}  // namespace intaglio::build

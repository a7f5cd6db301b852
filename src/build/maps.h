// The maps that a surface's variants read.  A map that a file of the scene already holds as the
// variants read it is named; every other one is made, the way `intaglio bake` makes it, and written
// beside the shaders.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"
#include "src/build/bundle.h"
#include "src/build/cache.h"
#include "src/scene/scene.h"

namespace intaglio::build {

struct MapRecord {
    std::string kind;                   // of `intaglio bake`, or "height", "normal", "colour"
    std::string settings;               // of the bake: "shininess=32"
    std::vector<std::string> samplers;  // that read it
    std::string file;                   // written by the build: "quay.relaxed-cone.png"; or
    std::string source;                 // a file of the scene that holds it
    std::string hash;                   // of the written file
    bool operator==(const MapRecord&) const = default;
};

struct OutputFile {
    std::string name;  // below the output folder
    std::string bytes;
};

struct SurfaceMaps {
    std::vector<MapRecord> records;  // by kind and settings
    std::vector<OutputFile> files;
};

// Of the pixel and vertex stages of all bundles; `folder`: the scene's, which the surface's files
// are relative to.  A sampler that no map is known for is the application's own, and not listed.
// Errors: those of the bakes; "bake-kind": a technique's map of a kind that is not baked here.
Result<SurfaceMaps> make_maps(const scene::SceneSurface& surface,
                              const std::filesystem::path& folder,
                              const std::vector<const Bundle*>& bundles, Cache& cache, int threads);

// The records of make_maps with nothing baked, so without hashes: which files there will be.
std::vector<MapRecord> wanted_maps(const scene::SceneSurface& surface,
                                   const std::filesystem::path& folder,
                                   const std::vector<const Bundle*>& bundles);

std::string hash_of(std::string_view bytes);

}  // namespace intaglio::build

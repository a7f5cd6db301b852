// `intaglio build`: a scene to a folder of shaders, headers, maps and a manifest.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"
#include "src/build/manifest.h"
#include "src/build/orders.h"
#include "src/scene/scene.h"

namespace intaglio::build {

struct BuildOptions {
    std::filesystem::path scene, output;
    std::vector<std::string> targets;  // in place of those that the scene names; empty: the scene's
    std::string name_space;            // of the headers
    std::filesystem::path cache;       // empty: nothing is kept
    std::filesystem::path depfile;     // empty: none
    std::string depfile_target;        // empty: the manifest
    std::filesystem::path expect;      // a list of names; see check_expected; empty: none
    std::filesystem::path tool;        // the running program: what it makes depends on it
    int jobs = 0;                      // variants at once; 0: as the machine has cores
    bool judge = false;                // see BundleOptions
    bool force = false;                // as if nothing were there
    Planner planner = planned_orders;
    // How many variants are done of how many; one call at a time.
    std::function<void(int done, int all)> progress = {};
    std::function<void(const std::string& what, int done, int all)> planning = {};  // before that
};

struct BuildReport {
    bool current = false;  // nothing was to be done
    int surfaces = 0, variants = 0, written = 0, removed = 0;
    int cache_hits = 0, cache_misses = 0;
    std::vector<std::string> notes;
};

// Errors: those of read_scene, of planning, of make_bundle and make_maps; "unknown-target";
// "namespace-syntax"; "depfile-path"; "unexpected-outputs"; "file-unwritable".  On an error the
// folder is as it was.
Result<BuildReport> build_scene(const dsl::Catalogue& catalogue, const BuildOptions& options);

// The scene with `targets` in place of its own, if there are any.
Result<scene::Scene> scene_of(const dsl::Catalogue& catalogue, const BuildOptions& options);

// The names of what a build of the scene writes, without its folder, the manifest last.  Baked maps
// are not among them: which ones are wanted is planning's to say.
std::vector<std::string> static_outputs(const scene::Scene& scene);

// Whether a text with a name on each line lists just those, in any order; names of orders may be
// missing.  For build systems that must know the names before there is a tool to ask.  Error
// "unexpected-outputs", with the first name that only one of both has; `file` is the list's.
Status check_expected(const scene::Scene& scene, const std::string& list, const std::string& file);

}  // namespace intaglio::build

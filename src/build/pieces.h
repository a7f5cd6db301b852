// What a build at once and a build in steps have in common.
#pragma once

#include <vector>

#include "generator/base/result.h"
#include "src/build/build.h"
#include "src/build/cache.h"

namespace intaglio::build {

// One variant, from the cache if it is there.  Errors: those of make_bundle, with the variant's
// name in a note.
Result<Bundle> bundle_from(const dsl::Catalogue& catalogue, const plan::Order& order,
                           const BundleOptions& options, Cache& cache);

std::vector<const Bundle*> bundles_of(const BuiltSurface& surface);

// The maps of a surface whose variants are there: their records, and the files that are made.
Status add_maps(const scene::SceneSurface& from, const scene::Scene& scene,
                const BuildOptions& options, Cache& cache, BuiltSurface& surface,
                std::vector<OutputFile>& files);

// The header of a surface whose variants and maps are there; the surface knows its hash then.
OutputFile add_header(BuiltSurface& surface, const std::string& name_space);

// Where one is asked for.
Status write_depfile(const scene::Scene& scene, const BuildOptions& options);

}  // namespace intaglio::build

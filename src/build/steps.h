// A build in pieces, for engines that spread actions over machines: each reads declared inputs and
// writes declared outputs, and all of them together write what build_scene writes.
//
//     orders     the scene, its maps                  NAME.order.json, .intaglio/scene.json
//     variant    NAME.order.json                      its files, .intaglio/NAME.bundle
//     map-names  the scene, its maps, the bundles     .intaglio/maps.dd
//     maps       the same                             baked maps, .intaglio/SURFACE.maps.json
//     header     orders, bundles, maps of a surface   SURFACE.h
//     manifest   all of that                          manifest.json
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/build/build.h"

namespace intaglio::build {

// Each writes only what differs, so that nothing after it runs without need.  `output` of the
// options is the folder of all; `scene` is read where the table above says so.
Status build_orders(const dsl::Catalogue& catalogue, const BuildOptions& options);
// The order is read from `order`, and all that is written lies in options.output.
Status build_variant(const dsl::Catalogue& catalogue, const std::filesystem::path& order,
                     const BuildOptions& options);
// Which maps the step after it bakes, in Ninja's words: that follows from the variants alone, and
// with it the maps are outputs like any other (a dyndep file, of Ninja 1.10 and later).
Status build_map_names(const dsl::Catalogue& catalogue, const BuildOptions& options);
Status build_maps(const dsl::Catalogue& catalogue, const BuildOptions& options);
Status build_header(const std::string& surface, const BuildOptions& options);
Status build_manifest(const BuildOptions& options);

// The edges for Ninja.  Commands run the tool of the options, from the folder that the options'
// paths are relative to.  Error "ninja-path": Ninja has no way to say a line break in a path.
Result<std::string> ninja_text(const scene::Scene& scene, const BuildOptions& options);
// That the edge which writes `output` writes `more` as well, for a dyndep file.
std::string ninja_outputs_text(const std::filesystem::path& output,
                               const std::vector<std::filesystem::path>& more);

}  // namespace intaglio::build

// A measurement file says what to measure: maps, how deep their relief is, from where they are seen
// and lit, and which variants draw them.
//
//     [relief]
//     scale = 0.08                      # depth in texture units, 0 to 1
//     filtering = "float"               # or "native": the precision of the map's own format
//     [views]                           # every elevation with every azimuth, in degrees
//     elevations = [90, 60, 45, 30, 15] # above the surface; more than -90, at most 90
//     azimuths = [20]                   # from +u towards +v
//     [lights]
//     elevations = [45]
//     azimuths = [135]
//     [run]
//     size = 256                        # pixels a side, a power of two, 8 to 2048
//     rounds = 5                        # of timing, 0 to 1000; 0: no times
//     device = ""                       # part of a Vulkan device's name; empty: lavapipe
//     [[map]]                           # a procedural one ...
//     maker = "bricks"
//     width = 256
//     height = 256                      # where missing: the width
//     seed = 1
//     [[map]]                           # ... or files, relative to the file's folder
//     name = "wall"                     # where missing, made up from the maker or the file
//     height_map = "wall/height.png"
//     normal_map = "wall/normal.png"    # where missing: baked from the heights
//     colour_map = "wall/colour.png"    # where missing: grey
//     baked = { cone = "wall/cone.png" } # files of `intaglio bake` by kind, of either kind of map;
//                                       # where missing: baked in memory
//     [[variant]]
//     surface = "parallax_occlusion"    # name or composition
//     targets = ["glsl_450", "hlsl_5_0"]
//     knobs = { taps = [8, 32] }        # lists are swept: every combination is a row
//     loops = { march = "unroll" }      # or "loop", above the technique's schedule
//     per_vertex = false                # move affine work to the vertex stage
//
// A map's class and a variant's arithmetics are for sweeps (sweep.h), and do nothing here.
//
// Everything but [[map]] and [[variant]] may be missing; the values above are the defaults.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/measure/measure.h"

namespace intaglio::scene {

struct Measurement {
    measure::Plan plan;
    // For each map of the plan the command line arguments that stand for it, for instance
    // {"--height", "maps/wall.png"}: reports print them in commands that can be pasted.
    std::vector<std::vector<std::string>> map_arguments;
    // Every file that was read, the measurement first; without those of `own_map`.
    std::vector<std::filesystem::path> inputs;
};

// Reads a measurement and loads its maps.  With `own_map` the maps of the file are left alone, and
// that one takes their place.
//
// Rows come in the order of the file; within a variant the first knob changes slowest and the
// target fastest.  Views come by elevation, then azimuth; straight down has no azimuth and comes
// once. Surfaces, targets and knob ranges are not checked here: make_variant does.
//
// Codes: "scene-syntax", "scene-unknown-key", "scene-type", "scene-range", "scene-choice",
// "scene-empty", "scene-duplicate", "scene-missing", "scene-conflict", "unknown-map",
// "unknown-bake", each with line and column of the first mistake in the file; those of
// maps::read_file for the scene, and of measure::load_map_set and maps::check_pairing for its maps,
// with a note that says where the scene names them.
Result<Measurement> read_measurement_with_sources(
    const std::filesystem::path& path, const std::optional<measure::MapFiles>& own_map = {});

// The plan alone.
Result<measure::Plan> read_measurement(const std::filesystem::path& path,
                                       const std::optional<measure::MapFiles>& own_map = {});

}  // namespace intaglio::scene

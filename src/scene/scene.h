// A scene file says what is drawn and how well it must look; from it Intaglio chooses the shaders
// (src/plan).  docs/scene.md is the commented example, docs/scene.schema.json its schema.
//
//     name = "harbour"
//     targets = ["ps_2_0", "glsl_450"]      # of every surface that names none of its own
//     [view]                                # from where: ranges ...
//     elevation = [15, 90]                  # degrees above the surface's polygon, in (0, 90]
//     azimuth = [0, 360]                    # degrees from +u towards +v
//     distance = [1, 20]                    # world units
//     [camera]                              # ... or a path, in world space, to derive them from
//     path = [[0, -3, 1.7], [4, -3, 1.7]]
//     field_of_view = 60                    # vertical, degrees
//     pixels = 1080                         # height of the picture
//     [[light]]                             # a direction or a range of them; or a place
//     name = "sun"
//     elevation = [30, 50]                  # in world space, above the xy plane
//     azimuth = 135
//     [tolerance]                           # of every surface that states none
//     p95 = 1.0                             # texels; any error metric of docs/budgets.md
//     [[surface]]
//     name = "quay"                         # an identifier of C++
//     height_map = "quay.png"               # or maker = "bricks"; normal_map, colour_map as well
//     scale = 0.05
//     features = ["shadow"]                 # shadow, depth, silhouette, fur
//     shading = "phong"
//     lights = ["sun"]                      # where missing: all
//     [surface.place]                       # where missing: the xy plane at the origin, 1 x 1
//     ...
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/measure/case.h"

namespace intaglio::scene {

// Inclusive, in the unit of whoever holds it.  One value where least == most.
struct Span {
    double least = 0, most = 0;
    bool is_one() const { return least == most; }
    bool operator==(const Span&) const = default;
};

enum class Feature { Shadow, Depth, Silhouette, Fur };
// "shadow", "depth", "silhouette", "fur".
std::string_view name_of(Feature feature);

// A light as one surface sees it: in the surface's tangent space.
struct SurfaceLight {
    std::string name;
    Span elevation;  // degrees above the polygon; below 0 it cannot reach it
    Span azimuth;    // degrees from +u towards +v; least may be negative, most - least <= 360
    bool shadows = true;
};

// How wrong a surface may be: the greatest value of each metric (the error metrics of
// docs/budgets.md) over the scene's rays.
using Tolerance = std::map<std::string, double>;

struct SceneSurface {
    std::string name;  // an identifier: names files, C++ types and rows
    int line = 0;      // of the file
    measure::CaseMap map;
    double scale = 0.08;                 // depth of the relief in texture units
    Span elevation{15, 90};              // of the view above the polygon, degrees
    Span azimuth{0, 360};                // of the view
    std::optional<Span> pixels_a_texel;  // from distance and camera; empty: unknown
    std::vector<SurfaceLight> lights;    // as the file lists them, those below the horizon too
    std::set<Feature> features;
    std::vector<std::string> targets;  // in the order of the file
    Tolerance tolerance;
    // By target ("*": every one) and metric of cost (docs/budgets.md): the most it may be.
    std::map<std::string, std::map<std::string, double>> budget;
    // What the file pins: of a surface's parts ("search" -> "relief", "shading" -> "phong"), of
    // its knobs ("taps" -> "8"), of its loops; what is not pinned is chosen.
    std::map<std::string, std::string> parts;
    std::vector<std::pair<std::string, std::string>> knobs;
    std::map<std::string, ir::LoopForm> loop_forms;
    // Uniforms whose value the file fixes ("ambient" -> {0.1, 0.1, 0.1}), to be folded; `scale` is
    // always fixed, a light's direction where it is one and the surface does not move.
    std::map<std::string, std::vector<float>> uniforms;
};

struct Scene {
    std::string name;
    std::filesystem::path file;
    std::vector<SceneSurface> surfaces;
    std::vector<std::filesystem::path> inputs;  // every file that was read, the scene first
    int size = 64;                              // pixels a side of the pictures that are measured
    double read_weight = 4;  // operations that one texture read counts as, in the cost of a plan
};

// Codes: those of read_measurement; "scene-name" for a name that is no identifier or that two
// surfaces have; "unknown-feature", "unknown-light", "unknown-metric", "unknown-target", each with
// the nearest, line and column.
Result<Scene> read_scene(const std::filesystem::path& path);

// Whether a file is a scene (has [[surface]]) or a measurement.
Result<bool> is_scene(const std::filesystem::path& path);

}  // namespace intaglio::scene

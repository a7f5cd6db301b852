// A scene file says what is drawn and how well it must look; from it Intaglio chooses the shaders
// (src/plan).  docs/scene.md explains every key, docs/scene.schema.json is the schema.
//
//     name = "harbour"                      # an identifier; where missing, the file's
//     targets = ["ps_2_0", "glsl_450"]      # of every surface that names none of its own
//     size = 61                             # pixels a side of the pictures that are measured
//     read_weight = 4                       # operations that a texture read counts as
//     [view]                                # from where: ranges, or one number each ...
//     elevation = [15, 90]                  # degrees above the surface's polygon, in (0, 90]
//     azimuth = [0, 360]                    # degrees from +u towards +v
//     distance = [1, 20]                    # world units
//     [camera]                              # ... or a path in world space to derive them from
//     path = [[0, -3, 1.7], [4, -3, 1.7]]   # straight from point to point
//     targets = [[0, 0, 1], [4, 0, 1]]      # what it looks at there; where missing, everything
//     field_of_view = 60                    # vertical, degrees
//     aspect = 1.78                         # of the picture: width by height
//     pixels = 1080                         # height of the picture
//     near = 0.1                            # nothing is drawn nearer than this, world units
//     least_elevation = 1                   # flatter rays are left out, degrees
//     [[light]]                             # a direction or a range of them; or a place
//     name = "sun"
//     elevation = [30, 50]                  # in world space, above the xy plane
//     azimuth = 135                         # from +x towards +y; where missing, any
//     shadows = true                        # false: shadows of it are not wanted
//     [tolerance]                           # an error metric of docs/budgets.md and its greatest
//     p95 = 1.0                             # value; [tolerance.ps_2_0]: on that target
//     [budget]                              # the same of costs
//     arithmetic = 64
//     [[surface]]
//     name = "quay"                         # an identifier of C++
//     height_map = "quay.png"               # the keys of a [[map]] in measurement.h but name and
//     normal_map = "quay_normal.png"        # class: colour_map, baked; or maker, width, ...
//     scale = 0.05                          # depth of the relief in texture units
//     features = ["shadow"]                 # shadow, depth, silhouette, fur
//     lights = ["sun"]                      # where missing: all
//     targets = ["ps_2_b"]                  # in place of the scene's
//     search = "relief"                     # pinned: search, shadow, normal, shading, output,
//     knobs = { taps = 8 }                  # vertex; knobs, loops as in a [[variant]]
//     uniforms = { ambient = [0.1, 0.1, 0.1] }  # values that never change
//     [surface.place]                       # where missing: 1 x 1 about the origin, in the xy
//     position = [0, 0, 0]                  # plane; its middle
//     normal = [0, 0, 1]
//     tangent = [1, 0, 0]                   # along which u grows
//     mirrored = false                      # v grows along normal x tangent, or against it
//     size = [4, 2]                         # world units along u and v
//     repeat = [2, 1]                       # how often the map lies on it
//     [surface.view], [surface.tolerance], [surface.budget]: above the scene's, key by key
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/measure/case.h"
#include "src/scene/span.h"

namespace intaglio::scene {

enum class Feature { Shadow, Depth, Silhouette, Fur };
// "shadow", "depth", "silhouette", "fur".
std::string_view name_of(Feature feature);

// A light as one surface sees it: in the surface's tangent space.  Ranges hold every direction to
// the light from every point of the surface, and may hold more.
struct SurfaceLight {
    std::string name;
    Span elevation;  // degrees above the polygon; below 0 it cannot reach it
    Span azimuth;    // degrees from +u towards +v; least may be negative, most - least <= 360
    bool shadows = true;
    // In world space, as the uniform of a light takes it: the place with 1, or the direction to it
    // with 0 where the file names only one; empty where it moves.
    std::optional<std::array<float, 4>> world = {};
};

// How wrong a surface may be: the greatest value of each metric (the error metrics of
// docs/budgets.md) over the scene's rays.
using Tolerance = std::map<std::string, double>;
// The same of costs.
using Budget = std::map<std::string, double>;

struct SceneSurface {
    std::string name;          // an identifier: names files, C++ types and rows
    int line = 0, column = 0;  // of the file
    measure::CaseMap map;      // its arguments are for the scene's folder
    double scale = 0.08;       // depth of the relief in texture units
    Span elevation{15, 90};    // of the view above the polygon, degrees
    Span azimuth{0, 360};      // of the view; least may be negative, most - least <= 360
    // How many pixels a texel's side covers in the middle of the picture, seen straight on: the
    // shorter side at the greatest distance, the longer at the least.  Empty where the scene says
    // nothing of distance or camera.
    std::optional<Span> pixels_a_texel;
    std::vector<SurfaceLight> lights;  // as the file lists them, those below the horizon too
    std::set<Feature> features;
    std::vector<std::string> targets;  // in the order of the file
    // On every target, and on one ("ps_2_0") by metric in its place.
    Tolerance tolerance;
    std::map<std::string, Tolerance> target_tolerance;
    // By target ("*": every one) and metric of cost (docs/budgets.md): the most it may be.
    std::map<std::string, Budget> budget;
    // What the file pins: of a surface's parts ("search" -> "relief", "shading" -> "phong"), of
    // its knobs ("taps" -> "8"), of its loops; what is not pinned is chosen.
    std::map<std::string, std::string> parts;
    std::vector<std::pair<std::string, std::string>> knobs;
    std::map<std::string, ir::LoopForm> loop_forms;
    // Uniforms whose value the file fixes ("ambient" -> {0.1, 0.1, 0.1}), to be folded; `scale` is
    // always among them.
    std::map<std::string, std::vector<float>> uniforms;

    // What holds on one target, all together.  Metrics that no variant of the target has (slots of
    // a language without) are in neither; shadow_wrong only where shadows are wanted of a light
    // that reaches the surface.
    Tolerance tolerance_on(const std::string& target) const;
    Budget budget_on(const std::string& target) const;
};

struct Scene {
    std::string name;
    std::filesystem::path file;
    std::vector<SceneSurface> surfaces;
    std::vector<std::filesystem::path> inputs;  // every file that was read, the scene first
    // Pixels a side of the pictures that are measured.  A prime, so that rays fall on every part of
    // a texel: of maps, sizes of which are powers of two, a grid of 64 sees one corner of each
    // eighth texel.
    int size = 61;
    double read_weight = 4;  // operations that one texture read counts as, in the cost of a plan
};

// Reads a scene and loads its maps.  With a catalogue the names of pinned techniques and knobs are
// looked up.
//
// Codes: those of read_measurement; "scene-name" for a name that is no identifier or that two
// surfaces have; "unknown-feature", "unknown-light", "unknown-metric", "unknown-target",
// "unknown-technique", "unknown-knob", each with the nearest; "scene-not-applicable" for a metric
// that a target does not have; "scene-unseen" for a surface whose front the camera never sees.  All
// with line and column, of the first mistake in the file.
Result<Scene> read_scene(const std::filesystem::path& path,
                         const dsl::Catalogue* catalogue = nullptr);

// Whether a file is a scene (has [[surface]]) or a measurement.  Codes: those of reading TOML.
Result<bool> is_scene(const std::filesystem::path& path);

}  // namespace intaglio::scene

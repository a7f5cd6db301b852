// A surface: one search, shadow, normal source, shading, output and vertex work, composed.  A
// search is a drop-in: it changes the offset computation and leaves the rest alone (McGuire and
// McGuire 2005).
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "generator/dsl/technique.h"
#include "generator/ir/module.h"

namespace intaglio::dsl {

// The relief's own knobs, shared by every technique of a surface.
class ReliefKnobs : public Technique {
  public:
    Knob<int> packed{
        this,
        "packed",
        0,
        at_least{0},
        at_most{1},
        "1: heights in the alpha channel of normal_map; 0: in the red channel of height_map"};
    Knob<float> level{this, "level", 0.0f, at_least{0}, at_most{16}, "mip level of height reads"};
    // Interpolating V.xy / V.z is exact on a flat polygon with one tangent frame, where V before
    // normalisation has the same z everywhere; elsewhere it bends with the mesh's vertices.
    Knob<int> ray_per_vertex{
        this,
        "ray_per_vertex",
        0,
        at_least{0},
        at_most{1},
        "1: the ray's reach is computed at the vertices and interpolated; 0: at each pixel"};
    Knob<int> clip_tile{
        this,
        "clip_tile",
        0,
        at_least{0},
        at_most{1},
        "1: pixels whose ray leaves the part of the map that uniform tile names are dropped"};
    // Floats hold places near 0 finest, so that a ray that starts in the map's first tile meets the
    // same relief in every one.  Between tiles such a coordinate jumps, and with it the level that
    // hardware without gradients would choose: there colours want 1, or maps of one level.
    Knob<int> local_origin{this,
                           "local_origin",
                           0,
                           at_least{0},
                           at_most{2},
                           "0: rays start at the coordinate; 1: at its place in the first tile of "
                           "the repeated maps; 2: colours and normals are read there as well"};
};

// By what a surface is lit.
class LightKnobs : public Technique {
  public:
    Knob<int> lights{this,
                     "lights",
                     1,
                     at_least{0},
                     at_most{most_lights},
                     "how many lights; none: ambient light alone"};
    Knob<int> shadowed{this,
                       "shadowed_lights",
                       most_lights,
                       at_least{0},
                       at_most{most_lights},
                       "the first so many lights throw shadows; what the others cannot, they "
                       "need not search"};
    // How many throw shadows.
    int shadowing() const { return std::min(lights.value(), shadowed.value()); }
};

struct Surface {
    std::string name;         // "parallax_occlusion", or the composition as written
    std::string description;  // sentences with the sources
    std::unique_ptr<Search> search;
    std::unique_ptr<Shadow> shadow;
    std::unique_ptr<NormalSource> normal;
    std::unique_ptr<Shading> shading;
    std::unique_ptr<Output> output;
    std::unique_ptr<VertexWork> vertex;
    std::unique_ptr<ReliefKnobs> relief = std::make_unique<ReliefKnobs>();
    std::unique_ptr<LightKnobs> lighting = std::make_unique<LightKnobs>();

    // All techniques in the order of the work, and all their knobs.
    std::vector<Technique*> techniques() const;
    std::vector<KnobBase*> knobs() const;
    // Sets a knob by name; a sentence with the nearest name if there is none.
    Status set_knob(std::string_view knob_name, std::string_view value);
    // "taps = 8" for each knob that this surface's output uses; of the lights those that are not as
    // by default.
    std::vector<std::string> settings() const;
};

struct RecordOptions {
    std::string target;  // whose schedule applies
    // Overrides of the schedule by loop name ("march" -> Unrolled).
    std::map<std::string, ir::LoopForm> loop_forms;
    bool per_vertex =
        false;  // consent to move affine functions of interpolants to the vertex stage
};

// Runs the techniques' bodies once and gives both stages as IR.
Result<ir::Program> record_surface(const Surface& surface, const RecordOptions& options);

// One part of a surface as a function to paste into a shader of one's own:
//   Search: float3 find(float2 uv, float3 view): displaced coordinate and height; with
//           ray_per_vertex = 1 a third parameter, float2 reach
//   Shadow: float1 visibility(float2 uv, float1 height, float3 light)
enum class FunctionPart { Search, Shadow };
Result<ir::Program> record_function(const Surface& surface, FunctionPart part,
                                    const RecordOptions& options);

}  // namespace intaglio::dsl

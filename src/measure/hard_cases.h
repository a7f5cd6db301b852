// The hard suite: the inputs that relief shaders break on, what each promises there and why, and
// the techniques that are put to it.  Facts and sources: docs/hard-cases.md.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "generator/ir/module.h"
#include "src/measure/map_set.h"
#include "src/vulkan/mesh.h"

namespace intaglio::measure {

// Which part of a surface a row of the suite looks at: where the ray meets the relief, how much
// light reaches the point, or the shaded colour.
enum class HardPart { Search, Shadow, Colour };

// What a search is measured against: the exact first hit, or, where a technique does not promise
// one (a single read, a table), the point that its own formula gives in real numbers.
enum class HardYardstick { FirstHit, OwnFormula };

// A technique with knobs that put it to the test.
struct HardRow {
    std::string name;
    std::string surface;  // see dsl::make_surface
    std::vector<std::pair<std::string, std::string>> knobs = {};
    HardPart part = HardPart::Search;
    HardYardstick yardstick = HardYardstick::FirstHit;
    double within = 0.5;  // texels of the yardstick that it promises
    // Never passes through the relief (STAR: Szirmay-Kalos, Umenhoffer 2008).
    bool safe = false;
    // Experiments: the recorded stages are changed first, and the device is left out.
    std::function<void(ir::Module&)> rewrite = {};
    bool evaluated_only = false;
};
const std::vector<HardRow>& hard_rows();

// A part of the drawn mesh with coordinates and a tangent frame of its own: one square unit of
// texture space.
struct HardPatch {
    std::string name;
    std::array<float, 2> uv;  // of its corner
    std::array<float, 3> normal = {0, 0, 1};
    std::array<float, 4> tangent = {1, 0, 0, 1};
    bool mirrored = false;  // v runs against the picture, and the frame's handedness says so
};
const std::vector<HardPatch>& hard_patches();
// Rays along a side of a patch, and patches along a side of the picture.
inline constexpr int patch_pixels = 8, patches_across = 4;
inline constexpr int hard_pixels = patch_pixels * patches_across;
// All patches side by side over [0, 1]^2.
vulkan::Mesh hard_mesh();
// The vertex that pixel (x, y) of the picture lies on, as if one stood there.
vulkan::Vertex hard_vertex(int x, int y);

// The maps by name, at most 64 texels a side: "smooth", "spikes", ..., made once.
const MapSet& hard_map(const std::string& name);
Filtering hard_filtering(const std::string& map);

// What is expected of every ray of a case; what of a technique that does not reach it is degraded,
// by its distance, and NaN, Inf or a point off the ray is broken.
enum class Expect {
    Yardstick,    // no first hit missed, and 95 % of hits within half a texel of the yardstick
    Within16th,   // the same within a sixteenth of a texel
    FormatsBest,  // within half a texel and two units in the last place of the coordinate
    Undisplaced,  // the coordinate itself, to the bit
    OnFlattest,   // finite, on the ray at the least V.z; its first hit is nobody's to know
    Lit,          // visibility 1
    Dark,         // visibility 0
    Shadow,       // at most 5 % of the points judged otherwise than exactly
    OwnFormula,   // visibility or colour within 2/255 of the same formula in real numbers
};

// One aim of the eye and of the light, as the uniforms get them: of any length.
struct Aim {
    std::array<float, 3> eye, light;
};

struct HardCase {
    std::string name;         // "straight_down"
    std::string expectation;  // a sentence
    std::string reason;       // a sentence: what goes wrong there
    std::string map;
    std::string patch;
    std::vector<Aim> aims;
    float scale;
    // Of searches, shadows and colours; a case that says nothing of a part has nothing there.
    std::vector<std::pair<HardPart, Expect>> expects;
};
const std::vector<HardCase>& hard_cases();

}  // namespace intaglio::measure

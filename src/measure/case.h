// One case of a sweep: a variant on a map, at one view, light, scale and arithmetic; and what is
// known of it once measured.  docs/measure.md says what each number means and in which unit.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "generator/target/d3d9/resources.h"
#include "src/check/cost.h"
#include "src/measure/flip.h"
#include "src/measure/hits.h"
#include "src/measure/map_set.h"
#include "src/measure/metrics.h"
#include "src/variant/variant.h"

namespace intaglio::measure {

// What the pixel stage computes in: binary32, R300's 24 bits, or 16 bits throughout.
enum class Arithmetic { Fp32, Fp24, Fp16 };
// "fp32", "fp24", "fp16".
std::string_view name_of(Arithmetic arithmetic);
// Error "unknown-arithmetic", with the nearest.
Result<Arithmetic> arithmetic_named(const std::string& name);

struct Case {
    VariantRequest request;
    Direction view, light;
    double scale = 0.08;  // depth of the relief in texture units
    // Pixels a side.  With a power of two coordinates are exact on lavapipe, else within an ULP.
    int size = 128;
    Filtering filtering = Filtering::Float;
    Arithmetic arithmetic = Arithmetic::Fp32;
    int split_size = 31;  // rays a side whose error is split by source; 0: it is not.  A prime, so
                          // that they fall everywhere on maps that repeat themselves.
    // Of a planned scene the name of the [[surface]] that the variant was chosen for; else empty.
    std::string scene_surface = {};
};

// A map with what results say of it.
struct CaseMap {
    MapSet set;
    std::string map_class;               // "bricks", "noise", ...: what the map is an example of
    std::vector<std::string> arguments;  // of `intaglio run`: {"--height", "wall.png"}
    std::string hash;                    // of all its samples and their precision: content_hash
};
// 32 hexadecimal digits.
std::string content_hash(const MapSet& set);

// Who drew the hits.
enum class Maker { Device, Interpreter, Evaluator };
std::string_view name_of(Maker maker);

// How much work the search and the shadow of a pixel are, counted while they ran.
struct Executed {
    double reads_mean = 0;
    long reads_max = 0;  // textures
    // Of Direct3D 9 bytecode in the interpreter, else of the optimised IR in the evaluator, on the
    // rays of the split; nothing without them.
    std::optional<double> instructions_mean;
    std::optional<long> instructions_max;
};

// The pixel with the greatest error of the hit, and its ray.
struct WorstPixel {
    int x = 0, y = 0;
    double texels = 0;
    std::array<double, 2> uv{};                 // where the ray enters
    std::array<double, 3> view{};               // unit vector to the eye, as the shader got it
    std::array<double, 3> exact{}, reported{};  // uv and height
    bool missed = false;
};

struct CaseMetrics {
    // The target cannot have this variant, and nothing else is known.
    std::optional<Diagnostic> refusal;

    Maker maker = Maker::Device;
    std::vector<std::string> settings;     // every knob: "taps = 8"
    check::SpirvCost spirv;                // of the shaded pixel stage, optimised
    std::optional<d3d9::Resources> slots;  // of Direct3D 9
    Executed executed;
    HitStatistics hits;
    Swim swim;
    PictureError picture;
    std::optional<ErrorSplit> split;
    WorstPixel worst;
};

}  // namespace intaglio::measure

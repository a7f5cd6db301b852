// Speed against error: draws every variant on every map at every view and light, compares each
// pixel's hit with the exact reference, and times the variants interleaved.  Direct3D 9 variants
// are judged by what their bytecode does in the arithmetic of the hardware of their time, so their
// hits are the interpreter's; their times are those of MojoShader's translation.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "generator/target/d3d9/interpret.h"
#include "generator/target/d3d9/resources.h"
#include "src/measure/hits.h"
#include "src/measure/map_set.h"
#include "src/variant/variant.h"

namespace intaglio::measure {

struct Plan {
    std::vector<VariantRequest> rows;
    std::vector<MapSet> maps;
    std::vector<Direction> views;
    std::vector<Direction> lights;
    double scale = 0.08;  // depth of the relief in texture units
    int size = 256;  // pixels a side; a power of two, so that coordinates are exact on lavapipe
    int rounds = 5;  // of interleaved timing; 0: no timing
    Filtering filtering = Filtering::Float;
    std::string device;       // see vulkan::DeviceOptions
    bool validation = false;  // Vulkan validation layers; a message is an error
};

// What hardware of Direct3D 9's time computes in, beside fp32: R300's 24 bits, and 16 bits as
// if every instruction said _pp.
inline constexpr std::array narrow_arithmetics = {d3d9::Arithmetic::Fp24,
                                                  d3d9::Arithmetic::Fp16Partial};

// One variant on one map at one view and light.
struct CaseResult {
    int row = 0, map = 0;  // indices into the plan
    Direction view, light;
    HitStatistics hits;  // of a Direct3D 9 variant: in fp32
    // Of a Direct3D 9 variant in each of narrow_arithmetics, else empty.
    std::vector<HitStatistics> narrow_hits;
    double reads_mean =
        0;  // texture reads executed per pixel, counted on the run (search and shadow)
    int reads_max = 0;
    std::int64_t invalid_colours = 0;  // pixels with NaN or Inf after shading
    double nanoseconds = 0;            // per pixel, shaded, median of the rounds; 0: not timed
    double ratio =
        0;  // to the first row at the same map, view and light, median of the rounds' ratios
    double ratio_low = 0, ratio_high = 0;  // the quartiles of those ratios: their spread
};

struct Measurement {
    std::string device;                   // name and driver: whose times these are
    std::vector<check::SpirvCost> costs;  // of each row's shaded pixel stage
    // Of a Direct3D 9 row its shaded pixel stage counts in slots, whose SPIR-V is MojoShader's.
    std::vector<std::optional<d3d9::Resources>> slots;
    std::vector<std::vector<std::string>> settings;  // of each row
    std::vector<CaseResult> cases;                   // by map, view, light, row
};

// `progress` is told how many of how many cases are done; it may be empty.
Result<Measurement> measure(const dsl::Catalogue& catalogue, const Plan& plan,
                            const std::function<void(int done, int all)>& progress = {});

}  // namespace intaglio::measure

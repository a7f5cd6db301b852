// What a variant costs before it is run, each number with its maker: slots as Direct3D's validator
// charges them, SPIR-V instructions after optimisation, and what a GPU's own compiler makes of it,
// without the GPU (Mesa's RADV, src/vulkan/compiled.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/target/d3d9/resources.h"
#include "src/check/cost.h"
#include "src/variant/variant.h"
#include "src/vulkan/compiled.h"

namespace intaglio::measure {

// Of one stage, by one chip's compiler.  A number that the driver does not tell is absent.
struct ChipCost {
    std::optional<double> instructions;
    std::optional<double> vector_registers, scalar_registers, spilled;  // registers of one wave
    std::optional<double> latency;             // cycles of one wave from start to end
    std::optional<double> inverse_throughput;  // cycles from wave to wave
    std::optional<double> code_bytes;
};

struct Chip {
    std::string chip;    // as asked for: "polaris10"
    std::string driver;  // name and version, as it words them
    std::optional<ChipCost> vertex, pixel;
};

struct StaticCost {
    std::optional<d3d9::Resources> vertex_slots, pixel_slots;  // Direct3D 9 variants
    // Of the optimised stage, where a target has text: Direct3D 9 variants have slots.
    std::optional<check::SpirvCost> pixel;
    std::vector<Chip> chips;
};

// Chips whose compilers are asked, opened once.  Empty where no chip was named.
class ChipCompilers {
  public:
    // Errors: those of vulkan::Device::create.
    static Result<ChipCompilers> create(const std::vector<std::string>& chips);
    // Errors: those of vulkan::compile.
    Result<std::vector<Chip>> compile(const check::Program& program) const;

  private:
    struct Compiler {
        std::string chip;
        vulkan::Device device;
    };
    std::vector<Compiler> compilers_;
};

// Errors: those of the witnesses (judge_variant) and of the compilers.  A variant that cannot
// become SPIR-V (glsl_120, essl_100) has neither SPIR-V counts nor chips.
Result<StaticCost> cost_of(const Variant& variant, const ChipCompilers& compilers);

}  // namespace intaglio::measure

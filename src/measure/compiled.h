// A variant as it is measured: the shader that people would ship, and the one that says where it
// hit and how much it read, as SPIR-V or as bytecode to interpret; and both with maps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/measure/interpreted.h"
#include "src/measure/render.h"
#include "src/variant/variant.h"

namespace intaglio::measure {

// Of Direct3D 9 the hits are interpreted, which needs no counter of reads in the shader.
struct CompiledRow {
    Variant shaded_variant;
    Variant displaced_variant;  // its colour target holds the hit (output=displaced)
    bool is_bytecode = false;
    check::Program instrumented;  // of displaced_variant, with a target that counts reads; not of
                                  // bytecode
    check::Program shaded;
    check::SpirvCost cost;                 // of the optimised shaded pixel stage
    std::optional<d3d9::Resources> slots;  // of the shaded pixel stage, of bytecode
    std::vector<std::string> settings;
};

// Errors: those of make_variant and link_variant.
Result<CompiledRow> compile_row(const dsl::Catalogue& catalogue, const VariantRequest& request);

// A row's instrumented shader with maps: on the device, or interpreted.
struct PreparedHits {
    std::optional<vulkan::Program> program;
    std::optional<InterpretedQuad> bytecode, in_half;

    const InterpretedQuad& quad(d3d9::Arithmetic arithmetic) const {
        return arithmetic == d3d9::Arithmetic::Fp16Partial ? *in_half : *bytecode;
    }
};
Result<PreparedHits> prepare_hits(const vulkan::Device& device, const CompiledRow& row,
                                  const Textures& textures, double scale, int size);

}  // namespace intaglio::measure

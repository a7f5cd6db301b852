// From a request to what is drawn.
#include "src/measure/compiled.h"

#include "src/check/spirv.h"
#include "src/measure/hits_request.h"

namespace intaglio::measure {

Result<CompiledRow> compile_row(const dsl::Catalogue& catalogue, const VariantRequest& request) {
    Result<Variant> shaded = make_variant(catalogue, request);
    if (!shaded) return shaded.error();
    const bool is_bytecode = profile_of(*shaded->target).has_value();
    VariantRequest instrumented = hits_request(catalogue, request);
    instrumented.count_reads = !is_bytecode;
    Result<Variant> displaced = make_variant(catalogue, instrumented);
    if (!displaced) return displaced.error();
    CompiledRow row{std::move(*shaded), std::move(*displaced), is_bytecode, {}, {}, {}, {}, {}};

    row.settings = row.shaded_variant.program.settings;
    Result<check::Program> linked = link_variant(row.shaded_variant);
    if (!linked) return linked.error();
    row.shaded = std::move(*linked);
    const Result<check::SpirvWords> optimized = check::optimize_spirv(row.shaded.pixel);
    if (!optimized) return optimized.error();
    const Result<check::SpirvCost> cost =
        check::count_spirv(*optimized, longest_loop(row.shaded_variant.program));
    if (!cost) return cost.error();
    row.cost = *cost;
    if (is_bytecode) {
        const Result<d3d9::Shader> shader = decode_stage(row.shaded_variant, ir::Stage::Pixel);
        if (!shader) return shader.error();
        row.slots = d3d9::count(*shader);
        return row;
    }
    linked = link_variant(row.displaced_variant);
    if (!linked) return linked.error();
    row.instrumented = std::move(*linked);
    return row;
}

Result<PreparedHits> prepare_hits(const vulkan::Device& device, const CompiledRow& row,
                                  const Textures& textures, double scale, int size) {
    PreparedHits hits;
    if (!row.is_bytecode) {
        Result<vulkan::Program> program =
            prepare_quad(device, row.instrumented, textures, scale, size, size);
        if (!program) return program.error();
        hits.program = std::move(*program);
        return hits;
    }
    Result<InterpretedQuad> quad =
        InterpretedQuad::prepare(row.displaced_variant, textures, scale, size, size);
    if (!quad) return quad.error();
    Result<InterpretedQuad> in_half = quad->with_partial_precision();
    if (!in_half) return in_half.error();
    hits.bytecode = std::move(*quad);
    hits.in_half = std::move(*in_half);
    return hits;
}

}  // namespace intaglio::measure

// The generator is asked once more, for the shader behind the bytes and the smallest that did not
// fit: it is deterministic, so this is the shader that make_variant gives.
#include "src/variant/explain.h"

#include <fmt/format.h>

#include "generator/ir/ops.h"
#include "generator/passes/rewrite.h"
#include "generator/target/d3d9/generate/generate.h"

namespace intaglio {
namespace {

ExplainedStage explained(const d3d9::Shader& shader) {
    ExplainedStage stage;
    stage.stage = is_pixel(shader.profile) ? ir::Stage::Pixel : ir::Stage::Vertex;
    stage.profile = shader.profile;
    stage.explanation = d3d9::explain(shader);
    return stage;
}

Status explain_vertex(ExplainedVariant& result, const ir::Program& program, d3d9::Profile profile) {
    const Result<d3d9::Shader> vertex = d3d9::generate_vertex(program, profile, &result.notes);
    if (!vertex) return vertex.error();
    result.stages.push_back(explained(*vertex));
    return Done{};
}

Status explain_pixel(ExplainedVariant& result, const ir::Program& program, d3d9::Profile profile) {
    const Result<d3d9::Attempt> attempt = d3d9::attempt_program(program, profile);
    if (!attempt) return attempt.error();
    result.stages.push_back(explained(attempt->pixel));
    result.stages.back().only_slots = attempt->only_slots;
    if (attempt->vertex) result.stages.push_back(explained(*attempt->vertex));
    result.refusal = attempt->refusal;
    result.notes = attempt->notes;
    return Done{};
}

// What an instruction of a language costs: shapes and values as they come cost nothing.
d3d9::Slots cost_of(const ir::Instruction& instruction) {
    switch (ir::info(instruction.op).type_rule) {
        case ir::TypeRule::Sample: return {0, 1};
        case ir::TypeRule::Leaf:
        case ir::TypeRule::Compose:
        case ir::TypeRule::Swizzle:
        case ir::TypeRule::Loop:
        case ir::TypeRule::Terminator: return {0, 0};
        default: return {1, 0};
    }
}

ExplainedStage explained(const ir::Module& module) {
    std::vector<d3d9::Spent> instructions;
    std::vector<d3d9::TextureRead> reads;
    passes::for_each_instruction(module.body, [&](const ir::Instruction& instruction) {
        d3d9::Spent spent;
        spent.slots = cost_of(instruction);
        const ir::Origin& origin = instruction.origin;
        if (spent.slots.total() == 0) return;
        if (origin.step >= 0) spent.step = module.steps[static_cast<std::size_t>(origin.step)].name;
        if (origin.file >= 0) {
            spent.file = module.files[static_cast<std::size_t>(origin.file)];
            spent.line = origin.line;
        }
        if (spent.slots.texture > 0)
            reads.push_back({0, module.samplers[static_cast<std::size_t>(instruction.slot)].name,
                             spent.step, spent.file, spent.line});
        instructions.push_back(std::move(spent));
    });
    ExplainedStage stage;
    stage.stage = module.stage;
    stage.explanation = d3d9::sum_up(instructions);
    stage.explanation.reads = std::move(reads);
    return stage;
}

// The modules as they stood after the last pass are what was printed.
Status explain_text(ExplainedVariant& result, const Recorded& recorded) {
    const Target& target = recorded.target->derived_from.empty()
                               ? *recorded.target
                               : *find_target(recorded.target->derived_from);
    ir::Module pixel = recorded.program.pixel, vertex = recorded.program.vertex;
    EmitOptions options;
    options.after_each_pass = [&](std::string_view, const ir::Module& module) {
        (module.stage == ir::Stage::Pixel ? pixel : vertex) = module;
    };
    const Result<Emitted> emitted = emit(recorded.program, target, options);
    if (!emitted) {
        if (!is_refusal(emitted.error())) return emitted.error();
        result.refusal = emitted.error();
        return Done{};
    }
    result.stages = {explained(pixel), explained(vertex)};
    return Done{};
}

}  // namespace

Result<ExplainedVariant> explain_variant(const dsl::Catalogue& catalogue,
                                         const VariantRequest& request) {
    const Result<Recorded> recorded = record_variant(catalogue, request);
    if (!recorded) return recorded.error();
    return explain_recorded(*recorded);
}

Result<ExplainedVariant> explain_recorded(const Recorded& recorded) {
    const std::optional<d3d9::Profile> profile = profile_of(*recorded.target);
    ExplainedVariant result;
    result.name = recorded.program.name;
    result.settings = recorded.program.settings;
    const Status status = !profile             ? explain_text(result, recorded)
                          : is_pixel(*profile) ? explain_pixel(result, recorded.program, *profile)
                                               : explain_vertex(result, recorded.program, *profile);
    if (!status) return status.error();
    result.left_out = recorded.left_out;
    return result;
}

}  // namespace intaglio

// The generator is asked once more, for the shader behind the bytes and the smallest that did not
// fit: it is deterministic, so this is the shader that make_variant gives.
#include "src/variant/explain.h"

#include <fmt/format.h>

#include "generator/target/d3d9/generate/generate.h"

namespace intaglio {
namespace {

ExplainedStage explained(const d3d9::Shader& shader) {
    ExplainedStage stage;
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

}  // namespace

Result<ExplainedVariant> explain_variant(const dsl::Catalogue& catalogue,
                                         const VariantRequest& request) {
    const Result<Recorded> recorded = record_variant(catalogue, request);
    if (!recorded) return recorded.error();
    const std::optional<d3d9::Profile> profile = profile_of(*recorded->target);
    if (!profile)
        return input_error("not-explained",
                           fmt::format("explain counts the slots of ps_2_0, ps_2_a, ps_2_b, "
                                       "ps_3_0, vs_2_0 and vs_3_0; what {} costs, `intaglio "
                                       "validate` says",
                                       recorded->target->name));
    ExplainedVariant result;
    result.name = recorded->program.name;
    result.settings = recorded->program.settings;
    const Status status = is_pixel(*profile) ? explain_pixel(result, recorded->program, *profile)
                                             : explain_vertex(result, recorded->program, *profile);
    if (!status) return status.error();
    return result;
}

}  // namespace intaglio

// The bytes are decoded again, so that what is judged is what a device would load.
#include "src/variant/bytecode.h"

#include <fmt/format.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/legality.h"
#include "src/check/mojoshader.h"

namespace intaglio {
namespace {

std::vector<std::uint32_t> words_of(const std::string& bytes) {
    std::vector<std::uint32_t> words(bytes.size() / 4);
    for (std::size_t i = 0; i < words.size() * 4; ++i)
        words[i / 4] |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * (i % 4));
    return words;
}

Diagnostic own_failure(const Variant& variant, std::string_view what) {
    return internal_error("d3d9-round-trip", fmt::format("{} on {}: {}", variant.request.surface,
                                                         variant.target->name, what));
}

Result<d3d9::Shader> decoded(const Variant& variant, const Artifact& artifact) {
    const std::vector<std::uint32_t> words = words_of(artifact.bytecode.bytes);
    Result<d3d9::Shader> shader = d3d9::decode(words, profile_of(*variant.target));
    if (!shader) return shader;
    if (d3d9::encode(*shader) != words)
        return own_failure(variant, "the bytecode is decoded and encoded to other bytes");
    const Result<d3d9::Shader> parsed =
        d3d9::parse(artifact.text, variant.request.surface, profile_of(*variant.target));
    if (!parsed) return parsed.error();
    if (*parsed != *shader)
        return own_failure(variant, "text and bytecode are not the same shader");
    const std::vector<d3d9::Violation> violations = d3d9::check(*shader);
    if (!violations.empty())
        return own_failure(
            variant, fmt::format("{} [{}]", violations.front().message, violations.front().rule));
    return shader;
}

// One stage before every witness; its steps are added to the others.
Result<check::Witnessed> judge_stage(const Variant& variant, const Artifact& artifact,
                                     Judged& judged) {
    const bool vertex = artifact.stage == ir::Stage::Vertex;
    Result<d3d9::Shader> shader = decoded(variant, artifact);
    if (!shader) return shader.error();
    Result<check::D3d9Stage> translated = check::translate_d3d9(
        words_of(artifact.bytecode.bytes), vertex ? check::Stage::Vertex : check::Stage::Pixel);
    if (!translated) return translated.error();
    check::Source source = check::with_names(std::move(*translated)).source;
    source.name = fmt::format("{}.{}{} (MojoShader)", variant.request.surface, variant.target->name,
                              artifact.extension);
    Result<check::Witnessed> witnessed = check::judge(source);
    if (!witnessed) return witnessed.error();
    std::vector<std::string> steps = {
        "decoded and encoded to the same bytes", "assembly parsed to the same shader",
        fmt::format("every rule of {}", name_of(shader->profile)), "MojoShader"};
    steps.insert(steps.end(), witnessed->steps.begin(), witnessed->steps.end());
    for (const std::string& step : steps)
        judged.steps.push_back(fmt::format("{}: {}", vertex ? "vertex" : "pixel", step));
    judged.shaders.push_back(std::move(*shader));
    return witnessed;
}

}  // namespace

Result<d3d9::Shader> checked_stage(const Variant& variant, ir::Stage stage) {
    return decoded(variant, stage == ir::Stage::Vertex ? variant.vertex : variant.pixel);
}

Result<d3d9::Shader> decode_stage(const Variant& variant, ir::Stage stage) {
    const Artifact& artifact = stage == ir::Stage::Vertex ? variant.vertex : variant.pixel;
    return d3d9::decode(words_of(artifact.bytecode.bytes), profile_of(*variant.target));
}

Result<check::Program> link_bytecode(const Variant& variant) {
    if (!variant.target->pixel_stage)
        return input_error(
            "not-runnable",
            fmt::format("{} is a vertex stage alone; run the surface on {}, which comes with it",
                        variant.target->name,
                        variant.target->name == "vs_3_0" ? "ps_3_0" : "ps_2_0, ps_2_a or ps_2_b"));
    return check::link_d3d9_by_name(words_of(variant.vertex.bytecode.bytes),
                                    words_of(variant.pixel.bytecode.bytes));
}

Result<Judged> judge_bytecode(const Variant& variant) {
    Judged judged;
    const Result<check::Witnessed> vertex = judge_stage(variant, variant.vertex, judged);
    if (!vertex) return vertex.error();
    if (!variant.target->pixel_stage) return judged;
    const Result<check::Witnessed> pixel = judge_stage(variant, variant.pixel, judged);
    if (!pixel) return pixel.error();
    const Result<check::SpirvCost> cost =
        check::count_spirv(pixel->optimized, longest_loop(variant.program));
    if (!cost) return cost.error();
    judged.pixel_cost = *cost;
    const Result<check::Program> linked = link_bytecode(variant);
    if (!linked) return linked.error();
    judged.steps.push_back("both: stages fit each other");
    return judged;
}

}  // namespace intaglio

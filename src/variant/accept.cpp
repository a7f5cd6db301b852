// Each text is parsed once by each front end that has a say.
#include "src/variant/accept.h"

#include <fmt/format.h>

#include "src/variant/bytecode.h"

namespace intaglio {
namespace {

constexpr ir::Stage stages[] = {ir::Stage::Vertex, ir::Stage::Pixel};

std::string_view word(ir::Stage stage) { return stage == ir::Stage::Vertex ? "vertex" : "pixel"; }

Result<Accepted> accept_bytecode(const Variant& variant) {
    Accepted accepted;
    for (const ir::Stage stage : stages) {
        if (stage == ir::Stage::Pixel && !variant.target->pixel_stage) continue;
        Result<d3d9::Shader> shader = checked_stage(variant, stage);
        if (!shader) return shader.error();
        for (const std::string& step : {std::string("decoded and encoded to the same bytes"),
                                        std::string("assembly parsed to the same shader"),
                                        fmt::format("every rule of {}", name_of(shader->profile))})
            accepted.steps.push_back(fmt::format("{}: {}", word(stage), step));
        accepted.shaders.push_back(std::move(*shader));
    }
    if (!variant.target->pixel_stage) return accepted;
    Result<check::Program> program = link_bytecode(variant);
    if (!program) return program.error();
    accepted.steps.insert(accepted.steps.end(), {"both: MojoShader, glslang, spirv-val"});
    accepted.program = std::move(*program);
    return accepted;
}

}  // namespace

Result<Accepted> accept_variant(const Variant& variant) {
    if (profile_of(*variant.target)) return accept_bytecode(variant);
    const std::optional<check::Language> language = language_of(*variant.target);
    if (!language)
        return input_error("no-witness",
                           fmt::format("no witness reads target {}", variant.target->name));
    Accepted accepted;
    // GLSL as Vulkan has it and HLSL are read by one set of rules; the others by those of the
    // language first, and by those that lead to SPIR-V after.
    const bool own_rules = *language != check::Language::Glsl450 &&
                           *language != check::Language::Hlsl5 &&
                           *language != check::Language::Hlsl3;
    if (own_rules)
        for (const ir::Stage stage : stages) {
            // Parses, and keeps what later would be parsed for again.
            Result<check::Reflection> names = check::reflect_names(source_of(variant, stage));
            if (!names) return names.error();
            accepted.reflections.push_back(std::move(*names));
            accepted.steps.push_back(
                fmt::format("{}: glslang {}", word(stage), name_of(*language)));
        }
    if (!check::has_spirv(*language)) return accepted;
    Result<check::Linked> linked = check::link_and_reflect(source_of(variant, ir::Stage::Vertex),
                                                           source_of(variant, ir::Stage::Pixel));
    if (!linked) return linked.error();
    accepted.steps.push_back(
        fmt::format("both: glslang {} to SPIR-V, spirv-val, stages fit", name_of(*language)));
    accepted.program = std::move(linked->program);
    if (!own_rules) {
        accepted.reflections.push_back(std::move(linked->vertex));
        accepted.reflections.push_back(std::move(linked->pixel));
    }
    return accepted;
}

}  // namespace intaglio

// glslang, two stages: bindings and locations that agree, and a check on the binaries that they
// really do.
#include <fmt/format.h>
// glslang's mapper of names to slots has no public header of its own.
#include <glslang/MachineIndependent/iomapper.h>

#include <algorithm>

#include "src/check/frontend.h"
#include "src/check/glslang_unit.h"
#include "src/check/reflect.h"

namespace intaglio::check {
namespace {

Diagnostic disagreement(const Source& pixel, std::string message) {
    return input_error("stages-disagree", std::move(message), pixel.name);
}

std::string describe(const Reflection::Interface& value) {
    return fmt::format(
        "`{}` ({} component{}{})", value.name, value.components, value.components == 1 ? "" : "s",
        value.array_count > 1 ? fmt::format(", array of {}", value.array_count) : "");
}

// Every pixel input is fed by the vertex output meant for it.
Status check_varyings(const Reflection& vertex, const Reflection& pixel, const Source& source) {
    const bool by_name = source.language != Language::Glsl450;
    for (const Reflection::Interface& input : pixel.inputs) {
        if (!input.built_in.empty()) continue;
        const auto output = std::find_if(vertex.outputs.begin(), vertex.outputs.end(),
                                         [&](const Reflection::Interface& candidate) {
                                             return candidate.built_in.empty() &&
                                                    candidate.location == input.location;
                                         });
        if (output == vertex.outputs.end()) {
            return disagreement(
                source, fmt::format("no vertex output feeds the pixel input {} at location {}",
                                    describe(input), input.location));
        }
        if (output->components != input.components || output->array_count != input.array_count ||
            (by_name && output->name != input.name)) {
            return disagreement(
                source,
                fmt::format(
                    "the pixel input {} would be fed by the vertex output {} at location {}",
                    describe(input), describe(*output), input.location));
        }
    }
    return Done{};
}

// A block that both stages bind at one place is one buffer, so it has one layout.
Status check_blocks(const Reflection& vertex, const Reflection& pixel, const Source& source) {
    for (const Reflection::Block& block : pixel.blocks) {
        for (const Reflection::Block& other : vertex.blocks) {
            if (other.set != block.set || other.binding != block.binding) continue;
            const auto [ours, theirs] = std::mismatch(block.members.begin(), block.members.end(),
                                                      other.members.begin(), other.members.end());
            if (ours == block.members.end() && theirs == other.members.end()) continue;
            const std::string name = ours != block.members.end() ? ours->name : theirs->name;
            return disagreement(
                source,
                fmt::format("the stages lay out the block at set {}, binding {} differently, "
                            "from member `{}` on",
                            block.set, block.binding, name));
        }
    }
    return Done{};
}

Status check_sources(const Source& vertex, const Source& pixel) {
    if (vertex.stage != Stage::Vertex || pixel.stage != Stage::Pixel) {
        return input_error("stages-disagree",
                           "a program is a vertex stage and a pixel stage, in this order",
                           pixel.name);
    }
    if (vertex.language != pixel.language) {
        return input_error("language-mismatch",
                           fmt::format("the vertex stage is {} and the pixel stage {}",
                                       name_of(vertex.language), name_of(pixel.language)),
                           pixel.name);
    }
    if (!has_spirv(pixel.language)) {
        return input_error("no-spirv",
                           fmt::format("there is no SPIR-V of {}", name_of(pixel.language)),
                           pixel.name);
    }
    return Done{};
}

}  // namespace

Status link_units(glslang::TProgram& program, GlslangUnit& first, GlslangUnit* second) {
    program.addShader(&first.shader());
    if (second != nullptr) program.addShader(&second->shader());
    if (!program.link(first.messages())) return glslang_error(first.source(), program.getInfoLog());
    bool mapped = false;
    if (is_auto_mapped_glsl(first.source().language)) {
        // The default mapper numbers each stage for itself; this one matches by name across stages.
        glslang::TDefaultGlslIoResolver resolver(
            *program.getIntermediate(glslang_stage(first.source().stage)));
        glslang::TGlslIoMapper mapper;
        mapped = program.mapIO(&resolver, &mapper);
    } else {
        mapped = program.mapIO();
    }
    if (!mapped) return glslang_error(first.source(), program.getInfoLog());
    return Done{};
}

namespace {

// GLSL: one program, so that names meet across stages.
Result<Program> link_together(const Source& vertex, const Source& pixel) {
    GlslangUnit vertex_unit(vertex, Purpose::Spirv);
    GlslangUnit pixel_unit(pixel, Purpose::Spirv);
    if (Status parsed = vertex_unit.parse(); !parsed) return parsed.error();
    if (Status parsed = pixel_unit.parse(); !parsed) return parsed.error();
    glslang::TProgram program;
    if (Status linked = link_units(program, vertex_unit, &pixel_unit); !linked)
        return linked.error();
    Result<SpirvWords> vertex_words = generate(program, vertex);
    if (!vertex_words) return vertex_words.error();
    Result<SpirvWords> pixel_words = generate(program, pixel);
    if (!pixel_words) return pixel_words.error();
    return Program{std::move(*vertex_words), std::move(*pixel_words)};
}

// HLSL: registers and order of declaration decide in each stage alone, and glslang would take the
// loose uniforms of two stages for one block that contradicts itself.
Result<Program> link_apart(const Source& vertex, const Source& pixel) {
    Result<SpirvWords> vertex_words = to_spirv(vertex);
    if (!vertex_words) return vertex_words.error();
    Result<SpirvWords> pixel_words = to_spirv(pixel);
    if (!pixel_words) return pixel_words.error();
    return Program{std::move(*vertex_words), std::move(*pixel_words)};
}

}  // namespace

Result<Linked> link_and_reflect(const Source& vertex, const Source& pixel) {
    if (Status fit = check_sources(vertex, pixel); !fit) return fit.error();
    Result<Program> program =
        is_hlsl(pixel.language) ? link_apart(vertex, pixel) : link_together(vertex, pixel);
    if (!program) return program.error();
    Result<Reflection> vertex_view = reflect_valid(program->vertex);
    if (!vertex_view) return vertex_view.error();
    Result<Reflection> pixel_view = reflect_valid(program->pixel);
    if (!pixel_view) return pixel_view.error();
    if (Status fit = check_varyings(*vertex_view, *pixel_view, pixel); !fit) return fit.error();
    if (Status fit = check_blocks(*vertex_view, *pixel_view, pixel); !fit) return fit.error();
    return Linked{std::move(*program), std::move(*vertex_view), std::move(*pixel_view)};
}

Result<Program> link_to_spirv(const Source& vertex, const Source& pixel) {
    Result<Linked> linked = link_and_reflect(vertex, pixel);
    if (!linked) return linked.error();
    return std::move(linked->program);
}

}  // namespace intaglio::check

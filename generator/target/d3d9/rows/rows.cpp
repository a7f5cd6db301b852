// One generator for all rows: the profile of a row is its name.
#include "generator/target/d3d9/rows/rows.h"

#include <fmt/format.h>

#include "generator/target/clike/shell.h"
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/count_reads.h"
#include "generator/target/d3d9/generate/generate.h"
#include "generator/target/d3d9/rows/listing.h"

namespace intaglio {
namespace {

// As files hold it, least significant byte first.
std::string bytes_of(const d3d9::Shader& shader) {
    std::string bytes;
    for (const std::uint32_t token : d3d9::encode(shader))
        for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(token >> shift);
    return bytes;
}

Artifact artifact_of(const ir::Program& recorded, const Target& target, const d3d9::Shader& shader,
                     const std::vector<std::string>& interpolants) {
    Artifact artifact;
    const bool pixel = is_pixel(shader.profile);
    artifact.stage = pixel ? ir::Stage::Pixel : ir::Stage::Vertex;
    artifact.entry = "main";
    artifact.text = d3d9::listing(recorded, artifact.stage, target, shader, interpolants);
    artifact.extension = pixel ? ".psh" : ".vsh";
    artifact.bytecode = {bytes_of(shader), pixel ? ".pso" : ".vso"};
    return artifact;
}

Result<Emitted> generate(const ir::Program& recorded, const Target& target,
                         const EmitOptions& options) {
    if (options.after_each_pass)
        return input_error(
            "dump-ir", fmt::format("{} is the smallest of several attempts, so there is no one "
                                   "list of passes to show; the target none shows the common ones",
                                   target.name));
    const d3d9::Profile profile = *d3d9::profile_named(target.name);
    Emitted emitted;
    if (!target.pixel_stage) {
        Notes notes;
        const Result<d3d9::Shader> shader = d3d9::generate_vertex(recorded, profile, &notes);
        if (!shader) return shader.error();
        emitted.vertex = artifact_of(recorded, target, *shader, {});
        emitted.vertex.notes = std::move(notes);
        return emitted;
    }
    Result<d3d9::Stages> stages = d3d9::generate_program(recorded, profile);
    if (!stages) return stages.error();
    if (options.count_reads) stages->pixel = d3d9::with_read_counter(stages->pixel);
    emitted.vertex = artifact_of(recorded, target, stages->vertex, stages->interpolants);
    emitted.pixel = artifact_of(recorded, target, stages->pixel, stages->interpolants);
    emitted.vertex.notes = stages->notes;
    emitted.pixel.notes = std::move(stages->notes);
    return emitted;
}

const Capabilities model_2 = {.loops = false,
                              .branches = false,
                              .derivatives = false,
                              .texture_levels = false,
                              .texture_gradients = false,
                              .vertex_textures = false,
                              .functions = false,
                              .colour_targets = 4,
                              .texture_reads = 32,
                              .interpolants = {8, 32}};
Capabilities longer(bool gradients) {
    Capabilities can = model_2;
    can.derivatives = can.texture_gradients = gradients;
    can.texture_reads = 512;
    return can;
}
const Capabilities model_3 = {.branches = false,
                              .functions = false,
                              .colour_targets = 4,
                              .interpolants = {10, 40}};

Target row(std::string_view name, std::string_view description, Capabilities can,
           bool pixel_stage = true) {
    return {.name = name,
            .description = description,
            .derived_from = {},
            .capabilities = can,
            .legalize = {},
            .generate = generate,
            .pixel_stage = pixel_stage};
}

}  // namespace

const Target ps_2_0 = row(
    "ps_2_0", "Direct3D 9 assembly and bytecode: 64 arithmetic and 32 texture slots, with vs_2_0",
    model_2);
const Target ps_2_a = row(
    "ps_2_a", "Direct3D 9 assembly and bytecode: 512 slots, any swizzle, gradients, with vs_2_0",
    longer(true));
const Target ps_2_b =
    row("ps_2_b", "Direct3D 9 assembly and bytecode: 512 slots, 32 temporaries, with vs_2_0",
        longer(false));
const Target ps_3_0 =
    row("ps_3_0", "Direct3D 9 assembly and bytecode: loops, levels and gradients, with vs_3_0",
        model_3);
const Target vs_2_0 =
    row("vs_2_0", "Direct3D 9 assembly and bytecode: the vertex stage alone, for ps_2_0, 2_a, 2_b",
        model_2, false);
const Target vs_3_0 =
    row("vs_3_0", "Direct3D 9 assembly and bytecode: the vertex stage alone, for ps_3_0", model_3,
        false);

}  // namespace intaglio

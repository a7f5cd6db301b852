// Straight code reads a number of textures that is known here; flow is counted as it runs.
#include "generator/target/d3d9/count_reads.h"

#include <algorithm>
#include <bit>

#include "generator/target/d3d9/ops.h"
#include "generator/target/d3d9/resources.h"

namespace intaglio::d3d9 {
namespace {

bool reads_texture(Opcode op) {
    return op == Opcode::Texld || op == Opcode::Texldb || op == Opcode::Texldp ||
           op == Opcode::Texldd || op == Opcode::Texldl;
}

bool has_flow(const Shader& shader) {
    return std::any_of(
        shader.instructions.begin(), shader.instructions.end(), [](const Instruction& instruction) {
            return info(instruction.op).has(Trait::Opens) || instruction.op == Opcode::Call ||
                   instruction.op == Opcode::CallNz;
        });
}

Source source_of(File file, int index, Swizzle swizzle = identity_swizzle) {
    Source source;
    source.file = file;
    source.index = index;
    source.swizzle = swizzle;
    return source;
}

Instruction to(Opcode op, File file, int index, Mask mask, std::vector<Source> sources) {
    Instruction instruction;
    instruction.op = op;
    instruction.destination = Destination{.file = file, .index = index, .mask = mask};
    instruction.sources = std::move(sources);
    return instruction;
}

}  // namespace

Shader with_read_counter(const Shader& shader) {
    Shader result = shader;
    const Resources used = count(shader);
    const int constant = used.constants;
    const auto reads = std::count_if(shader.instructions.begin(), shader.instructions.end(),
                                     [](const Instruction& i) { return reads_texture(i.op); });
    Definition definition;
    definition.index = constant;
    const bool flow = has_flow(shader);
    definition.bits = {std::bit_cast<std::uint32_t>(flow ? 1.0f : static_cast<float>(reads)), 0, 0,
                       0};
    result.definitions.push_back(definition);
    if (!flow) {
        result.instructions.push_back(to(Opcode::Mov, File::ColourOut, used.colour_outputs,
                                         full_mask, {source_of(File::Const, constant)}));
        return result;
    }
    const int counter = used.temps;
    result.instructions = {to(Opcode::Mov, File::Temp, counter, full_mask,
                              {source_of(File::Const, constant, replicate(1))})};
    for (const Instruction& instruction : shader.instructions) {
        result.instructions.push_back(instruction);
        if (reads_texture(instruction.op))
            result.instructions.push_back(to(Opcode::Add, File::Temp, counter, 1,
                                             {source_of(File::Temp, counter, replicate(0)),
                                              source_of(File::Const, constant, replicate(0))}));
    }
    result.instructions.push_back(to(Opcode::Mov, File::ColourOut, used.colour_outputs, full_mask,
                                     {source_of(File::Temp, counter)}));
    return result;
}

}  // namespace intaglio::d3d9

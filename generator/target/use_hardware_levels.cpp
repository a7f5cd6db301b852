// The coordinate stays, every other operand goes.
#include "generator/target/use_hardware_levels.h"

#include <set>

#include <fmt/format.h>

#include "generator/passes/remove_dead_code.h"

namespace intaglio {
namespace {

using ir::Instruction;
using ir::Op;

// "1 read at level 0", "3 reads with gradients"; empty if there is none.
std::string reads(int count, std::string_view how) {
    if (count == 0) return {};
    return fmt::format("{} read{} {}", count, count == 1 ? "" : "s", how);
}

}  // namespace

Status use_hardware_levels(ir::Module& module, const Target& target, Notes& notes) {
    if (module.stage == ir::Stage::Vertex) return Done{};
    std::set<ir::ValueId> zeros;
    int at_level_0 = 0, with_gradients = 0;
    for (Instruction& instruction : module.body.body) {
        if (instruction.op == Op::Constant && module.type(instruction.result()) == ir::float1 &&
            ir::constant_float(instruction, 0) == 0.0f)
            zeros.insert(instruction.result());
        const bool finest =
            instruction.op == Op::SampleLevel && zeros.contains(instruction.operands[1]);
        if (!finest && instruction.op != Op::SampleGrad) continue;
        ++(finest ? at_level_0 : with_gradients);
        instruction.op = Op::SampleImplicit;
        instruction.operands.resize(1);
    }
    if (at_level_0 + with_gradients == 0) return Done{};
    passes::remove_dead_code(module);
    const std::string levels = reads(at_level_0, "at level 0");
    const std::string gradients = reads(with_gradients, "with gradients");
    notes.push_back(fmt::format(
        "{}: the hardware chooses the level of {}{}{}, since {} has only reads of that kind: "
        "textures of one level give the result of the other targets, a mipmapped one blurs where "
        "its coordinate jumps",
        module.name, levels, levels.empty() || gradients.empty() ? "" : " and ", gradients,
        target.name));
    return Done{};
}

}  // namespace intaglio

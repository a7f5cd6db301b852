// The coordinate stays, the gradients go.
#include "generator/target/d3d9/generate/drop_gradients.h"

#include <fmt/format.h>

#include "generator/passes/remove_dead_code.h"
#include "generator/passes/remove_unused_interpolants.h"

namespace intaglio::d3d9 {

void drop_gradients(ir::Program& program, Profile profile, std::vector<std::string>& notes) {
    if (profile != Profile::ps_2_0 && profile != Profile::ps_2_b) return;
    ir::Module& module = program.pixel;
    for (ir::Instruction& instruction : module.body.body) {
        if (instruction.op != ir::Op::SampleGrad) continue;
        instruction.op = ir::Op::SampleImplicit;
        instruction.operands.resize(1);
        notes.push_back(fmt::format(
            "{} is read by texld: its level follows the displaced coordinate, {} has no gradients.",
            module.samplers[static_cast<std::size_t>(instruction.slot)].name, name_of(profile)));
    }
    passes::remove_dead_code(module);
    passes::remove_unused_interpolants(program);
}

}  // namespace intaglio::d3d9

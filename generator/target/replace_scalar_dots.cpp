// One walk; the operands stay as they are.
#include "generator/target/replace_scalar_dots.h"

namespace intaglio {
namespace {

void replace_in(const ir::Module& module, ir::Region& region) {
    for (ir::Instruction& instruction : region.body) {
        if (instruction.op == ir::Op::Dot && module.type(instruction.operands[0]).width == 1)
            instruction.op = ir::Op::Mul;
        for (ir::Region& inner : instruction.regions) replace_in(module, inner);
    }
}

}  // namespace

Status replace_scalar_dots(ir::Module& module, const Target&, Notes&) {
    replace_in(module, module.body);
    return Done{};
}

}  // namespace intaglio

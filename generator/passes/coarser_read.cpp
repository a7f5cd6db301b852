// Constants that are a level are few; regions are walked in order of execution.
#include "generator/passes/coarser_read.h"

#include <set>

namespace intaglio::passes {
namespace {

const ir::Instruction* find_in(const ir::Module& module, const ir::Region& region,
                               std::set<ir::ValueId>& levels) {
    for (const ir::Instruction& instruction : region.body) {
        if (instruction.op == ir::Op::Constant &&
            module.type(instruction.result()) == ir::float1 &&
            ir::constant_float(instruction, 0) != 0.0f)
            levels.insert(instruction.result());
        if (instruction.op == ir::Op::SampleLevel && levels.contains(instruction.operands[1]))
            return &instruction;
        for (const ir::Region& inner : instruction.regions)
            if (const ir::Instruction* found = find_in(module, inner, levels)) return found;
    }
    return nullptr;
}

}  // namespace

const ir::Instruction* find_coarser_read(const ir::Module& module) {
    std::set<ir::ValueId> levels;
    return find_in(module, module.body, levels);
}

}  // namespace intaglio::passes

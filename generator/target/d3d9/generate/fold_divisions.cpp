// One walk: operands are defined before they are used.
#include "generator/target/d3d9/generate/fold_divisions.h"

#include <bit>
#include <map>

#include "generator/passes/rewrite.h"

namespace intaglio::d3d9 {

void fold_divisions(ir::Module& module) {
    std::map<ir::ValueId, std::array<std::uint32_t, 4>> constants;
    passes::for_each_instruction(module.body, [&](ir::Instruction& instruction) {
        if (instruction.op == ir::Op::Div) {
            const auto a = constants.find(instruction.operands[0]);
            const auto b = constants.find(instruction.operands[1]);
            if (a == constants.end() || b == constants.end()) return;
            std::array<std::uint32_t, 4> bits{};
            for (std::size_t k = 0; k < 4; ++k)
                if (std::bit_cast<float>(b->second[k]) != 0)
                    bits[k] = std::bit_cast<std::uint32_t>(std::bit_cast<float>(a->second[k]) /
                                                           std::bit_cast<float>(b->second[k]));
                else if (static_cast<int>(k) < module.type(instruction.result()).width)
                    return;
            instruction.op = ir::Op::Constant;
            instruction.operands.clear();
            instruction.bits = bits;
        }
        if (instruction.op == ir::Op::Constant) constants[instruction.result()] = instruction.bits;
    });
}

}  // namespace intaglio::d3d9

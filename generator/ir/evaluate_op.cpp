// Kernels from instructions, and one instruction on constants.
#include "generator/ir/evaluate.h"
#include "generator/ir/kernel.h"

namespace intaglio::ir {

Kernel make_kernel(const Instruction& instruction, const Type* operand_types, int result_width) {
    Kernel kernel;
    kernel.op = instruction.op;
    kernel.operand_count = static_cast<int>(std::min(instruction.operands.size(), max_operands));
    for (std::size_t i = 0; i < static_cast<std::size_t>(kernel.operand_count); ++i)
        kernel.widths[i] = static_cast<std::uint8_t>(operand_types[i].width);
    const Type computed = operand_types[instruction.op == Op::Select ? 1 : 0];
    kernel.scalar = computed.scalar;
    kernel.width = instruction.op == Op::Swizzle ? result_width : computed.width;
    kernel.lanes = instruction.lanes;
    return kernel;
}

std::optional<ConstantBits> evaluate_op(const Instruction& instruction,
                                        std::span<const Type> operand_types,
                                        std::span<const ConstantBits> operands, int result_width) {
    if (!is_pure(instruction.op)) return std::nullopt;
    const Kernel kernel = make_kernel(instruction, operand_types.data(), result_width);
    Compute<Arithmetic<float>>::Operands pointers{};
    for (std::size_t i = 0; i < std::min(operands.size(), max_operands); ++i)
        pointers[i] = operands[i].data();
    ConstantBits result{};
    Compute<Arithmetic<float>>::run(kernel, pointers, result.data());
    return result;
}

}  // namespace intaglio::ir

// Part of fold_constants: swizzles and compositions.
#pragma once

#include "generator/ir/module.h"
#include "generator/passes/rewrite.h"

namespace intaglio::passes {

// Turns an instruction that is nothing but its operand into a mark: op Yield with that operand. The
// caller replaces the result by the operand and drops the instruction.
void become_operand(ir::Instruction& instruction, ir::ValueId operand);

// Rewrites a swizzle of a swizzle, of a composition, or in order, and a composition of
// compositions, of the lanes of one vector, or of one scalar repeated.  True if the instruction
// changed.  Bit-exact: components only move.
bool simplify_shape(const ir::Module& module, const Definitions& definitions,
                    ir::Instruction& instruction);

}  // namespace intaglio::passes

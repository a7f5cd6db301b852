// Movs to outputs go where the instructions before them can write the output themselves.
#include "generator/target/d3d9/generate/code.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

// The lanes that an instruction sees of a virtual register.
Mask lanes_read(const VirtualInstruction& instruction, int target) {
    unsigned lanes = 0;
    for (const VirtualSource& source : instruction.sources) {
        if (source.kind != VirtualSource::Kind::Temp || source.index != target) continue;
        for (std::size_t k = 0; k < 4; ++k)
            if ((positions_read(instruction) >> k & 1) != 0) lanes |= 1u << source.swizzle[k];
    }
    return static_cast<Mask>(lanes);
}

bool is_plain_move(const VirtualInstruction& mov) {
    if (mov.op != Opcode::Mov || mov.output < 0 || mov.saturate) return false;
    const VirtualSource& source = mov.sources[0];
    if (source.kind != VirtualSource::Kind::Temp || source.negate) return false;
    for (std::size_t k = 0; k < 4; ++k)
        if ((mov.mask >> k & 1) != 0 && source.swizzle[k] != k) return false;
    return true;
}

bool can_go(const Code& code, std::size_t index) {
    const VirtualInstruction& mov = code.instructions[index];
    const int target = mov.sources[0].index;
    for (std::size_t i = 0; i < code.instructions.size(); ++i) {
        const VirtualInstruction& other = code.instructions[i];
        if (i != index && (lanes_read(other, target) & mov.mask) != 0) return false;
        if (other.target != target || (other.mask & mov.mask) == 0) continue;
        if ((other.mask & ~mov.mask) != 0 || info(other.op).has(Trait::Macro) || other.sampler >= 0)
            return false;
    }
    return true;
}

}  // namespace

void write_outputs_directly(Code& code) {
    for (std::size_t i = 0; i < code.instructions.size();) {
        const VirtualInstruction mov = code.instructions[i];
        if (!is_plain_move(mov) || !can_go(code, i)) {
            ++i;
            continue;
        }
        const int target = mov.sources[0].index;
        for (VirtualInstruction& writer : code.instructions)
            if (writer.target == target && (writer.mask & mov.mask) != 0) {
                writer.target = -1;
                writer.output = mov.output;
            }
        Mask& lanes = code.lanes[static_cast<std::size_t>(target)];
        lanes = static_cast<Mask>(lanes & ~mov.mask);
        code.instructions.erase(code.instructions.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

}  // namespace intaglio::d3d9

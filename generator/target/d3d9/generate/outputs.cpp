// Movs to outputs, and to what texkill tests, go where the instructions before them can write
// there themselves.
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

// The one instruction that writes the lane and may as well write others with the same value.
VirtualInstruction* only_writer(Code& code, int target, int lane) {
    VirtualInstruction* found = nullptr;
    for (VirtualInstruction& instruction : code.instructions) {
        if (instruction.target != target || (instruction.mask >> lane & 1) == 0) continue;
        if (found != nullptr) return nullptr;
        found = &instruction;
    }
    const bool repeats = found != nullptr && found->mask == 1 << lane &&
                         (is_componentwise(found->op) || is_scalar(found->op) || is_dot(found->op));
    return repeats ? found : nullptr;
}

void repeat_lane(VirtualInstruction& instruction, std::size_t lane) {
    for (VirtualSource& source : instruction.sources) {
        if (!is_componentwise(instruction.op)) continue;
        if (source.kind == VirtualSource::Kind::Constant) {
            source.wanted.bits.fill(source.wanted.bits[lane]);
            source.wanted.mask = full_mask;
        } else {
            source.swizzle = replicate(source.swizzle[lane]);
        }
    }
    instruction.mask = full_mask;
}

// Whether it did anything: the mov is then idle.
bool compute_in_place_of(Code& code, std::size_t index) {
    const VirtualInstruction& mov = code.instructions[index];
    const VirtualSource source = mov.sources[0];
    if (mov.op != Opcode::Mov || mov.saturate || source.negate || mov.mask != full_mask ||
        source.kind != VirtualSource::Kind::Temp)
        return false;
    const int lane = source.swizzle[0];
    for (std::size_t i = 0; i < code.instructions.size(); ++i)
        if (i != index && (lanes_read(code.instructions[i], source.index) >> lane & 1) != 0)
            return false;
    VirtualInstruction* writer = only_writer(code, source.index, lane);
    if (writer == nullptr) return false;
    repeat_lane(*writer, static_cast<std::size_t>(lane));
    writer->target = mov.target;
    Mask& lanes = code.lanes[static_cast<std::size_t>(source.index)];
    lanes = static_cast<Mask>(lanes & ~(1 << lane));
    return true;
}

}  // namespace

void compute_in_tested_lanes(Code& code) {
    for (std::size_t k = 0; k < code.instructions.size(); ++k) {
        if (code.instructions[k].op != Opcode::Texkill) continue;
        const int tested = code.instructions[k].sources[0].index;
        for (std::size_t i = 0; i < k; ++i)
            if (code.instructions[i].target == tested && compute_in_place_of(code, i)) {
                code.instructions.erase(code.instructions.begin() + static_cast<std::ptrdiff_t>(i));
                --k;
                break;
            }
    }
}

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

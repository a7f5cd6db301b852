// What the passes over code with loops ask: who reads which lanes, where execution goes on, which
// lanes are read later.
#include "generator/target/d3d9/generate/flow_code.h"

#include <algorithm>

#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {

int slots_of(const FlowCode& code) {
    int slots = 0;
    for (const VirtualInstruction& instruction : code.instructions)
        slots += info(instruction.op).arithmetic_slots + info(instruction.op).texture_slots;
    return slots;
}

Mask positions_of_source(const FlowCode& code, const VirtualInstruction& instruction,
                         std::size_t source) {
    if (instruction.op == Opcode::Texkill) return instruction.mask;
    switch (info(instruction.op).lanes) {
        case Lanes::None: return 0;
        case Lanes::First: return 0x1;
        case Lanes::Masked: return instruction.mask;
        case Lanes::Dot2: return source == 2 ? 0x1 : 0x3;
        case Lanes::Dot3: return 0x7;
        case Lanes::Normalize: return static_cast<Mask>(instruction.mask | 0x7);
        case Lanes::Coordinate: {
            const bool flat = code.samplers[static_cast<std::size_t>(instruction.sampler)] ==
                              SamplerKind::Texture2D;
            const Mask place = flat ? 0x3 : 0x7;
            const bool level = instruction.op == Opcode::Texldl && source == 0;
            return level ? static_cast<Mask>(place | 0x8) : place;
        }
        default: return full_mask;
    }
}

bool writes(const VirtualInstruction& instruction) { return instruction.target >= 0; }

bool is_copy(const VirtualInstruction& instruction) {
    return instruction.op == Opcode::Mov && !instruction.saturate;
}

std::vector<int> loops_of(const FlowCode& code) {
    std::vector<int> result(code.instructions.size(), -1), open;
    for (std::size_t i = 0; i < result.size(); ++i) {
        const Opcode op = code.instructions[i].op;
        if (op == Opcode::Rep) open.push_back(static_cast<int>(i));
        if (!open.empty()) result[i] = open.back();
        if (op == Opcode::EndRep) open.pop_back();
    }
    return result;
}

std::vector<std::array<int, 2>> successors_of(const FlowCode& code) {
    const int count = static_cast<int>(code.instructions.size());
    const std::vector<int> loops = loops_of(code);
    std::vector<int> end(code.instructions.size(), -1);
    for (int i = 0; i < count; ++i)
        if (code.instructions[static_cast<std::size_t>(i)].op == Opcode::EndRep)
            end[static_cast<std::size_t>(loops[static_cast<std::size_t>(i)])] = i;
    std::vector<std::array<int, 2>> result;
    for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        std::array<int, 2> next = {i + 1, -1};
        // Every rep here runs at least once.
        if (code.instructions[at].op == Opcode::EndRep) next[1] = loops[at] + 1;
        if (code.instructions[at].op == Opcode::BreakComp)
            next[1] = end[static_cast<std::size_t>(loops[at])] + 1;
        result.push_back(next);
    }
    return result;
}

// texkill takes neither sign nor swizzle; which lane is which does not matter to it.
static bool tests_whole_register(const VirtualSource& source) {
    Mask seen = 0;
    for (const std::uint8_t lane : source.swizzle) seen = static_cast<Mask>(seen | (1 << lane));
    return source.kind == VirtualSource::Kind::Temp && !source.negate && !source.absolute &&
           seen == full_mask;
}

bool obeys_ports(const VirtualInstruction& instruction) {
    if (instruction.op == Opcode::Texkill) return tests_whole_register(instruction.sources[0]);
    int input = -1, uniform = -1, plain = 0, absolute = 0;
    std::vector<std::uint32_t> values;
    for (std::size_t s = 0; s < instruction.sources.size(); ++s) {
        const VirtualSource& source = instruction.sources[s];
        if (instruction.sampler >= 0 && (source.negate || source.absolute)) return false;
        switch (source.kind) {
            case VirtualSource::Kind::Temp: break;
            case VirtualSource::Kind::Input:
                if (input >= 0 && input != source.index) return false;
                input = source.index;
                break;
            case VirtualSource::Kind::Uniform:
                if (uniform >= 0 && uniform != source.index) return false;
                uniform = source.index;
                ++(source.absolute ? absolute : plain);
                break;
            case VirtualSource::Kind::Constant:
                if (instruction.sampler >= 0) return false;
                for (std::size_t k = 0; k < 4; ++k)
                    if ((source.wanted.mask >> k & 1) != 0) values.push_back(source.wanted.bits[k]);
                ++(source.absolute ? absolute : plain);
                break;
        }
    }
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    if (!values.empty() && uniform >= 0) return false;
    return values.size() <= 4 && (plain == 0 || absolute == 0);
}

LaneSets live_after(const FlowCode& code) {
    const std::size_t count = code.instructions.size();
    const auto successors = successors_of(code);
    LaneSets after(count, code.registers), read = after, written = after;
    LaneSets before(count + 1, code.registers);  // the last: at the end
    for (int k = 0; k < code.outputs; ++k)
        for (int lane = 0; lane < 4; ++lane) before.insert(count, k, lane);
    for (std::size_t i = 0; i < count; ++i) {
        const VirtualInstruction& instruction = code.instructions[i];
        if (writes(instruction))
            for (int lane = 0; lane < 4; ++lane)
                if ((instruction.mask >> lane & 1) != 0)
                    written.insert(i, instruction.target, lane);
        for (std::size_t s = 0; s < instruction.sources.size(); ++s) {
            const VirtualSource& source = instruction.sources[s];
            if (source.kind != VirtualSource::Kind::Temp) continue;
            const Mask positions = positions_of_source(code, instruction, s);
            for (std::size_t k = 0; k < 4; ++k)
                if ((positions >> k & 1) != 0) read.insert(i, source.index, source.swizzle[k]);
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = count; i-- > 0;) {
            const auto [first, second] = successors[i];
            const std::uint64_t* one = before.words(static_cast<std::size_t>(first));
            const std::uint64_t* other =
                second < 0 ? one : before.words(static_cast<std::size_t>(second));
            for (std::size_t k = 0; k < after.width(); ++k) {
                const std::uint64_t live = one[k] | other[k];
                after.words(i)[k] = live;
                const std::uint64_t needed = (live & ~written.words(i)[k]) | read.words(i)[k];
                changed = changed || needed != before.words(i)[k];
                before.words(i)[k] = needed;
            }
        }
    }
    return after;
}

void drop_unused_registers(FlowCode& code) {
    std::vector<int> number(static_cast<std::size_t>(code.registers), -1);
    int next = 0;
    const auto use = [&](int reg) {
        int& mine = number[static_cast<std::size_t>(reg)];
        if (mine < 0) mine = next++;
        return mine;
    };
    for (int k = 0; k < code.outputs; ++k) use(k);
    for (VirtualInstruction& instruction : code.instructions) {
        if (writes(instruction)) instruction.target = use(instruction.target);
        for (VirtualSource& source : instruction.sources)
            if (source.kind == VirtualSource::Kind::Temp) source.index = use(source.index);
    }
    code.registers = next;
}

void tidy(FlowCode& code) {
    for (bool changed = true; changed;) {
        drop_unused_registers(code);
        changed = propagate_copies(code);
        changed = remove_dead_lanes(code) || changed;
        changed = remove_idle_loops(code) || changed;
        changed = hoist_copies(code) || changed;
        drop_unused_registers(code);
        changed = coalesce(code) || changed;
        changed = fuse(code) || changed;
    }
}

}  // namespace intaglio::d3d9

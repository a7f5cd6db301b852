// Checks what the machine relies on, once per shader: register indexes, operand counts, blocks.
#include <fmt/format.h>

#include <optional>

#include "generator/target/d3d9/interpret_prepared.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

using Failure = std::optional<Diagnostic>;

Diagnostic malformed(std::size_t at, const std::string& what) {
    return input_error("d3d9-malformed", fmt::format("instruction {}: {}", at, what));
}

// Registers of a file that can be read or written; 0: not as an operand.
int register_count(File file) {
    switch (file) {
        case File::Temp: return temp_count;
        case File::Const: return constant_count;
        case File::Input:
        case File::Sampler: return 16;
        case File::Texture:
        case File::TexcoordOut: return 8;
        case File::ConstInt:
        case File::ConstBool: return flow_constant_count;
        case File::ColourOut: return 4;
        case File::AttributeOut: return 2;
        case File::Output: return 12;
        case File::Address:
        case File::LoopCounter:
        case File::Predicate:
        case File::DepthOut:
        case File::PositionOut:
        case File::FogOut:
        case File::PointSizeOut:
        case File::Position:
        case File::Face: return 1;
        case File::Label: return 2048;
    }
    return 0;
}

int output_of_file(const Destination& destination) {
    switch (destination.file) {
        case File::ColourOut: return colour_slot + destination.index;
        case File::DepthOut: return depth_slot;
        case File::PositionOut: return position_slot;
        case File::FogOut: return fog_slot;
        case File::PointSizeOut: return point_size_slot;
        case File::AttributeOut: return diffuse_slot + destination.index;
        case File::TexcoordOut: return texcoord_slot + destination.index;
        case File::Output: return output_slot + destination.index;
        default: return -1;
    }
}

bool in_range(File file, int index) { return index >= 0 && index < register_count(file); }

Failure check_destination(std::size_t at, const Instruction& instruction) {
    const OpInfo& row = info(instruction.op);
    if (row.has_destination() != instruction.destination.has_value()) {
        return malformed(at, fmt::format("{} {} a destination", row.mnemonic,
                                         row.has_destination() ? "needs" : "has no"));
    }
    if (!instruction.destination) return {};
    const Destination& destination = *instruction.destination;
    const File file = destination.file;
    const bool temporary =
        file == File::Temp || file == File::Address || file == File::Predicate ||
        (row.has(Trait::ReadsDestination) && (file == File::Texture || file == File::Input));
    if ((!temporary && output_of_file(destination) < 0) || !in_range(file, destination.index) ||
        destination.mask > full_mask) {
        return malformed(at, fmt::format("the destination of {} is no register that can be written",
                                         row.mnemonic));
    }
    if ((file == File::Predicate) != (instruction.op == Opcode::SetP) ||
        (file == File::Address && instruction.op != Opcode::Mova)) {
        return malformed(at, fmt::format("{} cannot write this register", row.mnemonic));
    }
    if (destination.relative &&
        (file != File::Output || destination.relative->file != File::LoopCounter)) {
        return malformed(at, "only o# can be written relatively, by aL");
    }
    return {};
}

Failure check_source(std::size_t at, const Instruction& instruction, const Source& source) {
    const OpInfo& row = info(instruction.op);
    const auto refused = [&](std::string_view why) {
        return malformed(at, fmt::format("a source of {} {}", row.mnemonic, why));
    };
    if (!in_range(source.file, source.index)) return refused("is a register out of range");
    for (const std::uint8_t component : source.swizzle)
        if (component > 3) return refused("has a swizzle beyond w");
    if (source.relative) {
        const auto& relative = *source.relative;
        const bool file = relative.file == File::Address || relative.file == File::LoopCounter;
        if (!file || relative.component < 0 || relative.component > 3)
            return refused("is addressed by a register that is neither a0 nor aL");
        if (source.file != File::Const && source.file != File::Input)
            return refused("is addressed relatively and neither a constant nor an input");
    }
    return {};
}

// Which files an instruction's sources may come from, where it is not the readable vectors.
bool is_expected(const Instruction& instruction, std::size_t source) {
    const File file = instruction.sources[source].file;
    switch (instruction.op) {
        case Opcode::Call: return file == File::Label;
        case Opcode::Label: return file == File::Label;
        case Opcode::CallNz:
            return source == 0 ? file == File::Label
                               : file == File::ConstBool || file == File::Predicate;
        case Opcode::If: return file == File::ConstBool || file == File::Predicate;
        case Opcode::BreakP: return file == File::Predicate;
        case Opcode::Rep: return file == File::ConstInt;
        case Opcode::Loop: return file == (source == 0 ? File::LoopCounter : File::ConstInt);
        default: break;
    }
    if (info(instruction.op).has(Trait::Texture) && source == 1) return file == File::Sampler;
    return file == File::Temp || file == File::Const || file == File::Input ||
           file == File::Texture || file == File::Position || file == File::Face;
}

Failure check_operands(std::size_t at, const Instruction& instruction, Profile profile) {
    const OpInfo& row = info(instruction.op);
    if (auto failure = check_destination(at, instruction)) return failure;
    const auto needed = static_cast<std::size_t>(source_count(instruction.op, profile));
    if (instruction.sources.size() != needed) {
        return malformed(at, fmt::format("{} takes {} sources and has {}", row.mnemonic, needed,
                                         instruction.sources.size()));
    }
    for (std::size_t i = 0; i < needed; ++i) {
        if (auto failure = check_source(at, instruction, instruction.sources[i])) return failure;
        if (!is_expected(instruction, i))
            return malformed(
                at, fmt::format("source {} of {} is of the wrong kind", i + 1, row.mnemonic));
    }
    if (row.has(Trait::Compares) && instruction.comparison == Comparison::None)
        return malformed(at, fmt::format("{} has no comparison", row.mnemonic));
    if (instruction.predicate && instruction.predicate->file != File::Predicate)
        return malformed(at, "the predicate is not p0");
    if (instruction.predicate) return check_source(at, instruction, *instruction.predicate);
    return {};
}

// Matches ifs, loops and breaks, then calls with labels.
class Blocks {
  public:
    explicit Blocks(std::vector<Interpreter::Prepared::Step>& steps) : steps_(steps) {}

    Failure match() {
        for (std::size_t at = 0; at < steps_.size(); ++at)
            if (auto failure = visit(at)) return failure;
        if (!open_.empty()) return malformed(open_.back(), "the block is never closed");
        for (std::size_t at = 0; at < steps_.size(); ++at) {
            const Opcode op = op_at(at);
            if (op != Opcode::Call && op != Opcode::CallNz) continue;
            const int label = steps_[at].instruction.sources[0].index;
            steps_[at].target = find_label(label);
            if (steps_[at].target < 0)
                return malformed(at, fmt::format("there is no label l{}", label));
        }
        return {};
    }

  private:
    Opcode op_at(std::size_t at) const { return steps_[at].instruction.op; }

    Failure visit(std::size_t at) {
        switch (op_at(at)) {
            case Opcode::If:
            case Opcode::IfComp:
            case Opcode::Rep:
            case Opcode::Loop: open_.push_back(at); return {};
            case Opcode::Else: {
                if (auto failure = close(at, {Opcode::If, Opcode::IfComp})) return failure;
                open_.push_back(at);
                return {};
            }
            case Opcode::EndIf: return close(at, {Opcode::If, Opcode::IfComp, Opcode::Else});
            case Opcode::EndRep: return close_loop(at, Opcode::Rep);
            case Opcode::EndLoop: return close_loop(at, Opcode::Loop);
            case Opcode::Break:
            case Opcode::BreakComp:
            case Opcode::BreakP: return in_loop(at);
            case Opcode::Ret:
            case Opcode::Label:
                if (!open_.empty()) return malformed(at, "a routine ends inside a block");
                return {};
            default: return {};
        }
    }

    Failure close(std::size_t at, std::initializer_list<Opcode> openers) {
        for (const Opcode opener : openers) {
            if (open_.empty() || op_at(open_.back()) != opener) continue;
            steps_[open_.back()].target = static_cast<int>(at);
            open_.pop_back();
            return {};
        }
        return malformed(at, fmt::format("{} closes nothing", info(op_at(at)).mnemonic));
    }

    Failure close_loop(std::size_t at, Opcode opener) {
        if (!open_.empty()) steps_[at].target = static_cast<int>(open_.back());
        return close(at, {opener});
    }

    Failure in_loop(std::size_t at) {
        for (const std::size_t opener : open_)
            if (op_at(opener) == Opcode::Rep || op_at(opener) == Opcode::Loop) return {};
        return malformed(at, "break outside a loop");
    }

    int find_label(int label) const {
        for (std::size_t at = 0; at < steps_.size(); ++at)
            if (op_at(at) == Opcode::Label && steps_[at].instruction.sources[0].index == label)
                return static_cast<int>(at);
        return -1;
    }

    std::vector<Interpreter::Prepared::Step>& steps_;
    std::vector<std::size_t> open_;
};

Failure read_definitions(Interpreter::Prepared& into, const Shader& shader) {
    for (const Definition& definition : shader.definitions) {
        const auto index = static_cast<std::size_t>(definition.index);
        if (!in_range(definition.file, definition.index) ||
            (definition.file != File::Const && definition.file != File::ConstInt &&
             definition.file != File::ConstBool)) {
            return input_error("d3d9-malformed", "a definition names no constant register");
        }
        if (definition.file == File::ConstBool) {
            into.boolean_defined[index] = true;
            into.boolean_definitions[index] = definition.bits[0] != 0;
            continue;
        }
        const bool is_float = definition.file == File::Const;
        (is_float ? into.defined[index] : into.integer_defined[index]) = true;
        for (std::size_t i = 0; i < 4; ++i) {
            if (is_float)
                into.definitions[index][i] = std::bit_cast<float>(definition.bits[i]);
            else
                into.integer_definitions[index][i] = std::bit_cast<int>(definition.bits[i]);
        }
    }
    return {};
}

Failure check_samplers(const Shader& shader) {
    for (const Declaration& declaration : shader.declarations) {
        if (declaration.sampler != SamplerKind::Cube) continue;
        return input_error("d3d9-cube-texture",
                           fmt::format("sampler s{} is a cube texture, which the interpreter "
                                       "cannot read",
                                       declaration.target.index));
    }
    return {};
}

}  // namespace

Result<Interpreter> Interpreter::prepare(const Shader& shader) {
    auto prepared = std::make_shared<Prepared>();
    prepared->loses_sincos = shader.profile != Profile::ps_3_0 && shader.profile != Profile::vs_3_0;
    if (auto failure = read_definitions(*prepared, shader)) return *failure;
    if (auto failure = check_samplers(shader)) return *failure;
    for (std::size_t at = 0; at < shader.instructions.size(); ++at) {
        const Instruction& instruction = shader.instructions[at];
        if (auto failure = check_operands(at, instruction, shader.profile)) return *failure;
        Prepared::Step& step = prepared->steps.emplace_back();
        step.instruction = instruction;
        if (instruction.destination) step.output = output_of_file(*instruction.destination);
        if (info(instruction.op).has(Trait::Texture) && instruction.sources.size() > 1)
            step.sampler = instruction.sources[1].index;
    }
    if (auto failure = Blocks(prepared->steps).match()) return *failure;
    Interpreter interpreter;
    interpreter.prepared_ = std::move(prepared);
    return interpreter;
}

}  // namespace intaglio::d3d9

// The builder: type rules to result types, and a stack of open regions.
#include "generator/ir/builder.h"

#include <cassert>

namespace intaglio::ir {

Type result_type(Op op, std::span<const Type> operands, int swizzle_width) {
    switch (info(op).type_rule) {
        case TypeRule::SameNumeric:
        case TypeRule::SameFloat: return operands[0];
        case TypeRule::Dot: return float1;
        case TypeRule::Cross: return float3;
        case TypeRule::Compare:
        case TypeRule::Logic: return bool1;
        case TypeRule::Select: return operands[1];
        case TypeRule::ToFloat: return {Scalar::Float, operands[0].width};
        case TypeRule::Compose: {
            int width = 0;
            for (Type type : operands) width += type.width;
            return {operands[0].scalar, width};
        }
        case TypeRule::Swizzle: return {operands[0].scalar, swizzle_width};
        case TypeRule::Sample: return float4;
        default: assert(!"the type rule of this op does not give a result type"); return {};
    }
}

Builder::Builder(Module& module) : module_(module) {}

Region& Builder::current_region() { return frames_.empty() ? module_.body : frames_.back().region; }

Instruction Builder::make(Op op, std::span<const ValueId> operands) const {
    Instruction instruction;
    instruction.op = op;
    instruction.operands.assign(operands.begin(), operands.end());
    instruction.origin = origin_;
    return instruction;
}

void Builder::append(Instruction instruction) {
    current_region().body.push_back(std::move(instruction));
}

ValueId Builder::constant(Type type, std::array<std::uint32_t, 4> bits) {
    Instruction instruction = make(Op::Constant, {});
    instruction.bits = bits;
    const ValueId result = module_.add_value(type);
    instruction.results = {result};
    append(std::move(instruction));
    return result;
}

ValueId Builder::constant(float value) { return constant(float1, {float_bits(value)}); }
ValueId Builder::constant(int value) { return constant(int1, {static_cast<std::uint32_t>(value)}); }
ValueId Builder::constant(bool value) { return constant(bool1, {value ? 1u : 0u}); }

ValueId Builder::input(int slot) {
    Instruction instruction = make(Op::Input, {});
    instruction.slot = slot;
    const Declaration& declaration = module_.inputs[static_cast<std::size_t>(slot)];
    const ValueId result = module_.add_value(declaration.type, declaration.name);
    instruction.results = {result};
    append(std::move(instruction));
    return result;
}

ValueId Builder::uniform(int slot, int element) {
    Instruction instruction = make(Op::Uniform, {});
    instruction.slot = slot;
    instruction.element = element;
    const ValueId result = module_.add_value(module_.uniforms[static_cast<std::size_t>(slot)].type);
    instruction.results = {result};
    append(std::move(instruction));
    return result;
}

ValueId Builder::emit(Op op, std::initializer_list<ValueId> operands) {
    return emit(op, std::span<const ValueId>(operands.begin(), operands.size()));
}

ValueId Builder::emit(Op op, std::span<const ValueId> operands) {
    std::vector<Type> types;
    for (ValueId operand : operands) types.push_back(module_.type(operand));
    Instruction instruction = make(op, operands);
    const ValueId result = module_.add_value(result_type(op, types));
    instruction.results = {result};
    append(std::move(instruction));
    return result;
}

ValueId Builder::compose(std::span<const ValueId> operands) { return emit(Op::Compose, operands); }

ValueId Builder::swizzle(ValueId value, std::string_view letters) {
    constexpr std::string_view names = "xyzw";
    if (letters == names.substr(0, static_cast<std::size_t>(module_.type(value).width)))
        return value;
    Instruction instruction = make(Op::Swizzle, {&value, 1});
    for (std::size_t i = 0; i < letters.size(); ++i)
        instruction.lanes[i] = static_cast<std::uint8_t>(names.find(letters[i]));
    const Type source = module_.type(value);
    const ValueId result = module_.add_value({source.scalar, static_cast<int>(letters.size())});
    instruction.results = {result};
    append(std::move(instruction));
    return result;
}

ValueId Builder::sample(Op op, int sampler, std::initializer_list<ValueId> operands) {
    const ValueId result = emit(op, operands);
    current_region().body.back().slot = sampler;
    return result;
}

Builder::LoopScope Builder::begin_loop(LoopInfo loop, std::span<const ValueId> initial) {
    Frame frame{make(Op::Loop, initial), {}};
    frame.instruction.loop = std::move(loop);
    LoopScope scope;
    scope.index = module_.add_value(int1);
    frame.region.parameters.push_back(scope.index);
    for (ValueId value : initial) {
        const ValueId parameter = module_.add_value(module_.type(value));
        scope.carried.push_back(parameter);
        frame.region.parameters.push_back(parameter);
    }
    frames_.push_back(std::move(frame));
    return scope;
}

void Builder::break_if(ValueId condition, std::span<const ValueId> carried) {
    assert(!frames_.empty() && frames_.back().instruction.op == Op::Loop);
    std::vector<ValueId> operands = {condition};
    operands.insert(operands.end(), carried.begin(), carried.end());
    append(make(Op::BreakIf, operands));
}

void Builder::close_region(std::span<const ValueId> values) {
    append(make(Op::Yield, values));
    Frame& frame = frames_.back();
    frame.instruction.regions.push_back(std::move(frame.region));
    frame.region = {};
}

std::vector<ValueId> Builder::end_loop(std::span<const ValueId> next) {
    close_region(next);
    Instruction instruction = std::move(frames_.back().instruction);
    frames_.pop_back();
    for (ValueId value : next)
        instruction.results.push_back(module_.add_value(module_.type(value)));
    std::vector<ValueId> results = instruction.results;
    append(std::move(instruction));
    return results;
}

void Builder::begin_if(ValueId condition) {
    frames_.push_back({make(Op::If, {&condition, 1}), {}});
}

void Builder::begin_else(std::span<const ValueId> then_values) { close_region(then_values); }

std::vector<ValueId> Builder::end_if(std::span<const ValueId> else_values) {
    close_region(else_values);
    Instruction instruction = std::move(frames_.back().instruction);
    frames_.pop_back();
    for (ValueId value : else_values)
        instruction.results.push_back(module_.add_value(module_.type(value)));
    std::vector<ValueId> results = instruction.results;
    append(std::move(instruction));
    return results;
}

void Builder::finish(std::span<const ValueId> outputs) { append(make(Op::Return, outputs)); }

}  // namespace intaglio::ir

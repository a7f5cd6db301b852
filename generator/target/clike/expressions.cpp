// Text by the rows of the spelling table.
#include "generator/target/clike/expressions.h"

#include <algorithm>

#include <fmt/format.h>

#include "generator/target/clike/literals.h"
#include "generator/target/target.h"

namespace intaglio::clike {

using ir::Instruction;
using ir::Op;
using ir::ValueId;

namespace {

Binds tighter(Binds binds) { return static_cast<Binds>(static_cast<int>(binds) + 1); }

// What an operand's place asks for.  Calls and constructors separate operands by commas; every
// binary operator is left associative; a ternary's condition and middle would be hard to read
// unparenthesised.
Binds required(const OpSpelling& row, int operand) {
    if (row.text.ends_with(")")) return Binds::Ternary;
    if (row.binds == Binds::Ternary) return operand == 2 ? Binds::Ternary : Binds::LogicalOr;
    if (row.binds == Binds::Prefix) return Binds::Postfix;
    if (row.binds == Binds::Relation || row.binds == Binds::Equality) return Binds::Sum;
    return operand == 0 ? row.binds : tighter(row.binds);
}

bool same_components(const Instruction& constant, int width) {
    for (int i = 1; i < width; ++i)
        if (constant.bits[static_cast<std::size_t>(i)] != constant.bits[0]) return false;
    return true;
}

}  // namespace

Expressions::Expressions(const ir::Module& module, const Plan& plan, const Spelling& spelling,
                         const OuterNames& outer)
    : module_(module),
      plan_(plan),
      spelling_(spelling),
      outer_(outer),
      locals_(module.values.size()),
      variable_names_(plan.variables().size()) {}

void Expressions::fail(const Instruction& instruction, std::string message) {
    if (!error_) error_ = target_limit(module_, instruction.origin, std::move(message));
}

std::string Expressions::operand(ValueId value, Binds at_least) {
    Text text = expression(value);
    return text.binds < at_least ? fmt::format("({})", text.text) : std::move(text.text);
}

std::string Expressions::compute(const Instruction& instruction) {
    return of_instruction(instruction).text;
}

std::string Expressions::negated(ValueId condition) {
    return fmt::format("!{}", operand(condition, Binds::Postfix));
}

std::vector<int> Expressions::variables_read(ValueId value) const {
    if (plan_.form(value) == Form::Variable) return {plan_.variable(value)};
    std::vector<int> read;
    if (plan_.form(value) != Form::Inline) return read;
    for (ValueId operand : plan_.uses().definition(value)->operands)
        for (int variable : variables_read(operand)) read.push_back(variable);
    return read;
}

Expressions::Text Expressions::expression(ValueId value) {
    switch (plan_.form(value)) {
        case Form::Local: return {locals_[ir::index_of(value)], Binds::Postfix};
        case Form::Variable: return {variable_name(plan_.variable(value)), Binds::Postfix};
        default: return of_instruction(*plan_.uses().definition(value));
    }
}

Expressions::Text Expressions::of_instruction(const Instruction& instruction) {
    const auto slot = static_cast<std::size_t>(instruction.slot);
    switch (instruction.op) {
        case Op::Constant: return constant(instruction);
        case Op::Input: return {outer_.inputs[slot], Binds::Postfix};
        case Op::Uniform:
            if (module_.uniforms[slot].count == 1) return {outer_.uniforms[slot], Binds::Postfix};
            return {fmt::format("{}[{}]", outer_.uniforms[slot], instruction.element),
                    Binds::Postfix};
        case Op::Swizzle: return swizzle(instruction);
        case Op::Compose: return compose(instruction);
        default: {
            const OpSpelling* row = row_of(instruction);
            if (row) return fill(*row, instruction);
            fail(instruction,
                 fmt::format("this target has no way to say {}", ir::info(instruction.op).name));
            return {"0", Binds::Postfix};
        }
    }
}

std::string Expressions::literal(ir::Scalar scalar, std::uint32_t bits,
                                 const Instruction& instruction) {
    if (scalar == ir::Scalar::Bool) return bits ? "true" : "false";
    if (scalar == ir::Scalar::Int) return int_literal(bits);
    Result<std::string> text = float_literal(bits, spelling_);
    if (text.ok()) return *text;
    fail(instruction, text.error().message);
    return "0.0";
}

Expressions::Text Expressions::constant(const Instruction& instruction) {
    const ir::Type type = module_.type(instruction.result());
    if (type.width == 1) {
        std::string text = literal(type.scalar, instruction.bits[0], instruction);
        const Binds binds = text[0] == '-' ? Binds::Prefix : Binds::Postfix;
        return {std::move(text), binds};
    }
    if (same_components(instruction, type.width) && spelling_.splat.text.ends_with(")")) {
        std::string text(spelling_.splat.text);
        text.replace(text.find("%t"), 2,
                     type_name(spelling_, static_cast<int>(type.scalar), type.width));
        text.replace(text.find("%0"), 2, literal(type.scalar, instruction.bits[0], instruction));
        return {std::move(text), Binds::Postfix};
    }
    std::string text(type_name(spelling_, static_cast<int>(type.scalar), type.width));
    for (int i = 0; i < type.width; ++i)
        text.append(i ? ", " : "(")
            .append(
                literal(type.scalar, instruction.bits[static_cast<std::size_t>(i)], instruction));
    return {text + ")", Binds::Postfix};
}

Expressions::Text Expressions::swizzle(const Instruction& instruction) {
    if (is_splat(module_, instruction)) return fill(spelling_.splat, instruction);
    std::string text = operand(instruction.operands[0], Binds::Postfix) + ".";
    for (int i = 0; i < module_.type(instruction.result()).width; ++i)
        text += "xyzw"[instruction.lanes[static_cast<std::size_t>(i)]];
    return {std::move(text), Binds::Postfix};
}

Expressions::Text Expressions::compose(const Instruction& instruction) {
    if (is_splat(module_, instruction)) return fill(spelling_.splat, instruction);
    const ir::Type type = module_.type(instruction.result());
    std::string text(type_name(spelling_, static_cast<int>(type.scalar), type.width));
    for (std::size_t i = 0; i < instruction.operands.size(); ++i)
        text.append(i ? ", " : "(").append(operand(instruction.operands[i], Binds::Ternary));
    return {text + ")", Binds::Postfix};
}

const OpSpelling* Expressions::row_of(const Instruction& instruction) {
    const int dimension =
        ir::is_sample(instruction.op)
            ? module_.samplers[static_cast<std::size_t>(instruction.slot)].dimension
            : 0;
    for (const OpSpelling& row : spelling_.ops)
        if (row.op == instruction.op && (row.dimension == 0 || row.dimension == dimension))
            return &row;
    return nullptr;
}

std::optional<Expressions::Text> Expressions::repeated_scalar(ValueId value) {
    const ir::Type type = module_.type(value);
    if (type.width == 1 || plan_.form(value) != Form::Inline) return std::nullopt;
    const Instruction& definition = *plan_.uses().definition(value);
    if (definition.op == Op::Constant && same_components(definition, type.width)) {
        std::string text = literal(type.scalar, definition.bits[0], definition);
        const Binds binds = text[0] == '-' ? Binds::Prefix : Binds::Postfix;
        return Text{std::move(text), binds};
    }
    if (is_splat(module_, definition)) return expression(definition.operands[0]);
    const auto lanes_end = definition.lanes.begin() + type.width;
    if (definition.op == Op::Swizzle &&
        std::count(definition.lanes.begin(), lanes_end, definition.lanes[0]) == type.width)
        return Text{fmt::format("{}.{}", operand(definition.operands[0], Binds::Postfix),
                                "xyzw"[definition.lanes[0]]),
                    Binds::Postfix};
    return std::nullopt;
}

// Which operands are printed as the scalar they repeat; one operand stays a vector, so that the
// result is one.
std::vector<bool> Expressions::collapsible(const OpSpelling& row, const Instruction& instruction) {
    std::vector<bool> collapse(instruction.operands.size());
    bool vector_left = false;
    for (std::size_t i = 0; i < collapse.size(); ++i) {
        collapse[i] = row.scalars.find(static_cast<char>('0' + i)) != std::string_view::npos &&
                      repeated_scalar(instruction.operands[i]).has_value();
        vector_left = vector_left || !collapse[i];
    }
    if (!vector_left) collapse[0] = false;
    return collapse;
}

Expressions::Text Expressions::fill(const OpSpelling& row, const Instruction& instruction) {
    const ir::Type type = module_.type(instruction.result());
    const std::vector<bool> collapse = collapsible(row, instruction);
    std::string text;
    for (std::size_t i = 0; i < row.text.size(); ++i) {
        if (row.text[i] != '%') {
            text += row.text[i];
            continue;
        }
        const char kind = row.text[++i];
        if (kind == 't') {
            text += type_name(spelling_, static_cast<int>(type.scalar), type.width);
        } else if (kind == 's') {
            text += outer_.samplers[static_cast<std::size_t>(instruction.slot)];
        } else {
            const auto index = static_cast<std::size_t>(kind - '0');
            const Binds needed = required(row, static_cast<int>(index));
            if (!collapse[index]) {
                text += operand(instruction.operands[index], needed);
            } else {
                const Text scalar = *repeated_scalar(instruction.operands[index]);
                text += scalar.binds < needed ? fmt::format("({})", scalar.text) : scalar.text;
            }
        }
    }
    return {std::move(text), row.text.ends_with(")") ? Binds::Postfix : row.binds};
}

std::string_view fallback_name(const ir::Module& module, const Uses& uses, ValueId value) {
    const ir::Type type = module.type(value);
    for (const Use& use : uses.uses(value))
        if (ir::is_sample(use.user->op) && use.operand == 0) return "coordinate";
    if (type.scalar == ir::Scalar::Bool) return "condition";
    switch (uses.definition(value)->op) {
        case Op::Add: return "sum";
        case Op::Sub: return "difference";
        case Op::Mul: return "product";
        case Op::Div: return "quotient";
        case Op::Dot: return "dot_product";
        case Op::Compose: return "combined";
        case Op::Sqrt: return "root";
        case Op::Rsqrt: return "inverse_length";
        case Op::Abs: return "magnitude";
        case Op::Min: return "least";
        case Op::Max: return "most";
        case Op::Saturate: return "limited";
        case Op::Floor: return "whole";
        case Op::Frac: return "fraction";
        case Op::Lerp: return "blend";
        case Op::Select: return "chosen";
        case Op::Cross: return "perpendicular";
        case Op::Ddx: return "change_x";
        case Op::Ddy: return "change_y";
        case Op::SampleLevel:
        case Op::SampleGrad:
        case Op::SampleImplicit: return "texel";
        default: return "number";
    }
}

}  // namespace intaglio::clike

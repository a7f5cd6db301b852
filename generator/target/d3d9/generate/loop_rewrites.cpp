// Rotation asks what a function of the index gives at -1; saturation, which values are never
// negative.  Both follow definitions, as far as few ops go.
#include "generator/target/d3d9/generate/loop_rewrites.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "generator/ir/evaluate.h"
#include "generator/passes/remove_dead_code.h"
#include "generator/passes/rewrite.h"
#include "generator/target/d3d9/generate/flow_blocks.h"

namespace intaglio::d3d9 {
namespace {

using ir::ConstantBits;
using ir::Instruction;
using ir::Op;
using ir::ValueId;
using Made = std::map<ValueId, const Instruction*>;

Made definitions_of(const ir::Module& module) {
    Made made;
    passes::for_each_instruction(module.body, [&](const Instruction& instruction) {
        if (!ir::has_regions(instruction.op) && !instruction.results.empty())
            made[instruction.result()] = &instruction;
    });
    return made;
}
const Instruction* definition(const Made& made, ValueId value) {
    const auto found = made.find(value);
    return found == made.end() ? nullptr : found->second;
}

// --- rotation

class Rotation {
  public:
    Rotation(ir::Module& module, const Made& made, const Instruction& loop)
        : module_(module), made_(made), loop_(loop), region_(loop.regions[0]) {
        for (const Instruction& instruction : region_.body) {
            plain_ = plain_ && !ir::has_regions(instruction.op);
            for (const ValueId result : instruction.results) inside_.insert(result);
        }
    }

    bool is_possible() {
        const int trips = loop_.loop.trip_count;
        if (!plain_ || trips < 1 || trips >= most_repeats || loop_.operands.empty()) return false;
        for (std::size_t k = 0; k < loop_.operands.size(); ++k)
            if (!is_function_of_index(next(k)) || !matches(loop_.operands[k], next(k)))
                return false;
        return true;
    }

    Instruction rotated() {
        Instruction result = loop_;
        ++result.loop.trip_count;
        ir::Region& region = result.regions[0];
        for (ValueId& parameter : region.parameters)
            parameter = module_.add_value(module_.type(parameter));
        region.body.clear();
        // The functions, an iteration earlier ...
        passes::Cloner early(module_, module_);
        for (const Instruction& instruction : region_.body) {
            if (instruction.results.empty() || slice_.count(instruction.result()) == 0) continue;
            if (is_next_index(instruction))
                early.bind(instruction.result(), region.parameters[0]);
            else
                region.body.push_back(early.clone(instruction));
        }
        // ... are what the rest carries.
        passes::Cloner rest(module_, module_);
        rest.bind(region_.parameters[0], region.parameters[0]);
        std::vector<ValueId> carried;
        for (std::size_t k = 0; k < loop_.operands.size(); ++k) {
            carried.push_back(early(next(k)));
            rest.bind(region_.parameters[k + 1], carried.back());
        }
        for (const Instruction& instruction : region_.body) {
            region.body.push_back(rest.clone(instruction));
            if (instruction.op == Op::Yield) region.body.back().operands = carried;
        }
        return result;
    }

  private:
    ValueId next(std::size_t k) const { return region_.body.back().operands[k]; }
    bool is_inside(ValueId value) const { return inside_.count(value) != 0; }
    bool is_next_index(const Instruction& instruction) const {
        if (instruction.op != Op::Add || instruction.operands[0] != region_.parameters[0])
            return false;
        const Instruction* step = definition(made_, instruction.operands[1]);
        return step != nullptr && step->op == Op::Constant && step->bits[0] == 1;
    }

    // Of the index plus one, to be exact, and of values from outside.
    bool is_function_of_index(ValueId value) {
        if (std::find(region_.parameters.begin(), region_.parameters.end(), value) !=
            region_.parameters.end())
            return false;
        if (!is_inside(value) || !slice_.insert(value).second) return true;
        const Instruction& made = *made_.at(value);
        if (is_next_index(made)) return true;
        if (!passes::is_arithmetic(made.op) && made.op != Op::SampleLevel &&
            made.op != Op::SampleGrad)
            return false;
        return std::all_of(made.operands.begin(), made.operands.end(),
                           [&](ValueId operand) { return is_function_of_index(operand); });
    }

    // A value of the first iteration's predecessor: constant, a value from outside, or neither.
    struct Start {
        std::optional<ConstantBits> bits;
        std::optional<ValueId> outside;
    };
    Start start_of(ValueId value) {
        const Instruction* made = definition(made_, value);
        if (!is_inside(value)) {
            if (made != nullptr && made->op == Op::Constant) return {made->bits, std::nullopt};
            return {std::nullopt, value};
        }
        if (is_next_index(*made)) return {ConstantBits{}, std::nullopt};
        if (made->op == Op::Constant) return {made->bits, std::nullopt};
        if (!passes::is_arithmetic(made->op)) return {};
        std::vector<Start> operands;
        std::vector<ir::Type> types;
        std::vector<ConstantBits> bits;
        for (const ValueId operand : made->operands) {
            operands.push_back(start_of(operand));
            types.push_back(module_.type(operand));
            if (operands.back().bits) bits.push_back(*operands.back().bits);
        }
        if (!operands.empty() && bits.size() == operands.size())
            return {ir::evaluate_op(*made, types, bits, module_.type(value).width), std::nullopt};
        const auto is_zero = [&](std::size_t k) {
            if (!operands[k].bits) return false;
            const auto width = static_cast<std::size_t>(types[k].width);
            return std::all_of(operands[k].bits->begin(), operands[k].bits->begin() + width,
                               [](std::uint32_t b) { return (b & 0x7FFFFFFFu) == 0; });
        };
        const bool is_float = module_.type(value).scalar == ir::Scalar::Float;
        if (made->op == Op::Mul && is_float && (is_zero(0) || is_zero(1)))
            return {ConstantBits{}, std::nullopt};
        if (made->op == Op::Add && is_zero(0)) return operands[1];
        if ((made->op == Op::Add || made->op == Op::Sub) && is_zero(1)) return operands[0];
        return {};
    }

    bool matches(ValueId outside, ValueId inside) {
        const Start start = start_of(inside);
        const Instruction* a = definition(made_, outside);
        if (start.bits) {
            const auto width = static_cast<std::size_t>(module_.type(inside).width);
            return a != nullptr && a->op == Op::Constant &&
                   module_.type(outside) == module_.type(inside) &&
                   std::equal(start.bits->begin(), start.bits->begin() + width, a->bits.begin());
        }
        if (start.outside) return outside == *start.outside;
        const Instruction* b = definition(made_, inside);
        if (a == nullptr || b == nullptr || a->op != b->op || a->slot != b->slot ||
            a->element != b->element || a->lanes != b->lanes ||
            a->operands.size() != b->operands.size() ||
            module_.type(outside) != module_.type(inside))
            return false;
        for (std::size_t k = 0; k < a->operands.size(); ++k)
            if (!matches(a->operands[k], b->operands[k])) return false;
        return true;
    }

    ir::Module& module_;
    const Made& made_;
    const Instruction& loop_;
    const ir::Region& region_;
    bool plain_ = true;
    std::set<ValueId> inside_, slice_;
};

void rotate_in(ir::Module& module, ir::Region& region, const Made& made) {
    for (Instruction& instruction : region.body) {
        for (ir::Region& inner : instruction.regions) rotate_in(module, inner, made);
        if (instruction.op != Op::Loop) continue;
        Rotation rotation(module, made, instruction);
        if (rotation.is_possible()) instruction = rotation.rotated();
    }
}

// --- saturation

class Signs {
  public:
    explicit Signs(const ir::Module& module) : made_(definitions_of(module)) {
        passes::for_each_instruction(module.body, [&](const Instruction& instruction) {
            if (instruction.op == Op::Loop) indices_.insert(instruction.regions[0].parameters[0]);
        });
    }

    // Whether no component is ever negative, of finite numbers.
    bool is_never_negative(ValueId value) const {
        if (indices_.count(value) != 0) return true;
        const Instruction* made = definition(made_, value);
        if (made == nullptr) return false;
        const auto operand = [&](std::size_t k) { return is_never_negative(made->operands[k]); };
        switch (made->op) {
            case Op::Constant:
                return std::all_of(made->bits.begin(), made->bits.end(),
                                   [](std::uint32_t bits) { return (bits >> 31) == 0; });
            case Op::Saturate:
            case Op::Abs:
            case Op::Frac:
            case Op::Sqrt:
            case Op::Rsqrt:
            case Op::Exp2: return true;
            case Op::Max: return operand(0) || operand(1);
            case Op::Add:
            case Op::Mul:
            case Op::Div:
            case Op::Min: return operand(0) && operand(1);
            case Op::Select: return operand(1) && operand(2);
            case Op::Floor:
            case Op::ToFloat:
            case Op::Swizzle: return operand(0);
            case Op::Lerp: {
                const Instruction* weight = definition(made_, made->operands[2]);
                return operand(0) && operand(1) && weight != nullptr && weight->op == Op::Saturate;
            }
            default: return false;
        }
    }
    bool is_one(ValueId value) const {
        const Instruction* made = definition(made_, value);
        return made != nullptr && made->op == Op::Constant && made->bits[0] == ir::float_bits(1.0f);
    }

  private:
    Made made_;
    std::set<ValueId> indices_;
};

}  // namespace

void rotate_loops(ir::Module& module) {
    const ir::Module before = module;
    const Made made = definitions_of(before);
    rotate_in(module, module.body, made);
    passes::remove_dead_code(module);
    // The vertex stage counts on these.
    if (module.inputs != before.inputs) module = before;
}

void form_saturations(ir::Module& module) {
    const ir::Module before = module;
    const Signs signs(before);
    passes::for_each_instruction(module.body, [&](ir::Instruction& instruction) {
        if (instruction.op != Op::Min || module.type(instruction.result()) != ir::float1) return;
        for (std::size_t k = 0; k < 2; ++k)
            if (signs.is_one(instruction.operands[1 - k]) &&
                signs.is_never_negative(instruction.operands[k])) {
                instruction.op = Op::Saturate;
                instruction.operands = {instruction.operands[k]};
                return;
            }
    });
}

}  // namespace intaglio::d3d9

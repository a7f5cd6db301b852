// One walk over the slices of the condition, the exit's values and the carried values, carried ones
// after what they take over; a carried value met again on the way remembers, and the loop is none.
#include "generator/passes/first_hit_loop.h"

#include <algorithm>

#include <fmt/format.h>

namespace intaglio::passes {

using namespace ir;

FirstHitLoop::FirstHitLoop(const Module& module, const Definitions& definitions,
                           const Instruction& loop, bool zero_products)
    : module_(module), definitions_(definitions), loop_(loop), zero_products_(zero_products) {
    const std::vector<ValueId>& parameters = loop.regions[0].parameters;
    for (std::size_t k = 1; k < parameters.size(); ++k) parameters_[parameters[k]] = k - 1;
    refusal_ = find_exit();
    if (refusal_.empty()) refusal_ = find_cycles();
}

std::string FirstHitLoop::find_exit() {
    if (trips() < 1) return "it never runs";
    for (const Instruction& instruction : body()) {
        if (has_regions(instruction.op)) return "it holds a branch or a loop";
        if (instruction.op == Op::BreakIf) {
            if (exit_ != nullptr) return "it is left from more than one place";
            exit_ = &instruction;
        }
        for (ValueId result : instruction.results) instructions_[result] = &instruction;
    }
    return exit_ == nullptr ? "it is not left early" : "";
}

std::string FirstHitLoop::find_cycles() {
    for (ValueId value : exit_->operands)
        if (!visit(value)) return "a carried value depends on its own past";
    for (ValueId parameter : loop_.regions[0].parameters)
        if (!visit(parameter))
            return fmt::format("'{}' depends on its own past", module_.value(parameter).name);
    return {};
}

// False if the value depends on a carried value that depends on itself.
bool FirstHitLoop::visit(ValueId value) {
    if (!is_inside(value)) {
        tabulated_[value] = is_known_outside(value);
        valid_from_[value] = 0;
        return true;
    }
    const auto [seen, is_new] = visited_.try_emplace(value, true);
    if (!is_new) return !seen->second;
    bool tabulated = true;
    if (const auto k = parameter(value)) {
        if (!visit(next_value(*k))) return false;
        tabulated = tabulated_.at(next_value(*k));
    } else if (!is_index(value)) {
        // Where the device may round as it likes, it does so at run time.
        const Op op = instruction(value).op;
        tabulated = is_arithmetic(op) && info(op).bit_exact && (!is_leaf(op) || op == Op::Constant);
        for (ValueId operand : instruction(value).operands) {
            if (!visit(operand)) return false;
            tabulated = tabulated && tabulated_.at(operand);
        }
    }
    tabulated_[value] = tabulated;
    valid_from_[value] = first_valid(value);
    visited_[value] = false;
    return true;
}

int FirstHitLoop::first_valid(ValueId value) const {
    if (is_index(value)) return 0;
    if (const auto k = parameter(value)) {
        const int before = valid_from_.at(next_value(*k));
        if (before > 0) return before + 1;
        return is_initially(*k) ? 0 : 1;
    }
    int first = 0;
    for (ValueId operand : instruction(value).operands)
        first = std::max(first, valid_from_.at(operand));
    return first;
}

bool FirstHitLoop::is_inside(ValueId value) const {
    return is_index(value) || parameters_.count(value) > 0 || instructions_.count(value) > 0;
}

bool FirstHitLoop::is_index(ValueId value) const { return value == loop_.regions[0].parameters[0]; }

std::optional<std::size_t> FirstHitLoop::parameter(ValueId value) const {
    const auto found = parameters_.find(value);
    if (found == parameters_.end()) return std::nullopt;
    return found->second;
}

const Instruction& FirstHitLoop::instruction(ValueId value) const {
    return *instructions_.at(value);
}

bool FirstHitLoop::is_known_outside(ValueId value) const {
    return definitions_[value].op == Op::Constant;
}

bool FirstHitLoop::is_tabulated(ValueId value) const {
    const auto found = tabulated_.find(value);
    return found != tabulated_.end() && found->second;
}

std::optional<ConstantBits> FirstHitLoop::constant_at(ValueId value, int iteration) const {
    if (!is_tabulated(value)) return std::nullopt;
    const auto found = constants_.find({value, iteration});
    if (found != constants_.end()) return found->second;
    return constants_[{value, iteration}] = compute_at(value, iteration);
}

std::optional<ConstantBits> FirstHitLoop::compute_at(ValueId value, int iteration) const {
    if (!is_inside(value)) return definitions_[value].bits;
    if (is_index(value)) return ConstantBits{static_cast<std::uint32_t>(iteration), 0, 0, 0};
    if (const auto k = parameter(value)) {
        const ValueId initial = initial_value(*k);
        if (iteration > 0 || valid_from_.at(value) == 0)
            return constant_at(next_value(*k), iteration - 1);
        if (iteration == 0 && is_known_outside(initial)) return definitions_[initial].bits;
        return std::nullopt;
    }
    const Instruction& computed = instruction(value);
    if (computed.op == Op::Constant) return computed.bits;
    std::vector<Type> types;
    std::vector<ConstantBits> operands;
    for (ValueId operand : computed.operands) {
        const auto bits = constant_at(operand, iteration);
        if (!bits) return std::nullopt;
        types.push_back(module_.type(operand));
        operands.push_back(*bits);
    }
    return evaluate_op(computed, types, operands, module_.type(value).width);
}

// True if the carried value's initial value is its function at -1.  What it takes over must be its
// own function everywhere.
bool FirstHitLoop::is_initially(std::size_t k) const {
    return matches(initial_value(k), next_value(k), -1);
}

bool FirstHitLoop::matches(ValueId outside, ValueId inside, int iteration) const {
    if (!is_inside(inside)) return outside == inside;
    if (const auto bits = constant_at(inside, iteration))
        return matches_constant(outside, inside, *bits);
    if (const auto k = parameter(inside)) return matches(outside, next_value(*k), iteration - 1);
    if (is_index(inside)) return false;
    const Definition& a = definitions_[outside];
    const Instruction& b = instruction(inside);
    if (zero_products_ && (b.op == Op::Add || b.op == Op::Sub) && is_zero(b.operands[1], iteration))
        return matches(outside, b.operands[0], iteration);
    if (a.op != b.op || a.operand_count != b.operands.size() || a.slot != b.slot ||
        a.element != b.element || a.lanes != b.lanes ||
        module_.type(outside) != module_.type(inside))
        return false;
    for (std::size_t i = 0; i < b.operands.size(); ++i)
        if (!matches(a.operands[i], b.operands[i], iteration)) return false;
    return true;
}

// Zero in each component, or a product with such a value.
bool FirstHitLoop::is_zero(ValueId value, int iteration) const {
    if (const auto bits = constant_at(value, iteration)) {
        const auto width = static_cast<std::size_t>(module_.type(value).width);
        return std::all_of(bits->begin(), bits->begin() + static_cast<std::ptrdiff_t>(width),
                           [](std::uint32_t component) { return component << 1 == 0; });
    }
    if (!is_inside(value) || parameter(value) || is_index(value)) return false;
    const Instruction& computed = instruction(value);
    const auto zero = [&](ValueId operand) { return is_zero(operand, iteration); };
    if (computed.op == Op::Mul)
        return std::any_of(computed.operands.begin(), computed.operands.end(), zero);
    if (computed.op == Op::Swizzle || computed.op == Op::Compose)
        return std::all_of(computed.operands.begin(), computed.operands.end(), zero);
    return false;
}

bool FirstHitLoop::matches_constant(ValueId outside, ValueId inside,
                                    const ConstantBits& bits) const {
    if (definitions_[outside].op != Op::Constant || module_.type(outside) != module_.type(inside))
        return false;
    const auto width = module_.type(inside).width;
    return std::equal(bits.begin(), bits.begin() + width, definitions_[outside].bits.begin());
}

}  // namespace intaglio::passes

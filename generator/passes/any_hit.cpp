// The uses are found by walking on from the loop: what depends on its results is arithmetic until
// it is a comparison that agrees with the hit's, operand by operand.
#include "generator/passes/any_hit.h"

#include <algorithm>
#include <bit>
#include <set>

namespace intaglio::passes {

using namespace ir;

std::optional<Comparison> comparison_of(const Module& module, const Instruction& instruction) {
    if (info(instruction.op).type_rule != TypeRule::Compare ||
        module.type(instruction.operands[0]).scalar != Scalar::Float)
        return std::nullopt;
    const ValueId a = instruction.operands[0], b = instruction.operands[1];
    switch (instruction.op) {
        case Op::Greater: return Comparison{a, b, true};
        case Op::GreaterEqual: return Comparison{a, b, false};
        case Op::Less: return Comparison{b, a, true};
        case Op::LessEqual: return Comparison{b, a, false};
        default: return std::nullopt;
    }
}

namespace {

using Instructions = std::map<ValueId, const Instruction*>;

class Uses {
  public:
    Uses(const Module& module, const Region& region, std::size_t position)
        : module_(module), region_(region), position_(position), loop_(region.body[position]) {
        for (const Instruction& instruction : loop_.regions[0].body)
            for (ValueId result : instruction.results) inside_[result] = &instruction;
        for (const Instruction& instruction : region.body)
            for (ValueId result : instruction.results) outside_[result] = &instruction;
    }

    // The comparisons that all uses of the results end in; nothing if there are others.
    std::optional<std::vector<Truth>> truths(const Comparison& hit) const {
        std::vector<Truth> found;
        std::set<ValueId> derived(loop_.results.begin(), loop_.results.end());
        const auto is_derived = [&](const Instruction& instruction) {
            return std::any_of(instruction.operands.begin(), instruction.operands.end(),
                               [&](ValueId operand) { return derived.count(operand) > 0; });
        };
        for (std::size_t i = position_ + 1; i < region_.body.size(); ++i) {
            const Instruction& user = region_.body[i];
            bool inner_use = false;
            for (const Region& inner : user.regions)
                for_each_instruction(
                    inner, [&](const Instruction& used) { inner_use |= is_derived(used); });
            if (inner_use) return std::nullopt;
            if (!is_derived(user)) continue;
            if (!is_arithmetic(user.op)) return std::nullopt;
            if (const auto truth = truth_of(user, hit))
                found.push_back(*truth);
            else
                derived.insert(user.result());
        }
        if (found.empty()) return std::nullopt;
        return found;
    }

  private:
    std::optional<Truth> truth_of(const Instruction& user, const Comparison& hit) const {
        const auto compared = comparison_of(module_, user);
        if (!compared) return std::nullopt;
        if (compared->strict == hit.strict && agree(compared->greater, hit.greater) &&
            agree(compared->lesser, hit.lesser))
            return Truth{user.result(), true};
        if (compared->strict != hit.strict && agree(compared->greater, hit.lesser) &&
            agree(compared->lesser, hit.greater))
            return Truth{user.result(), false};
        return std::nullopt;
    }

    // The one is computed from the loop's results as the other is from what the loop carries.
    bool agree(ValueId outside, ValueId inside) const {
        const std::vector<ValueId>& parameters = loop_.regions[0].parameters;
        for (std::size_t k = 0; k < loop_.results.size(); ++k)
            if (loop_.results[k] == outside) return parameters[k + 1] == inside;
        const auto b = inside_.find(inside);
        if (b == inside_.end()) return outside == inside;
        const auto a = outside_.find(outside);
        if (a == outside_.end()) return false;
        const Instruction &x = *a->second, &y = *b->second;
        if (!is_arithmetic(x.op) || x.op != y.op || x.bits != y.bits || x.slot != y.slot ||
            x.element != y.element || x.lanes != y.lanes || x.operands.size() != y.operands.size())
            return false;
        for (std::size_t i = 0; i < x.operands.size(); ++i)
            if (!agree(x.operands[i], y.operands[i])) return false;
        return true;
    }

    const Module& module_;
    const Region& region_;
    std::size_t position_;
    const Instruction& loop_;
    Instructions inside_, outside_;
};

// Values inside the loop that do not fall as the index grows.
class Growth {
  public:
    Growth(const Module& module, const Definitions& definitions, const FirstHitLoop& search)
        : module_(module), definitions_(definitions), search_(search) {}

    bool grows(ValueId value) const {
        if (!search_.is_inside(value)) return true;
        if (search_.is_tabulated(value)) return table_grows(value);
        if (const auto k = search_.parameter(value))
            return search_.valid_from(value) == 0 && grows(search_.next_value(*k));
        const Instruction& made = search_.instruction(value);
        switch (made.op) {
            case Op::Add:
            case Op::Min:
            case Op::Max: return grows(made.operands[0]) && grows(made.operands[1]);
            case Op::Mul:
                return (grows(made.operands[0]) && is_factor(made.operands[1])) ||
                       (grows(made.operands[1]) && is_factor(made.operands[0]));
            default: return false;
        }
    }

  private:
    bool table_grows(ValueId value) const {
        if (module_.type(value) != float1) return false;
        for (int i = -1; i < search_.trips(); ++i) {
            const auto a = search_.constant_at(value, i), b = search_.constant_at(value, i + 1);
            if (!a || !b || !(std::bit_cast<float>((*a)[0]) <= std::bit_cast<float>((*b)[0])))
                return false;
        }
        return true;
    }

    bool is_factor(ValueId value) const { return !search_.is_inside(value) && is_positive(value); }

    // Not below +0, unless it is NaN.
    bool is_positive(ValueId value) const {
        const Definition& made = definitions_[value];
        const auto operand = [&](std::size_t i) { return is_positive(made.operands[i]); };
        switch (made.op) {
            case Op::Constant: return (made.bits[0] >> 31) == 0;
            case Op::Abs: return true;
            case Op::Floor:
            case Op::Sqrt: return operand(0);
            case Op::Add:
            case Op::Mul:
            case Op::Div:
            case Op::Min: return operand(0) && operand(1);
            // From 0 to 1, where a lerp stays between its ends.
            case Op::Lerp:
                return operand(0) && operand(1) &&
                       definitions_[made.operands[2]].op == Op::Saturate;
            default: return false;
        }
    }

    const Module& module_;
    const Definitions& definitions_;
    const FirstHitLoop& search_;
};

}  // namespace

std::optional<AnyHit> find_any_hit(const Module& module, const Region& region,
                                   std::size_t position) {
    const Instruction& loop = region.body[position];
    if (loop.op != Op::Loop) return std::nullopt;
    const Region& inside = loop.regions[0];
    const Instruction* exit = nullptr;
    Instructions made;
    for (const Instruction& instruction : inside.body) {
        if (instruction.op == Op::BreakIf) exit = &instruction;
        for (ValueId result : instruction.results) made[result] = &instruction;
    }
    // It leaves with what it carries.
    if (exit == nullptr || !std::equal(exit->operands.begin() + 1, exit->operands.end(),
                                       inside.parameters.begin() + 1))
        return std::nullopt;
    const auto condition = made.find(exit->operands[0]);
    if (condition == made.end()) return std::nullopt;
    std::vector<AnyHit> readings;
    const auto read = [&](ValueId hit, std::optional<ValueId> stop) {
        if (const auto found = made.find(hit); found != made.end())
            if (const auto compared = comparison_of(module, *found->second))
                readings.push_back({*compared, stop, {}});
    };
    read(exit->operands[0], std::nullopt);
    if (const Instruction& either = *condition->second; either.op == Op::Or) {
        read(either.operands[0], either.operands[1]);
        read(either.operands[1], either.operands[0]);
    }
    const Uses uses(module, region, position);
    for (AnyHit& reading : readings) {
        if (auto truths = uses.truths(reading.hit)) {
            reading.truths = std::move(*truths);
            return reading;
        }
    }
    return std::nullopt;
}

bool stays(const Module& module, const Definitions& definitions, const FirstHitLoop& search,
           ValueId condition) {
    if (!search.is_inside(condition) || search.parameter(condition)) return false;
    const auto compared = comparison_of(module, search.instruction(condition));
    return compared && !search.is_inside(compared->lesser) &&
           Growth(module, definitions, search).grows(compared->greater);
}

bool is_above_texels(const Module& module, const Definitions& definitions,
                     const FirstHitLoop& search, const AnyHit& any) {
    const auto is_computed = [&](ValueId value) {
        return search.is_inside(value) && !search.parameter(value) && !search.is_index(value);
    };
    if (!any.stop || !is_computed(*any.stop)) return false;
    const auto stop = comparison_of(module, search.instruction(*any.stop));
    const auto height = search.parameter(any.hit.greater);
    if (!stop || stop->greater != any.hit.lesser || search.is_inside(stop->lesser) || !height)
        return false;
    const Definition& top = definitions[stop->lesser];
    if (top.op != Op::Constant || std::bit_cast<float>(top.bits[0]) < 1.0f) return false;
    ValueId next = search.next_value(*height);
    while (is_computed(next) && search.instruction(next).op == Op::Swizzle)
        next = search.instruction(next).operands[0];
    return is_computed(next) && is_sample(search.instruction(next).op);
}

}  // namespace intaglio::passes

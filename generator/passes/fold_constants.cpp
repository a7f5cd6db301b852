// One walk in execution order, so that every operand is already simplified.  An instruction is
// rewritten in place until nothing applies: it then keeps its result, name and origin.  Where it
// turns out to be another value, uses are replaced.
#include "generator/passes/fold_constants.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <unordered_map>

#include "generator/ir/builder.h"
#include "generator/ir/evaluate.h"
#include "generator/passes/rewrite.h"
#include "generator/passes/rewrite_rules.h"
#include "generator/passes/simplify_shapes.h"

namespace intaglio::passes {
namespace {

using namespace ir;

struct CompiledRule {
    Pattern left, right;
    Domain domain;
};

// The rules by the op at the root of their left side.
const std::vector<CompiledRule>& rules_for(Op op) {
    static const auto compiled = [] {
        std::vector<std::vector<CompiledRule>> by_op(all_ops().size());
        for (const RewriteRule& rule : rewrite_rules()) {
            Pattern left = parse_pattern(rule.left);
            const auto root = static_cast<std::size_t>(left.op);
            by_op[root].push_back({std::move(left), parse_pattern(rule.right), rule.domain});
        }
        return by_op;
    }();
    return compiled[static_cast<std::size_t>(op)];
}

bool is_in(Scalar scalar, Domain domain) {
    switch (domain) {
        case Domain::Float: return scalar == Scalar::Float;
        case Domain::Int: return scalar == Scalar::Int;
        case Domain::Bool: return scalar == Scalar::Bool;
        case Domain::Numeric: return scalar != Scalar::Bool;
        case Domain::Any: return true;
    }
    return false;
}

class Folder {
  public:
    explicit Folder(Module& module) : module_(module), substitution_(module) {}

    void run() { visit(module_.body); }

    // Another walk may find more.
    bool again() const { return again_; }
    bool changed() const { return changed_; }

  private:
    using Body = std::vector<Instruction>;
    using Bits = ConstantBits;

    void visit(Region& region) {
        const std::size_t known = learned_.size();
        rebuild(region,
                [&](Instruction&& instruction, Body& body) { fold(std::move(instruction), body); });
        forget(known);
    }

    void fold(Instruction&& instruction, Body& body) {
        substitution_.apply(instruction.operands);
        switch (instruction.op) {
            case Op::If: return fold_if(std::move(instruction), body);
            case Op::Loop: return fold_loop(std::move(instruction), body);
            case Op::BreakIf: return fold_break(std::move(instruction), body);
            case Op::Yield:
            case Op::Return: body.push_back(std::move(instruction)); return;
            default: simplify(std::move(instruction), body);
        }
    }

    // --- structure

    void fold_if(Instruction&& branch, Body& body) {
        const ValueId condition = branch.operands[0];
        if (const auto truth = truth_of(condition)) {
            changed_ = true;
            inline_region(branch.regions[*truth ? 0 : 1], branch.results, body);
            return;
        }
        for (std::size_t side = 0; side < 2; ++side) {
            const std::size_t known = learned_.size();
            learn(condition, side == 0);
            visit(branch.regions[side]);
            forget(known);
        }
        // A value that both sides yield comes from outside.
        std::vector<ValueId>& then_values = branch.regions[0].body.back().operands;
        std::vector<ValueId>& else_values = branch.regions[1].body.back().operands;
        for (std::size_t k = branch.results.size(); k-- > 0;) {
            if (then_values[k] != else_values[k]) continue;
            changed_ = true;
            replace(branch.results[k], then_values[k]);
            for (auto* values : {&then_values, &else_values, &branch.results})
                values->erase(values->begin() + static_cast<std::ptrdiff_t>(k));
        }
        body.push_back(std::move(branch));
    }

    void fold_loop(Instruction&& loop, Body& body) {
        Region& region = loop.regions[0];
        const int trips = loop.loop.trip_count;
        if (trips <= 0) {
            changed_ = true;
            for (std::size_t k = 0; k < loop.results.size(); ++k)
                replace(loop.results[k], loop.operands[k]);
            return;
        }
        if (trips == 1 && !contains_break(region)) {
            changed_ = true;
            Instruction index = make_int_constant(module_, 0, loop.origin);
            definitions_.record(index);
            replace(region.parameters[0], index.result());
            body.push_back(std::move(index));
            for (std::size_t k = 0; k < loop.operands.size(); ++k)
                replace(region.parameters[k + 1], loop.operands[k]);
            inline_region(region, loop.results, body);
            return;
        }
        visit(region);
        end_at_certain_break(loop);
        if (loop.loop.trip_count == 1 && !contains_break(region)) again_ = true;
        body.push_back(std::move(loop));
    }

    // A break that is certain ends the first iteration that reaches it; there is no second.
    void end_at_certain_break(Instruction& loop) {
        Body& code = loop.regions[0].body;
        const auto certain =
            std::find_if(code.begin(), code.end(), [&](const Instruction& instruction) {
                return instruction.op == Op::BreakIf && truth_of(instruction.operands[0]) == true;
            });
        if (certain == code.end()) return;
        changed_ = true;
        certain->op = Op::Yield;
        certain->operands.erase(certain->operands.begin());
        code.erase(certain + 1, code.end());
        loop.loop.trip_count = 1;
    }

    void fold_break(Instruction&& instruction, Body& body) {
        const ValueId condition = instruction.operands[0];
        const auto truth = truth_of(condition);
        if (truth == false) {
            changed_ = true;
            return;
        }
        body.push_back(std::move(instruction));
        if (!truth) learn(condition, false);
    }

    // The region's instructions join the body; `results` become what it yields.
    void inline_region(Region& region, const std::vector<ValueId>& results, Body& body) {
        for (Instruction& instruction : region.body) {
            if (instruction.op != Op::Yield) {
                fold(std::move(instruction), body);
                continue;
            }
            substitution_.apply(instruction.operands);
            for (std::size_t k = 0; k < results.size(); ++k)
                replace(results[k], instruction.operands[k]);
        }
    }

    // --- what is known of conditions

    // From here to the end of the region, `condition` is `truth`, and so is what follows from it.
    void learn(ValueId condition, bool truth) {
        if (!truths_.emplace(condition, truth).second) return;
        learned_.push_back(condition);
        const Definition& definition = definitions_[condition];
        if (definition.op == Op::Not) learn(definition.operands[0], !truth);
        if ((definition.op == Op::And && truth) || (definition.op == Op::Or && !truth))
            for (ValueId operand : definition.operand_span()) learn(operand, truth);
    }

    void forget(std::size_t count) {
        for (; learned_.size() > count; learned_.pop_back()) truths_.erase(learned_.back());
    }

    std::optional<bool> truth_of(ValueId condition) const {
        const Bits* bits = constant_of(condition);
        if (bits == nullptr) return std::nullopt;
        return (*bits)[0] != 0;
    }

    const Bits* constant_of(ValueId value) const {
        static constexpr Bits known[2] = {{0, 0, 0, 0}, {1, 0, 0, 0}};
        if (const auto truth = truths_.find(value); truth != truths_.end())
            return &known[truth->second ? 1 : 0];
        const Definition& definition = definitions_[value];
        return definition.op == Op::Constant ? &definition.bits : nullptr;
    }

    // --- one instruction

    void simplify(Instruction&& instruction, Body& body) {
        const ValueId result = instruction.result();
        while (!evaluate(instruction)) {
            if (!apply_rules(instruction) && !simplify_shape(module_, definitions_, instruction) &&
                !divide_by_power_of_two(instruction, body))
                break;
            changed_ = true;
            if (instruction.op == Op::Yield) {  // it is its operand
                replace(result, instruction.operands[0]);
                return;
            }
        }
        definitions_.record(instruction);
        body.push_back(std::move(instruction));
    }

    bool evaluate(Instruction& instruction) {
        if (!info(instruction.op).bit_exact || is_leaf(instruction.op)) return false;
        if (std::any_of(instruction.operands.begin(), instruction.operands.end(),
                        [&](ValueId operand) { return constant_of(operand) == nullptr; }))
            return false;
        std::vector<Type> types;
        std::vector<Bits> operands;
        for (ValueId operand : instruction.operands) {
            types.push_back(module_.type(operand));
            operands.push_back(*constant_of(operand));
        }
        const auto bits =
            evaluate_op(instruction, types, operands, module_.type(instruction.result()).width);
        if (!bits) return false;
        become_constant(instruction, *bits);
        changed_ = true;
        return true;
    }

    static void become_constant(Instruction& instruction, const Bits& bits) {
        instruction.op = Op::Constant;
        instruction.operands.clear();
        instruction.lanes = {};
        instruction.bits = bits;
    }

    bool apply_rules(Instruction& instruction) {
        for (const CompiledRule& rule : rules_for(instruction.op)) {
            Bindings bindings;
            if (matches_operands(rule.left, rule.domain, instruction.operands, bindings) &&
                rewrite(instruction, rule.right, bindings))
                return true;
        }
        return false;
    }

    struct Bindings {
        std::array<std::optional<ValueId>, 4> values;
        std::optional<ValueId>& operator[](char variable) {
            return values[static_cast<std::size_t>(variable - 'a')];
        }
    };

    bool matches_operands(const Pattern& pattern, Domain domain, std::span<const ValueId> operands,
                          Bindings& bindings) const {
        for (std::size_t i = 0; i < operands.size(); ++i)
            if (!matches(pattern.operands[i], domain, operands[i], bindings)) return false;
        return true;
    }

    bool matches(const Pattern& pattern, Domain domain, ValueId value, Bindings& bindings) const {
        const Type type = module_.type(value);
        switch (pattern.kind) {
            case Pattern::Kind::Variable: {
                if (pattern.variable <= 'b' ? !is_in(type.scalar, domain) : type != bool1)
                    return false;
                std::optional<ValueId>& bound = bindings[pattern.variable];
                if (!bound) bound = value;
                return *bound == value;
            }
            case Pattern::Kind::Constant: {
                const Bits* bits = constant_of(value);
                if (bits == nullptr) return false;
                const std::uint32_t wanted = constant_bits(pattern.constant, type.scalar);
                return std::all_of(bits->begin(), bits->begin() + type.width,
                                   [&](std::uint32_t component) { return component == wanted; });
            }
            case Pattern::Kind::Operation: {
                const Definition& definition = definitions_[value];
                return definition.op == pattern.op &&
                       matches_operands(pattern, domain, definition.operand_span(), bindings);
            }
        }
        return false;
    }

    // False, and nothing changed, if the right side has another type: a select between bool4 is no
    // bool1.
    bool rewrite(Instruction& instruction, const Pattern& right, Bindings& bindings) {
        const Type type = module_.type(instruction.result());
        if (right.kind == Pattern::Kind::Constant) {
            Bits bits{};
            std::fill_n(bits.begin(), type.width, constant_bits(right.constant, type.scalar));
            become_constant(instruction, bits);
            return true;
        }
        if (right.kind == Pattern::Kind::Variable) {
            const ValueId value = *bindings[right.variable];
            if (module_.type(value) != type) return false;
            become_operand(instruction, value);
            return true;
        }
        std::vector<ValueId> operands;
        std::vector<Type> types;
        for (const Pattern& operand : right.operands) {
            operands.push_back(*bindings[operand.variable]);
            types.push_back(module_.type(operands.back()));
        }
        if (result_type(right.op, types) != type) return false;
        instruction.op = right.op;
        instruction.operands = std::move(operands);
        return true;
    }

    // x / 2^k = x * 2^-k, both rounded once, while 2^-k is no denormal.
    bool divide_by_power_of_two(Instruction& instruction, Body& body) {
        if (instruction.op != Op::Div) return false;
        const Bits* divisor = constant_of(instruction.operands[1]);
        if (divisor == nullptr) return false;
        const Type type = module_.type(instruction.result());
        Bits reciprocal{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(type.width); ++i) {
            const std::uint32_t exponent = (*divisor)[i] >> 23 & 0xff;
            if (((*divisor)[i] & 0x7fffff) != 0 || exponent < 1 || exponent > 253) return false;
            reciprocal[i] = float_bits(1.0f / std::bit_cast<float>((*divisor)[i]));
        }
        body.push_back(make_constant(module_, type, reciprocal, instruction.origin));
        definitions_.record(body.back());
        instruction.op = Op::Mul;
        instruction.operands[1] = body.back().result();
        return true;
    }

    void replace(ValueId from, ValueId to) {
        substitution_.replace(from, to,
                              is_leaf(definitions_[to].op) ? Substitution::Name::Leave
                                                           : Substitution::Name::TakeOver);
    }

    Module& module_;
    Substitution substitution_;
    Definitions definitions_;
    std::unordered_map<ValueId, bool> truths_;
    std::vector<ValueId> learned_;  // in order, to forget them at the end of a region
    bool again_ = false, changed_ = false;
};

}  // namespace

bool fold_constants(ir::Module& module) {
    bool changed = false;
    for (bool again = true; again;) {
        Folder folder(module);
        folder.run();
        again = folder.again();
        changed |= folder.changed();
    }
    return compact_values(module) || changed;
}

}  // namespace intaglio::passes

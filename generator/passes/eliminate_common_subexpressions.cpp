// Value numbering over the region tree: a table of the expressions that are available here. Leaving
// a region forgets what it added.  Loops and ifs themselves are never merged.
#include "generator/passes/eliminate_common_subexpressions.h"

#include <algorithm>
#include <unordered_map>

#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

// Everything that decides an instruction's result.
struct Expression {
    Op op = Op::Constant;
    Type type;
    std::vector<ValueId> operands;
    std::array<std::uint32_t, 4> bits{};
    std::array<std::uint8_t, 4> lanes{};
    int slot = 0;
    int element = 0;
    friend bool operator==(const Expression&, const Expression&) = default;
};

struct ExpressionHash {
    std::size_t operator()(const Expression& expression) const {
        std::size_t hash = static_cast<std::size_t>(expression.op);
        const auto mix = [&](std::size_t value) {
            hash = (hash ^ value) * 0x9e3779b97f4a7c15ull + (hash >> 29);
        };
        mix(static_cast<std::size_t>(expression.type.width) * 4 +
            static_cast<std::size_t>(expression.type.scalar));
        for (ValueId operand : expression.operands) mix(index_of(operand));
        for (std::uint32_t bits : expression.bits) mix(bits);
        for (std::uint8_t lane : expression.lanes) mix(lane);
        mix(static_cast<std::size_t>(expression.slot));
        mix(static_cast<std::size_t>(expression.element));
        return hash;
    }
};

// Exact in either order.  Min and max are not: of two zeros either may come out.
bool is_commutative(Op op) {
    switch (op) {
        case Op::Add:
        case Op::Mul:
        case Op::Dot:
        case Op::Equal:
        case Op::NotEqual:
        case Op::And:
        case Op::Or: return true;
        default: return false;
    }
}

// The same expression in one spelling.
Expression canonical(const Module& module, const Instruction& instruction) {
    Expression expression{instruction.op,       module.type(instruction.result()),
                          instruction.operands, instruction.bits,
                          instruction.lanes,    instruction.slot,
                          instruction.element};
    const bool turned = instruction.op == Op::Greater || instruction.op == Op::GreaterEqual;
    if (instruction.op == Op::Greater) expression.op = Op::Less;
    if (instruction.op == Op::GreaterEqual) expression.op = Op::LessEqual;
    if (turned) std::swap(expression.operands[0], expression.operands[1]);
    if (is_commutative(instruction.op))
        std::sort(expression.operands.begin(), expression.operands.end());
    return expression;
}

class Merger {
  public:
    explicit Merger(Module& module) : module_(module), substitution_(module) {}

    void visit(Region& region) {
        std::vector<Expression> added;
        rebuild(region, [&](Instruction instruction, std::vector<Instruction>& body) {
            substitution_.apply(instruction.operands);
            for (Region& inner : instruction.regions) visit(inner);
            if ((is_arithmetic(instruction.op) || is_sample(instruction.op) ||
                 needs_derivatives(instruction.op)) &&
                !is_first(instruction, added))
                return;
            body.push_back(std::move(instruction));
        });
        for (const Expression& expression : added) available_.erase(expression);
    }

  private:
    bool is_first(const Instruction& instruction, std::vector<Expression>& added) {
        Expression expression = canonical(module_, instruction);
        const auto [entry, inserted] = available_.emplace(expression, instruction.result());
        if (inserted) {
            added.push_back(std::move(expression));
            return true;
        }
        merge_names(instruction, entry->second);
        substitution_.replace(
            instruction.result(), entry->second,
            is_leaf(instruction.op) ? Substitution::Name::Leave : Substitution::Name::TakeOver);
        return false;
    }

    // One literal that stands for several quantities has no name.
    void merge_names(const Instruction& instruction, ValueId survivor) {
        if (instruction.op != Op::Constant) return;
        std::string& name = module_.values[index_of(survivor)].name;
        if (name != module_.value(instruction.result()).name) name.clear();
    }

    Module& module_;
    Substitution substitution_;
    std::unordered_map<Expression, ValueId, ExpressionHash> available_;
};

}  // namespace

void eliminate_common_subexpressions(ir::Module& module) {
    Merger(module).visit(module.body);
    compact_values(module);
}

}  // namespace intaglio::passes

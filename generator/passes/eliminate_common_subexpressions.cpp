// Value numbering over the region tree: a table of the expressions that are available here. Leaving
// a region forgets what it added.  Loops and ifs themselves are never merged.
#include "generator/passes/eliminate_common_subexpressions.h"

#include <algorithm>
#include <bit>

#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

// Everything that decides an instruction's result.
struct Expression {
    Definition what;
    Type type;
    friend bool operator==(const Expression&, const Expression&) = default;
};

std::uint64_t hash_of(const Expression& expression) {
    std::uint64_t hash = 0;
    const auto mix = [&](std::uint64_t high, std::uint64_t low) {
        hash = (hash ^ (high << 32) ^ low) * 0x9e3779b97f4a7c15ull;
        hash ^= hash >> 29;
    };
    const Definition& what = expression.what;
    const auto& [a, b, c, d] = what.operands;
    const auto& [x, y, z, w] = what.bits;
    mix(index_of(a), index_of(b));
    mix(index_of(c), index_of(d));
    mix(x, y);
    mix(z, w);
    mix(std::bit_cast<std::uint32_t>(what.lanes), static_cast<std::uint32_t>(what.op));
    mix(static_cast<std::uint32_t>(what.slot), static_cast<std::uint32_t>(what.element));
    return hash;
}

// The expressions that are available, newest first: leaving a region takes away those of the end.
class Available {
  public:
    explicit Available(std::size_t most) : newest_(std::bit_ceil(most + 1), none) {}

    // The value of the equal expression; if there is none, `value` from now on, and nullptr.
    const ValueId* find_or_add(const Expression& expression, ValueId value) {
        const std::uint64_t hash = hash_of(expression);
        std::uint32_t& newest = newest_[hash & (newest_.size() - 1)];
        for (std::uint32_t at = newest; at != none; at = entries_[at].next)
            if (entries_[at].hash == hash && entries_[at].expression == expression)
                return &entries_[at].value;
        entries_.push_back({expression, value, hash, newest});
        newest = static_cast<std::uint32_t>(entries_.size()) - 1;
        return nullptr;
    }

    std::size_t count() const { return entries_.size(); }
    void forget_from(std::size_t count) {
        for (; entries_.size() > count; entries_.pop_back())
            newest_[entries_.back().hash & (newest_.size() - 1)] = entries_.back().next;
    }

  private:
    static constexpr std::uint32_t none = ~0u;

    struct Entry {
        Expression expression;
        ValueId value;
        std::uint64_t hash;
        std::uint32_t next;  // of the same place
    };
    std::vector<std::uint32_t> newest_;  // by hash
    std::vector<Entry> entries_;
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
    Definition what = definition_of(instruction);
    const bool turned = what.op == Op::Greater || what.op == Op::GreaterEqual;
    if (what.op == Op::Greater) what.op = Op::Less;
    if (instruction.op == Op::GreaterEqual) what.op = Op::LessEqual;
    if (turned) std::swap(what.operands[0], what.operands[1]);
    if (is_commutative(what.op))
        std::sort(what.operands.begin(), what.operands.begin() + what.operand_count);
    return {what, module.type(instruction.result())};
}

class Merger {
  public:
    explicit Merger(Module& module)
        : module_(module), substitution_(module), available_(module.values.size()) {}

    bool changed() const { return !substitution_.empty(); }

    void visit(Region& region) {
        const std::size_t outside = available_.count();
        rebuild(region, [&](Instruction&& instruction, std::vector<Instruction>& body) {
            substitution_.apply(instruction.operands);
            for (Region& inner : instruction.regions) visit(inner);
            if ((is_arithmetic(instruction.op) || is_sample(instruction.op) ||
                 needs_derivatives(instruction.op)) &&
                !is_first(instruction))
                return;
            body.push_back(std::move(instruction));
        });
        available_.forget_from(outside);
    }

  private:
    bool is_first(const Instruction& instruction) {
        const ValueId* earlier =
            available_.find_or_add(canonical(module_, instruction), instruction.result());
        if (earlier == nullptr) return true;
        merge_names(instruction, *earlier);
        substitution_.replace(
            instruction.result(), *earlier,
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
    Available available_;
};

}  // namespace

bool eliminate_common_subexpressions(ir::Module& module) {
    Merger merger(module);
    merger.visit(module.body);
    return compact_values(module) || merger.changed();
}

}  // namespace intaglio::passes

// Liveness from the outputs backwards.  A value keeps its operands alive; the k-th result of an if
// keeps the k-th yields and the condition alive; the k-th result of a loop keeps the k-th carried
// value, and every condition on which the loop is left.  Cycles through a loop's parameters stay
// dead unless something else needs them.
#include "generator/passes/remove_dead_code.h"

#include <algorithm>

#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

template <typename T>
void erase_at(std::vector<T>& elements, std::size_t index) {
    elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(index));
}

// Takes the k-th carried value out of a loop.
void erase_carried(Instruction& loop, std::size_t k) {
    Region& body = loop.regions[0];
    erase_at(loop.operands, k);
    erase_at(loop.results, k);
    erase_at(body.parameters, k + 1);
    for (Instruction& instruction : body.body) {
        if (instruction.op == Op::BreakIf) erase_at(instruction.operands, k + 1);
        if (instruction.op == Op::Yield) erase_at(instruction.operands, k);
    }
}

// Replaces carried values that keep their initial value, inner loops first.
class Invariants {
  public:
    explicit Invariants(Module& module) : module_(module), substitution_(module) {}

    // Whether there was one.
    bool run() {
        visit(module_.body);
        substitute(module_.body, substitution_);
        return !substitution_.empty();
    }

  private:
    void visit(Region& region) {
        for (Instruction& instruction : region.body) {
            definitions_.record(instruction);
            for (Region& inner : instruction.regions) visit(inner);
            if (instruction.op != Op::Loop) continue;
            for (std::size_t k = 0; k < instruction.operands.size();)
                k = replace_if_invariant(instruction, k) ? 0
                                                         : k + 1;  // one may make another invariant
        }
    }

    bool replace_if_invariant(Instruction& loop, std::size_t k) {
        const ValueId initial = substitution_(loop.operands[k]);
        const ValueId parameter = loop.regions[0].parameters[k + 1];
        const auto keeps = [&](ValueId value) {
            value = substitution_(value);
            return value == initial || value == parameter;
        };
        for (const Instruction& instruction : loop.regions[0].body) {
            if (instruction.op == Op::BreakIf && !keeps(instruction.operands[k + 1])) return false;
            if (instruction.op == Op::Yield && !keeps(instruction.operands[k])) return false;
        }
        const auto name = is_leaf(definitions_[initial].op) ? Substitution::Name::Leave
                                                            : Substitution::Name::TakeOver;
        substitution_.replace(parameter, initial, name);
        substitution_.replace(loop.results[k], initial, name);
        erase_carried(loop, k);
        return true;
    }

    Module& module_;
    Substitution substitution_;
    Definitions definitions_;
};

class Liveness {
  public:
    explicit Liveness(Module& module)
        : module_(module), owners_(module.values.size()), live_(module.values.size()) {}

    // Whether anything was dead.
    bool run() {
        find_owners(module_.body);
        mark(module_.body.body.back().operands);
        while (!pending_.empty()) {
            const ValueId value = pending_.back();
            pending_.pop_back();
            const Owner& owner = owners_[index_of(value)];
            if (owner.instruction != nullptr) mark_needs(*owner.instruction, owner.index);
        }
        sweep(module_.body);
        return swept_;
    }

  private:
    // Where a value comes from: a result of an instruction or a carried value of a loop, and which
    // one.
    struct Owner {
        const Instruction* instruction = nullptr;  // null: the index of a loop
        std::size_t index = 0;
    };

    void find_owners(const Region& region) {
        for (const Instruction& instruction : region.body) {
            for (std::size_t i = 0; i < instruction.results.size(); ++i)
                owners_[index_of(instruction.results[i])] = {&instruction, i};
            for (const Region& inner : instruction.regions) {
                for (std::size_t i = 1; i < inner.parameters.size(); ++i)
                    owners_[index_of(inner.parameters[i])] = {&instruction, i - 1};
                find_owners(inner);
            }
        }
    }

    void mark(ValueId value) {
        if (live_[index_of(value)]) return;
        live_[index_of(value)] = true;
        pending_.push_back(value);
    }

    void mark(const std::vector<ValueId>& values) {
        for (ValueId value : values) mark(value);
    }

    void mark_needs(const Instruction& instruction, std::size_t k) {
        if (instruction.op == Op::Loop) {
            mark(instruction.operands[k]);
            mark(instruction.results[k]);
            mark(instruction.regions[0].parameters[k + 1]);
            for (const Instruction& child : instruction.regions[0].body) {
                if (child.op == Op::Yield) mark(child.operands[k]);
                if (child.op != Op::BreakIf) continue;
                mark(child.operands[0]);
                mark(child.operands[k + 1]);
            }
            return;
        }
        mark(instruction.operands);
        for (const Region& region : instruction.regions) mark(region.body.back().operands[k]);
    }

    bool is_live(ValueId value) const { return live_[index_of(value)]; }

    void sweep(Region& region) {
        rebuild(region, [&](Instruction&& instruction, std::vector<Instruction>& body) {
            const bool always = is_terminator(instruction.op) || instruction.op == Op::BreakIf;
            if (!always && std::none_of(instruction.results.begin(), instruction.results.end(),
                                        [&](ValueId result) { return is_live(result); })) {
                swept_ = true;
                return;
            }
            if (has_regions(instruction.op)) sweep_results(instruction);
            for (Region& inner : instruction.regions) sweep(inner);
            body.push_back(std::move(instruction));
        });
    }

    void sweep_results(Instruction& instruction) {
        for (std::size_t k = instruction.results.size(); k-- > 0;) {
            if (is_live(instruction.results[k])) continue;
            swept_ = true;
            if (instruction.op == Op::Loop) {
                erase_carried(instruction, k);
                continue;
            }
            erase_at(instruction.results, k);
            for (Region& inner : instruction.regions) erase_at(inner.body.back().operands, k);
        }
    }

    Module& module_;
    std::vector<Owner> owners_;
    std::vector<bool> live_;
    std::vector<ValueId> pending_;
    bool swept_ = false;
};

}  // namespace

bool remove_dead_code(ir::Module& module) {
    bool changed = Invariants(module).run();
    changed |= Liveness(module).run();
    changed |= remove_unused_declarations(module);
    changed |= compact_values(module);
    return changed;
}

}  // namespace intaglio::passes

// Every value has a depth: the number of loops around its definition.  In a loop at depth d, an
// instruction whose operands are all of a depth below d may move out, to depth d - 1, where it is
// judged again.
#include "generator/passes/hoist_loop_invariants.h"

#include <algorithm>

#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

class Hoister {
  public:
    explicit Hoister(Module& module) : depths_(module.values.size()) {}

    bool changed() const { return changed_; }

    // One region at a depth.  `hoisted` collects what leaves the innermost loop (null outside
    // loops); `always`: the first iteration of that loop executes the region.
    void visit(Region& region, int depth, std::vector<Instruction>* hoisted, bool always) {
        for (ValueId parameter : region.parameters) set_depth(parameter, depth);
        rebuild(region, [&](Instruction&& instruction, std::vector<Instruction>& body) {
            if (instruction.op == Op::Loop) {
                std::vector<Instruction> invariant;
                visit(instruction.regions[0], depth + 1, &invariant,
                      instruction.loop.trip_count > 0);
                for (Instruction& moved : invariant)
                    place(std::move(moved), depth, body, hoisted, always);
            } else {
                for (Region& inner : instruction.regions) visit(inner, depth, hoisted, false);
            }
            if (instruction.op == Op::BreakIf) always = false;
            place(std::move(instruction), depth, body, hoisted, always);
        });
    }

  private:
    void place(Instruction&& instruction, int depth, std::vector<Instruction>& body,
               std::vector<Instruction>* hoisted, bool always) {
        const bool moves =
            hoisted != nullptr && may_move(instruction, always) && is_invariant(instruction, depth);
        changed_ |= moves;
        const int new_depth = moves ? depth - 1 : depth;
        for (ValueId result : instruction.results) set_depth(result, new_depth);
        if (moves)
            for (const Region& region : instruction.regions) lift(region);
        (moves ? *hoisted : body).push_back(std::move(instruction));
    }

    static bool may_move(const Instruction& instruction, bool always) {
        if (is_arithmetic(instruction.op)) return true;
        return always && (is_sample(instruction.op) || has_regions(instruction.op)) &&
               !needs_derivatives(instruction.op);
    }

    // Values inside a region count as outside if the region itself moves: they are marked as one of
    // its own.
    bool is_invariant(const Instruction& instruction, int depth) const {
        std::vector<bool> own;
        if (has_regions(instruction.op)) {
            own.resize(depths_.size());
            mark_own(instruction, own);
        }
        bool invariant = true;
        const auto check = [&](const std::vector<ValueId>& operands) {
            for (ValueId operand : operands)
                invariant = invariant && (depths_[index_of(operand)] < depth ||
                                          (!own.empty() && own[index_of(operand)]));
        };
        check(instruction.operands);
        for (const Region& region : instruction.regions)
            for_each_instruction(region, [&](const Instruction& inner) { check(inner.operands); });
        return invariant;
    }

    static void mark_own(const Instruction& instruction, std::vector<bool>& own) {
        for (ValueId result : instruction.results) own[index_of(result)] = true;
        for (const Region& region : instruction.regions) {
            for (ValueId parameter : region.parameters) own[index_of(parameter)] = true;
            for (const Instruction& inner : region.body) mark_own(inner, own);
        }
    }

    // What moved along with its loop or if is one loop further out.
    void lift(const Region& region) {
        for (ValueId parameter : region.parameters) --depths_[index_of(parameter)];
        for (const Instruction& instruction : region.body) {
            for (ValueId result : instruction.results) --depths_[index_of(result)];
            for (const Region& inner : instruction.regions) lift(inner);
        }
    }

    void set_depth(ValueId value, int depth) { depths_[index_of(value)] = depth; }

    std::vector<int> depths_;
    bool changed_ = false;
};

}  // namespace

bool hoist_loop_invariants(ir::Module& module) {
    if (!contains_op(module.body, Op::Loop)) return compact_values(module);
    Hoister hoister(module);
    hoister.visit(module.body, 0, nullptr, true);
    return compact_values(module) || hoister.changed();
}

}  // namespace intaglio::passes

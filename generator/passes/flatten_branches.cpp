// The bodies of both sides go straight into the region around the outermost flattened if, so that a
// chain of nested ifs, as unrolling an early exit leaves it, costs time in proportion to its
// instructions.
#include "generator/passes/flatten_branches.h"

#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

class Flattener {
  public:
    Flattener(Module& module, Branches which) : substitution_(module), which_(which) {}

    bool changed() const { return changed_; }

    void visit(Region& region) {
        rebuild(region, [&](Instruction&& instruction, std::vector<Instruction>& body) {
            flatten(std::move(instruction), body);
        });
    }

  private:
    void flatten(Instruction&& instruction, std::vector<Instruction>& body) {
        substitution_.apply(instruction.operands);
        if (instruction.op == Op::If && (which_ == Branches::All || loop_depth_ == 0)) {
            changed_ = true;
            select_results(instruction, body);
            return;
        }
        if (instruction.op == Op::Loop) ++loop_depth_;
        for (Region& inner : instruction.regions) visit(inner);
        if (instruction.op == Op::Loop) --loop_depth_;
        body.push_back(std::move(instruction));
    }

    void select_results(Instruction& branch, std::vector<Instruction>& body) {
        std::array<std::vector<ValueId>, 2> yields;
        for (std::size_t side = 0; side < 2; ++side) {
            for (Instruction& inner : branch.regions[side].body) {
                if (inner.op != Op::Yield) {
                    flatten(std::move(inner), body);
                    continue;
                }
                yields[side] = inner.operands;
                substitution_.apply(yields[side]);
            }
        }
        for (std::size_t k = 0; k < branch.results.size(); ++k) {
            Instruction select;
            select.op = Op::Select;
            select.operands = {branch.operands[0], yields[0][k], yields[1][k]};
            select.results = {branch.results[k]};
            select.origin = branch.origin;
            body.push_back(std::move(select));
        }
    }

    Substitution substitution_;
    Branches which_;
    int loop_depth_ = 0;
    bool changed_ = false;
};

}  // namespace

bool flatten_branches(ir::Module& module, Branches which) {
    if (!contains_op(module.body, Op::If)) return compact_values(module);
    Flattener flattener(module, which);
    flattener.visit(module.body);
    return compact_values(module) || flattener.changed();
}

}  // namespace intaglio::passes

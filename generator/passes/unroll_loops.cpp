// Inner loops first, so that each body is copied in its final form.  Early exits are kept on a list
// while copying and closed from the last to the first: no recursion, and no copy of what an exit
// guards.
#include "generator/passes/unroll_loops.h"

#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

// A break_if of one iteration: what it tests, what it leaves the loop with, and what runs if it
// does not.
struct Exit {
    ValueId condition;
    std::vector<ValueId> values;
    Origin origin;
    std::vector<Instruction> rest;  // EarlyExit::Branch only
};

bool is_written_out(const Instruction& instruction, Loops which) {
    return instruction.op == Op::Loop &&
           (which == Loops::All || instruction.loop.form == LoopForm::Unrolled);
}

class Unroller {
  public:
    Unroller(Module& module, Loops which, EarlyExit early_exit)
        : module_(module), substitution_(module), which_(which), early_exit_(early_exit) {}

    void visit(Region& region) {
        rebuild(region, [&](Instruction&& instruction, std::vector<Instruction>& body) {
            substitution_.apply(instruction.operands);
            for (Region& inner : instruction.regions) visit(inner);
            if (is_written_out(instruction, which_))
                expand(instruction, body);
            else
                body.push_back(std::move(instruction));
        });
    }

  private:
    void expand(const Instruction& loop, std::vector<Instruction>& body) {
        const Region& region = loop.regions[0];
        Cloner copy(module_, module_);
        std::vector<ValueId> carried = loop.operands;
        std::vector<Exit> exits;
        const auto append = [&](Instruction instruction) {
            const bool nested = early_exit_ == EarlyExit::Branch && !exits.empty();
            (nested ? exits.back().rest : body).push_back(std::move(instruction));
        };
        for (int i = 0; i < loop.loop.trip_count; ++i) {
            Instruction index = make_int_constant(module_, i, loop.origin);
            copy.bind(region.parameters[0], index.result());
            append(std::move(index));
            for (std::size_t k = 0; k < carried.size(); ++k)
                copy.bind(region.parameters[k + 1], carried[k]);
            for (const Instruction& instruction : region.body) {
                if (instruction.op == Op::Yield) {
                    carried = copy(instruction.operands);
                } else if (instruction.op == Op::BreakIf) {
                    std::vector<ValueId> values = copy(instruction.operands);
                    const ValueId condition = values.front();
                    values.erase(values.begin());
                    exits.push_back({condition, std::move(values), instruction.origin, {}});
                } else {
                    append(copy.clone(instruction));
                }
            }
        }
        close(loop, exits, std::move(carried), body);
    }

    // From the last exit to the first: the values after the loop are the exit's if it is taken,
    // else those so far.
    void close(const Instruction& loop, std::vector<Exit>& exits, std::vector<ValueId> values,
               std::vector<Instruction>& body) {
        for (std::size_t i = exits.size(); i-- > 0;) {
            const bool nested = early_exit_ == EarlyExit::Branch && i > 0;
            std::vector<Instruction>& around = nested ? exits[i - 1].rest : body;
            values = early_exit_ == EarlyExit::Branch
                         ? close_with_branch(exits[i], values, around)
                         : close_with_selects(exits[i], values, around);
        }
        for (std::size_t k = 0; k < values.size(); ++k)
            substitution_.replace(loop.results[k], values[k]);
    }

    std::vector<ValueId> close_with_branch(Exit& exit, const std::vector<ValueId>& values,
                                           std::vector<Instruction>& around) {
        Instruction branch;
        branch.op = Op::If;
        branch.operands = {exit.condition};
        branch.origin = exit.origin;
        branch.regions.resize(2);
        branch.regions[0].body.push_back(yield(exit.values, exit.origin));
        branch.regions[1].body = std::move(exit.rest);
        branch.regions[1].body.push_back(yield(values, exit.origin));
        for (ValueId value : values)
            branch.results.push_back(module_.add_value(module_.type(value)));
        std::vector<ValueId> results = branch.results;
        around.push_back(std::move(branch));
        return results;
    }

    std::vector<ValueId> close_with_selects(const Exit& exit, std::vector<ValueId> values,
                                            std::vector<Instruction>& around) {
        for (std::size_t k = 0; k < values.size(); ++k) {
            if (values[k] == exit.values[k]) continue;
            const std::array operands = {exit.condition, exit.values[k], values[k]};
            around.push_back(make_instruction(module_, Op::Select, module_.type(values[k]),
                                              operands, exit.origin));
            values[k] = around.back().result();
        }
        return values;
    }

    static Instruction yield(const std::vector<ValueId>& values, const Origin& origin) {
        Instruction instruction;
        instruction.op = Op::Yield;
        instruction.operands = values;
        instruction.origin = origin;
        return instruction;
    }

    Module& module_;
    Substitution substitution_;
    Loops which_;
    EarlyExit early_exit_;
};

}  // namespace

bool unroll_loops(ir::Module& module, Loops which, EarlyExit early_exit) {
    bool any = false;
    for_each_instruction(module.body, [&](const Instruction& instruction) {
        any |= is_written_out(instruction, which);
    });
    if (any) Unroller(module, which, early_exit).visit(module.body);
    return compact_values(module) || any;
}

}  // namespace intaglio::passes

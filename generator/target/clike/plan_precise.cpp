// The third step of the plan: what the keyword `precise` must be written on.
#include "generator/target/clike/plan.h"

namespace intaglio::clike {

using ir::Instruction;
using ir::Op;
using ir::Region;
using ir::ValueId;

// Every sum, difference and product must end up under `precise`.  Outputs are declared so by the
// printer; this finds what the keyword does not reach from there and declares (or splits off)
// locals and variables for it.
class PrecisePlanner {
  public:
    explicit PrecisePlanner(Plan& plan) : plan_(plan), reached_(plan.module_.values.size()) {}

    void run() {
        for (const Instruction* instruction : plan_.uses_.instructions())
            if (instruction->op == Op::Return)
                for (ValueId output : instruction->operands) reach(output);
        const auto& instructions = plan_.uses_.instructions();
        for (auto it = instructions.rbegin(); it != instructions.rend(); ++it) {
            const Instruction& instruction = **it;
            const Op op = instruction.op;
            if (op != Op::Add && op != Op::Sub && op != Op::Mul) continue;
            const ValueId result = instruction.result();
            if (plan_.module_.type(result).scalar != ir::Scalar::Float) continue;
            if (plan_.form(result) == Form::Dead || reached_[ir::index_of(result)]) continue;
            Form& form = plan_.forms_[ir::index_of(result)];
            if (form == Form::Variable) {
                plan_.variables_[static_cast<std::size_t>(plan_.variable(result))].precise = true;
            } else {
                form = Form::Local;
                plan_.precise_[ir::index_of(result)] = true;
            }
            reach(result);
        }
    }

  private:
    void reach(ValueId value) {
        if (reached_[ir::index_of(value)]) return;
        reached_[ir::index_of(value)] = true;
        if (plan_.form(value) == Form::Variable && plan_.variable(value) >= 0)
            for (std::size_t i = 0; i < plan_.variables_of_.size(); ++i)
                if (plan_.variables_of_[i] == plan_.variable(value)) reach(static_cast<ValueId>(i));
        const Instruction* definition = plan_.uses_.definition(value);
        if (!definition) {
            reach_stores_of_parameter(value);
        } else if (definition->op == Op::Loop || definition->op == Op::If) {
            for (std::size_t i = 0; i < definition->results.size(); ++i)
                if (definition->results[i] == value) reach_stores(*definition, i);
        } else {
            // The compiler does not look into an expression that a component is taken of.
            const bool stops = definition->op == Op::Swizzle &&
                               plan_.form(definition->operands[0]) == Form::Inline;
            if (!stops ||
                is_splat(plan_.module_, *definition))  // a splat is a constructor or a cast
                for (ValueId operand : definition->operands) reach(operand);
        }
    }

    void reach_stores_of_parameter(ValueId parameter) {
        const Region& body = *plan_.uses_.home(parameter).region;
        for (std::size_t i = 1; i < body.parameters.size(); ++i)
            if (body.parameters[i] == parameter) reach_stores(*plan_.uses_.owner(body), i - 1);
    }

    void reach_stores(const Instruction& loop_or_if, std::size_t i) {
        if (loop_or_if.op == Op::Loop) reach(loop_or_if.operands[i]);
        for (const Region& region : loop_or_if.regions) {
            reach(region.body.back().operands[i]);
            for (const Instruction& instruction : region.body)
                if (instruction.op == Op::BreakIf) reach(instruction.operands[i + 1]);
        }
    }

    Plan& plan_;
    std::vector<bool> reached_;
};

void Plan::mark_precise() { PrecisePlanner(*this).run(); }

}  // namespace intaglio::clike

// Decides, before anything is printed, what becomes of each value: part of the expression that
// reads it, a local of its own, or the contents of a variable that a loop or an if assigns.
//
// A variable holds several values one after the other (SSA out of structured form): the initial
// value of a loop, its region's parameter, its next value and its result share one where no old
// value is read after a new one was stored. What cannot share is assigned at the end of the region,
// all at once (see parallel_assignment).
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "generator/ir/module.h"
#include "generator/target/clike/uses.h"

namespace intaglio::clike {

enum class Form : std::uint8_t {
    Dead,      // nobody reads it: not printed
    Inline,    // printed where it is read
    Local,     // a declaration at its place
    Variable,  // stored in a variable
};

struct Variable {
    ir::Type type;
    std::string name;      // wanted; empty: none of its values was named
    bool precise = false;  // must be declared so
    bool index = false;    // counts a loop's iterations: nobody else may store into it
};

// What the plan says of a Loop or an If.
struct RegionPlan {
    std::vector<int> variables;  // for each carried value or result
    std::vector<bool> declared;  // false: the variable exists already
    // Loop: carried values whose next value is another's current one, stored before the statement
    // at this index of the body instead of at its end; -1: not so.
    std::vector<int> moved_before;
};

// Which languages' rules the plan follows.  How far `precise` reaches backwards from an output is
// the compiler's business: glslang stops at a component taken from an expression and at the
// condition of a loop or an if.
struct PlanOptions {
    bool precise = false;  // mark and split what the keyword would not reach
};

class Plan {
  public:
    Plan(const ir::Module& module, PlanOptions options);

    Form form(ir::ValueId value) const { return forms_[ir::index_of(value)]; }
    // The variable that holds the value; -1 unless its form is Variable.
    int variable(ir::ValueId value) const { return variables_of_[ir::index_of(value)]; }
    const std::vector<Variable>& variables() const { return variables_; }
    const RegionPlan& region_plan(const ir::Instruction& loop_or_if) const {
        return regions_.at(&loop_or_if);
    }
    bool is_precise(ir::ValueId value) const { return precise_[ir::index_of(value)]; }
    const Uses& uses() const { return uses_; }

  private:
    friend class FormPlanner;
    friend class VariablePlanner;
    friend class PrecisePlanner;

    void mark_precise();

    const ir::Module& module_;
    Uses uses_;
    std::vector<Form> forms_;
    std::vector<int> variables_of_;
    std::vector<bool> precise_;
    std::vector<Variable> variables_;
    std::unordered_map<const ir::Instruction*, RegionPlan> regions_;
};

// A swizzle that repeats one scalar, or a composition of one scalar repeated; the scalar is operand
// 0.
bool is_splat(const ir::Module& module, const ir::Instruction& instruction);

}  // namespace intaglio::clike

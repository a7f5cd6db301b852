// A loop read as a search for a first hit: which of its values are functions of the iteration's
// index and of values from outside alone, and what they are.  Private to lower_first_hit.
//
// A carried value is memoryless if the value it takes over is such a function: in iteration i it is
// that function at i - 1, and `above = below` is `below` at i - 1.  Its value before the loop may
// differ from the function at -1; then the function holds only from iteration 1 on.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "generator/ir/evaluate.h"
#include "generator/passes/rewrite.h"

namespace intaglio::passes {

class FirstHitLoop {
  public:
    // Both must outlive this, and `definitions` must know the loop's body and what is before it.
    // `zero_products`: x + 0 y counts as x, which differs where y is no number.
    FirstHitLoop(const ir::Module& module, const Definitions& definitions,
                 const ir::Instruction& loop, bool zero_products = false);

    // Why the loop is no such search; empty if it is one.
    const std::string& refusal() const { return refusal_; }

    int trips() const { return loop_.loop.trip_count; }
    const ir::Instruction& loop() const { return loop_; }
    ir::ValueId condition() const { return exit_->operands[0]; }
    const ir::Origin& exit_origin() const { return exit_->origin; }
    // Result k after leaving early, and the value it would have in the next iteration.
    ir::ValueId exit_value(std::size_t k) const { return exit_->operands[k + 1]; }
    ir::ValueId next_value(std::size_t k) const { return body().back().operands[k]; }
    ir::ValueId initial_value(std::size_t k) const { return loop_.operands[k]; }

    bool is_inside(ir::ValueId value) const;
    bool is_index(ir::ValueId value) const;
    std::optional<std::size_t> parameter(ir::ValueId value) const;  // which carried value
    const std::vector<ir::Instruction>& body() const { return loop_.regions[0].body; }
    // The instruction of the body that defines the value.
    const ir::Instruction& instruction(ir::ValueId value) const;

    // True if the value is known for each index, so that it needs no instruction.
    bool is_tabulated(ir::ValueId value) const;
    // The value in the iteration, as its function gives it: -1, -2 are before the loop.  Nothing if
    // it is not tabulated, or if the function does not hold there.
    std::optional<ir::ConstantBits> constant_at(ir::ValueId value, int iteration) const;
    // The first iteration from which on the value is its function of the index.
    int valid_from(ir::ValueId value) const { return valid_from_.at(value); }

  private:
    using Place = std::pair<ir::ValueId, int>;  // a value in an iteration

    std::string find_exit();
    std::string find_cycles();
    bool visit(ir::ValueId value);
    int first_valid(ir::ValueId value) const;
    std::optional<ir::ConstantBits> compute_at(ir::ValueId value, int iteration) const;
    bool is_known_outside(ir::ValueId value) const;
    bool is_initially(std::size_t k) const;
    bool matches(ir::ValueId outside, ir::ValueId inside, int iteration) const;
    bool is_zero(ir::ValueId inside, int iteration) const;
    bool matches_constant(ir::ValueId outside, ir::ValueId inside,
                          const ir::ConstantBits& bits) const;

    const ir::Module& module_;
    const Definitions& definitions_;
    const ir::Instruction& loop_;
    const bool zero_products_;
    const ir::Instruction* exit_ = nullptr;
    std::map<ir::ValueId, const ir::Instruction*> instructions_;
    std::map<ir::ValueId, std::size_t> parameters_;
    std::map<ir::ValueId, bool> visited_;  // true while on the way
    std::map<ir::ValueId, bool> tabulated_;
    std::map<ir::ValueId, int> valid_from_;
    mutable std::map<Place, std::optional<ir::ConstantBits>> constants_;
    std::string refusal_;
};

}  // namespace intaglio::passes

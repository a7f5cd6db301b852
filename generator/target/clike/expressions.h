// Rebuilds expressions from instructions: values that the plan inlines become subexpressions, with
// no more parentheses than the grammar needs and none of the grouping lost ((a + b) + c and a + (b
// + c) round differently).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "generator/base/result.h"
#include "generator/target/clike/plan.h"
#include "generator/target/clike/spelling.h"

namespace intaglio::clike {

// What the shell of a stage or function calls the things outside its body.
struct OuterNames {
    std::vector<std::string> inputs;    // as read: "uv", "pixel.uv"
    std::vector<std::string> uniforms;  // arrays get "[n]"
    std::vector<std::string> samplers;
};

class Expressions {
  public:
    Expressions(const ir::Module& module, const Plan& plan, const Spelling& spelling,
                const OuterNames& outer);

    // The text that reads the value at the current place.
    std::string read(ir::ValueId value) { return operand(value, Binds::Ternary); }
    // The text that computes it, whatever the plan says of its form.
    std::string compute(const ir::Instruction& instruction);
    // "!(a < b)".
    std::string negated(ir::ValueId condition);
    // The variables that reading the value reads.
    std::vector<int> variables_read(ir::ValueId value) const;

    void name_local(ir::ValueId value, std::string name) {
        locals_[ir::index_of(value)] = std::move(name);
    }
    void name_variable(int variable, std::string name) {
        variable_names_[static_cast<std::size_t>(variable)] = std::move(name);
    }
    const std::string& variable_name(int variable) const {
        return variable_names_[static_cast<std::size_t>(variable)];
    }

    // The first thing that the language could not say.
    const std::optional<Diagnostic>& error() const { return error_; }

  private:
    struct Text {
        std::string text;
        Binds binds;
    };
    Text expression(ir::ValueId value);
    Text of_instruction(const ir::Instruction& instruction);
    Text constant(const ir::Instruction& instruction);
    Text swizzle(const ir::Instruction& instruction);
    Text compose(const ir::Instruction& instruction);
    Text fill(const OpSpelling& row, const ir::Instruction& instruction);
    std::string operand(ir::ValueId value, Binds at_least);
    std::string literal(ir::Scalar scalar, std::uint32_t bits, const ir::Instruction& instruction);
    const OpSpelling* row_of(const ir::Instruction& instruction);
    // The scalar that an inlined vector repeats, as text.
    std::optional<Text> repeated_scalar(ir::ValueId value);
    std::vector<bool> collapsible(const OpSpelling& row, const ir::Instruction& instruction);
    void fail(const ir::Instruction& instruction, std::string message);

    const ir::Module& module_;
    const Plan& plan_;
    const Spelling& spelling_;
    const OuterNames& outer_;
    std::vector<std::string> locals_;
    std::vector<std::string> variable_names_;
    std::optional<Diagnostic> error_;
};

// A name for a value that the DSL left without one, from what it is: "texel", "product".
std::string_view fallback_name(const ir::Module& module, const Uses& uses, ir::ValueId value);

}  // namespace intaglio::clike

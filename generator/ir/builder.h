// Appends instructions to a module under construction.  Result types follow from the ops table; a
// wrong operand type is a bug of ours and asserts (the verifier reports the same as a sentence for
// parsed text).
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "generator/ir/module.h"

namespace intaglio::ir {

// The result type of an op over these operand types; asserts if the type rule has no single answer
// (leaves, regions).
Type result_type(Op op, std::span<const Type> operands, int swizzle_width = 0);

class Builder {
  public:
    explicit Builder(Module& module);

    // Instructions appended from here on carry this origin.
    void set_origin(Origin origin) { origin_ = origin; }
    Origin origin() const { return origin_; }

    ValueId constant(Type type, std::array<std::uint32_t, 4> bits);
    ValueId constant(float value);
    ValueId constant(int value);
    ValueId constant(bool value);
    ValueId input(int slot);
    ValueId uniform(int slot, int element = 0);
    ValueId emit(Op op, std::initializer_list<ValueId> operands);
    ValueId emit(Op op, std::span<const ValueId> operands);
    ValueId compose(std::span<const ValueId> operands);
    // Letters of "xyzw"; of a scalar, "xx".. repeats it.  The identity swizzle is dropped.
    ValueId swizzle(ValueId value, std::string_view letters);
    ValueId sample(Op op, int sampler, std::initializer_list<ValueId> operands);

    // Opens a loop; the region's parameters are the index, then one for each initial value.
    struct LoopScope {
        ValueId index;
        std::vector<ValueId> carried;
    };
    LoopScope begin_loop(LoopInfo loop, std::span<const ValueId> initial);
    void break_if(ValueId condition, std::span<const ValueId> carried);
    // Closes the innermost loop; the results are the carried values after it.
    std::vector<ValueId> end_loop(std::span<const ValueId> next);

    void begin_if(ValueId condition);
    void begin_else(std::span<const ValueId> then_values);
    std::vector<ValueId> end_if(std::span<const ValueId> else_values);

    void finish(std::span<const ValueId> outputs);

    // Appends an instruction as it is; its results must be values of this module.
    void append(Instruction instruction);
    Module& module() { return module_; }
    // The region being filled, innermost first; the last is the module's body.
    Region& current_region();
    // How many loops and ifs are open.
    int depth() const { return static_cast<int>(frames_.size()); }

  private:
    struct Frame {
        Instruction instruction;  // the open Loop or If
        Region region;            // its region being filled
    };
    Instruction make(Op op, std::span<const ValueId> operands) const;
    void close_region(std::span<const ValueId> values);

    Module& module_;
    Origin origin_;
    std::vector<Frame> frames_;
};

}  // namespace intaglio::ir

// The operations of the intermediate representation: one table row each, read by the printer,
// parser, verifier, evaluator, the targets and the documentation.
//
// Floating point is IEEE 754 binary32, round to nearest even, no contraction, denormals flushed to
// zero where the device does so.  Where a row says "device", the result may differ by the stated
// bound between devices; everything else is exact to the bit on every target.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace intaglio::ir {

enum class Op : std::uint8_t {
    // Leaves.
    Constant,
    Input,
    Uniform,
    // Arithmetic, componentwise.
    Add,
    Sub,
    Mul,
    Div,
    Neg,
    Abs,
    Min,
    Max,
    Saturate,
    Floor,
    Frac,
    Sqrt,
    Rsqrt,
    Exp2,
    Log2,
    Pow,
    Sin,
    Cos,
    Lerp,
    // Across components.
    Dot,
    Cross,
    // Comparison and choice.
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Not,
    Select,
    // Conversion and shape.
    ToFloat,
    Compose,
    Swizzle,
    // Texture reads and screen-space derivatives.
    SampleLevel,
    SampleGrad,
    SampleImplicit,
    Ddx,
    Ddy,
    // Structured control flow and terminators.
    Loop,
    If,
    BreakIf,
    Yield,
    Return,
};

// How operand types decide the result type.
enum class TypeRule : std::uint8_t {
    Leaf,         // the type is declared: by the constant, the input or the uniform
    SameNumeric,  // operands and result: one type, float or int of any width
    SameFloat,    // operands and result: one float type of any width
    Dot,          // two equal float types; result float1
    Cross,        // two float3; result float3
    Compare,      // two equal float1 or int1; result bool1
    Logic,        // operands and result bool1
    Select,       // bool1, then two of one type; result that type
    ToFloat,      // int of any width; result float of the same width
    Compose,  // 2 to 4 operands of one scalar kind, widths adding up to the result's width, at most
              // 4
    Swizzle,  // one operand of any kind; result width = number of swizzle letters
    Sample,   // coordinate of the sampler's dimension, then level float1 or two gradients; result
              // float4
    Loop,     // operands = initial carried values, results of the same types; one region (see
              // module.h)
    If,       // bool1; results given by the two regions' yields
    BreakIf,  // bool1, then one value for each carried value of the enclosing loop
    Terminator,  // values that the region or module yields
};

constexpr int any_count = -1;

struct OpInfo {
    Op op;
    std::string_view name;  // in IR text
    TypeRule type_rule;
    int operand_count;           // any_count: varies
    bool bit_exact;              // the same bits on every device that computes in binary32
    std::string_view semantics;  // one sentence; docs/ir.md is made of these
};

// The row of an op.
const OpInfo& info(Op op);
// All rows, in the order of the enumeration.
std::span<const OpInfo> all_ops();
// The op of this name, if there is one.
std::optional<Op> op_named(std::string_view name);

inline bool is_terminator(Op op) { return op == Op::Yield || op == Op::Return; }
inline bool has_regions(Op op) { return op == Op::Loop || op == Op::If; }
inline bool is_sample(Op op) {
    return op == Op::SampleLevel || op == Op::SampleGrad || op == Op::SampleImplicit;
}
// True if the value depends on neighbouring pixels: such an op must stay out of loops and branches.
inline bool needs_derivatives(Op op) {
    return op == Op::SampleImplicit || op == Op::Ddx || op == Op::Ddy;
}

}  // namespace intaglio::ir

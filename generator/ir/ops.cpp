// The ops table.  The static_assert at the end makes a missing, doubled or misplaced row a compile
// error.
#include "generator/ir/ops.h"

#include <array>

namespace intaglio::ir {
namespace {

constexpr bool exact = true;
constexpr bool device = false;

constexpr std::array table = std::to_array<OpInfo>({
    {Op::Constant, "const", TypeRule::Leaf, 0, exact, "A value known while generating"},
    {Op::Input, "input", TypeRule::Leaf, 0, exact,
     "A vertex attribute, an interpolated value, or a function parameter"},
    {Op::Uniform, "uniform", TypeRule::Leaf, 0, exact,
     "A value that is the same for a whole draw; arrays are read by a constant element"},

    {Op::Add, "add", TypeRule::SameNumeric, 2, exact, "a + b, rounded once; ints wrap"},
    {Op::Sub, "sub", TypeRule::SameNumeric, 2, exact, "a - b, rounded once; ints wrap"},
    {Op::Mul, "mul", TypeRule::SameNumeric, 2, exact, "a * b, rounded once; ints wrap"},
    {Op::Div, "div", TypeRule::SameFloat, 2, device,
     "a / b; correctly rounded on lavapipe, 2.5 ulp allowed by Vulkan; x / 0 is inf or NaN and "
     "must not be relied on"},
    {Op::Neg, "neg", TypeRule::SameNumeric, 1, exact, "-a; flips the sign bit of a float"},
    {Op::Abs, "abs", TypeRule::SameNumeric, 1, exact,
     "Absolute value; clears the sign bit of a float"},
    {Op::Min, "min", TypeRule::SameNumeric, 2, exact,
     "The smaller operand; if one is NaN, the other; either zero of two zeros"},
    {Op::Max, "max", TypeRule::SameNumeric, 2, exact,
     "The larger operand; if one is NaN, the other; either zero of two zeros"},
    {Op::Saturate, "saturate", TypeRule::SameFloat, 1, exact, "min(max(a, 0), 1); NaN gives 0"},
    {Op::Floor, "floor", TypeRule::SameFloat, 1, exact, "The largest integer not above a"},
    {Op::Frac, "frac", TypeRule::SameFloat, 1, exact, "a - floor(a), rounded once"},
    {Op::Sqrt, "sqrt", TypeRule::SameFloat, 1, device,
     "Square root; correctly rounded on lavapipe; NaN below 0"},
    {Op::Rsqrt, "rsqrt", TypeRule::SameFloat, 1, device,
     "1 / sqrt(a), both rounded, on lavapipe; 2 ulp allowed by Vulkan; a <= 0 must not be relied "
     "on"},
    {Op::Exp2, "exp2", TypeRule::SameFloat, 1, device, "2^a; 3.1 ulp on lavapipe"},
    {Op::Log2, "log2", TypeRule::SameFloat, 1, device,
     "Base-2 logarithm; absolute error 1.1e-6 on lavapipe; a <= 0 must not be relied on"},
    {Op::Pow, "pow", TypeRule::SameFloat, 2, device,
     "exp2(b * log2(a)); relative error 4e-6 on lavapipe; a <= 0 must not be relied on"},
    {Op::Sin, "sin", TypeRule::SameFloat, 1, device,
     "Sine of radians; 1.5 ulp on lavapipe within [-pi, pi]"},
    {Op::Cos, "cos", TypeRule::SameFloat, 1, device,
     "Cosine of radians; 1.5 ulp on lavapipe within [-pi, pi]"},
    {Op::Lerp, "lerp", TypeRule::SameFloat, 3, device,
     "a * (1 - c) + b * c, each step rounded, on lavapipe; GPUs may compute a + (b - a) * c"},

    {Op::Dot, "dot", TypeRule::Dot, 2, device,
     "((a.x b.x + a.y b.y) + a.z b.z) + a.w b.w, each step rounded, on lavapipe; order and fusing "
     "are the device's"},
    {Op::Cross, "cross", TypeRule::Cross, 2, device,
     "(a.yzx * b.zxy) - (a.zxy * b.yzx), each step rounded, on lavapipe"},

    {Op::Less, "less", TypeRule::Compare, 2, exact, "a < b; false if either is NaN"},
    {Op::LessEqual, "less_equal", TypeRule::Compare, 2, exact, "a <= b; false if either is NaN"},
    {Op::Greater, "greater", TypeRule::Compare, 2, exact, "a > b; false if either is NaN"},
    {Op::GreaterEqual, "greater_equal", TypeRule::Compare, 2, exact,
     "a >= b; false if either is NaN"},
    {Op::Equal, "equal", TypeRule::Compare, 2, exact, "a == b; false if either is NaN"},
    {Op::NotEqual, "not_equal", TypeRule::Compare, 2, exact, "a != b; true if either is NaN"},
    {Op::And, "and", TypeRule::Logic, 2, exact, "Both; both operands are evaluated"},
    {Op::Or, "or", TypeRule::Logic, 2, exact, "Either; both operands are evaluated"},
    {Op::Not, "not", TypeRule::Logic, 1, exact, "Negation"},
    {Op::Select, "select", TypeRule::Select, 3, exact,
     "b where a holds, else c; the bits of the chosen operand, both operands are evaluated"},

    {Op::ToFloat, "to_float", TypeRule::ToFloat, 1, exact, "The nearest float of an int"},
    {Op::Compose, "compose", TypeRule::Compose, any_count, exact,
     "A vector from the components of its operands, in order"},
    {Op::Swizzle, "swizzle", TypeRule::Swizzle, 1, exact,
     "The named components of a, in order; of a scalar, .xx repeats it"},

    {Op::SampleLevel, "sample_level", TypeRule::Sample, 2, device,
     "Texture read at a coordinate and a mip level; filter precision is the device's (8 bits of "
     "weight are common)"},
    {Op::SampleGrad, "sample_grad", TypeRule::Sample, 3, device,
     "Texture read at a coordinate, level from two gradients (d/dx, d/dy)"},
    {Op::SampleImplicit, "sample", TypeRule::Sample, 1, device,
     "Texture read, level from the derivatives of the coordinate; outside loops and branches only"},
    {Op::Ddx, "ddx", TypeRule::SameFloat, 1, device,
     "Difference to the horizontal neighbour pixel; outside loops and branches only"},
    {Op::Ddy, "ddy", TypeRule::SameFloat, 1, device,
     "Difference to the vertical neighbour pixel; outside loops and branches only"},

    {Op::Loop, "loop", TypeRule::Loop, any_count, exact,
     "Runs its region trip-count times, or until a break_if; carries values from one iteration to "
     "the next"},
    {Op::If, "if", TypeRule::If, 1, exact, "Runs one of its two regions and gives what it yields"},
    {Op::BreakIf, "break_if", TypeRule::BreakIf, any_count, exact,
     "If its condition holds, leaves the enclosing loop; the loop's results are its further "
     "operands"},
    {Op::Yield, "yield", TypeRule::Terminator, any_count, exact,
     "Ends a region: next carried values of a loop, results of an if"},
    {Op::Return, "return", TypeRule::Terminator, any_count, exact,
     "Ends a module: one value for each output"},
});

constexpr bool rows_are_in_order() {
    for (std::size_t i = 0; i < table.size(); ++i)
        if (table[i].op != static_cast<Op>(i)) return false;
    return table.size() == static_cast<std::size_t>(Op::Return) + 1;
}
static_assert(rows_are_in_order(),
              "the ops table has one row for each op, in the order of the enumeration");

}  // namespace

const OpInfo& info(Op op) { return table[static_cast<std::size_t>(op)]; }

std::span<const OpInfo> all_ops() { return table; }

std::optional<Op> op_named(std::string_view name) {
    for (const OpInfo& row : table)
        if (row.name == name) return row.op;
    return std::nullopt;
}

}  // namespace intaglio::ir

// Intervals of binary32 values: for each op that works by component, bounds that hold whatever the
// operands are within theirs.  Ends come from the evaluator's own arithmetic, which rounds
// monotonically; an op whose result is the device's to round is widened by more than Vulkan allows
// it.  Zeros have signs: an interval that begins at +0 holds no -0.  Interval arithmetic: Moore,
// "Interval Analysis", 1966.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "generator/ir/module.h"

namespace intaglio::passes {

// What one component may be: a number from least to most, and NaN if `nan`.  No number at all where
// least > most.  Floats are held exactly; ints are whole, bools 0 and 1.
struct Range {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
    bool nan = false;

    static Range nothing() { return {}; }
    static Range everything(ir::Scalar scalar);
    // Ends that are denormal may have been flushed to zero.
    static Range between(double least, double most);
    // A constant's component.
    static Range of(std::uint32_t bits, ir::Scalar scalar);
    static Range truth(bool value) { return between(value, value); }

    bool empty() const { return least > most; }
    bool is_true() const { return least == 1 && !empty() && !nan; }
    bool is_false() const { return most == 0 && !empty() && !nan; }
    // The one number it may be; the sign of a zero included.
    std::optional<double> single() const;
    bool operator==(const Range&) const = default;
};

// x < y, where -0 < +0.
bool is_below(double x, double y);

// Either.
Range join(const Range& a, const Range& b);
// Both; NaN where both may be.
Range meet(const Range& a, const Range& b);

// Components of a value, nothing beyond its width.
using Ranges = std::array<Range, 4>;

namespace ranges {

Range add(const Range& a, const Range& b);
Range sub(const Range& a, const Range& b);
Range mul(const Range& a, const Range& b);
Range square(const Range& a);
Range div(const Range& a, const Range& b);
Range neg(const Range& a);
Range abs(const Range& a);
Range min(const Range& a, const Range& b);
Range max(const Range& a, const Range& b);
Range saturate(const Range& a);
Range floor(const Range& a);
Range frac(const Range& a);
Range sqrt(const Range& a);
Range rsqrt(const Range& a);
Range exp2(const Range& a);
Range log2(const Range& a);
Range pow(const Range& a, const Range& b);
Range turn(const Range& a);  // sin and cos
Range lerp(const Range& a, const Range& b, const Range& c);
// The sum of products in any order, fused or not.
Range sum_of_products(const Range* products, int count);
// less, less_equal, greater, greater_equal, equal, not_equal of floats or ints.
Range compare(ir::Op op, const Range& a, const Range& b);
// add, sub, mul, neg, abs, min, max of ints, which wrap.
Range whole(ir::Op op, const Range& a, const Range& b);

// By more than a device may be off: outwards by a share of the bound.
Range widened(Range a, double share);

}  // namespace ranges
}  // namespace intaglio::passes

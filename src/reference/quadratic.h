// The height of a bilinear patch along a straight line, less that of a ray, is a quadratic.  Inside
// the reference only.
#pragma once

namespace intaglio::reference {

// g(s) = from + (to - from) s - bend s (1 - s) for s in [0, 1]: the values at both ends, and the
// coefficient of s^2. Given so, neighbouring cells meet in the same value, and a change of sign
// cannot fall between them.
struct Quadratic {
    double from, to, bend;

    // The smallest s in [0, 1] with g(s) >= 0, a touch included; not in [0, 1] when there is none.
    // No cancellation in the root itself: |g(s)| is at most some 4e-16 times the largest
    // coefficient.  The discriminant of a near touch does cancel, so a summit within 1e-15 times
    // the largest coefficient of 0 may be judged either way.
    double first_nonnegative() const;

    // The largest value on [0, 1].
    double maximum() const;
    // The smallest value on [0, 1].
    double minimum() const { return -Quadratic{-from, -to, -bend}.maximum(); }
};

}  // namespace intaglio::reference

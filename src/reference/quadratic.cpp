// Roots by the form that adds numbers of one sign (Press et al., Numerical Recipes, 5.6), for the
// one root wanted: where the quadratic comes up from below zero.
#include "src/reference/quadratic.h"

#include <algorithm>
#include <cmath>

namespace intaglio::reference {

namespace {

constexpr double none = 2.0;

}  // namespace

double Quadratic::first_nonnegative() const {
    if (from >= 0) return 0;
    const double slope = to - from - bend;  // at s = 0; at s = 1 it is slope + 2 bend
    const bool summit_inside = bend < 0 && slope > 0 && slope + 2 * bend < 0;
    const bool ends_above = to >= 0;
    if (!ends_above && !summit_inside) return none;

    const double discriminant = slope * slope - 4 * bend * from;
    if (discriminant < 0 && !ends_above) return none;
    const double root = std::sqrt(std::max(discriminant, 0.0));
    // Below zero at s = 0, so the first root is a rising one: its slope is +root.  A falling start
    // (slope < 0) can only rise again when bend > 0; both denominators are then sums of terms of
    // one sign.
    const double s = slope >= 0 ? -2 * from / (slope + root) : (root - slope) / (2 * bend);
    return std::min(s, 1.0);
}

double Quadratic::maximum() const {
    const double ends = std::max(from, to);
    const double slope = to - from - bend;
    if (!(bend < 0 && slope > 0 && slope + 2 * bend < 0)) return ends;
    return std::max(ends, from - slope * slope / (4 * bend));
}

}  // namespace intaglio::reference

// Each op by its ends.  Where ends do not say it all (a zero inside a divisor, infinities that
// cancel), the result says NaN or everything.
#include "generator/passes/ranges.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "generator/ir/arithmetic.h"

namespace intaglio::passes {

namespace {

using F = ir::Arithmetic<float>;
constexpr double inf = std::numeric_limits<double>::infinity();
// Vulkan allows a division 2.5 ulp, an inverse root 2, a MojoShader program two roundings for one
// division; Direct3D 9 asks for 22 bits of reciprocals.
constexpr double device_share = 0x1p-20;
// exp2: 3 + 2 |x| ulp.  log2 near 1: 2^-21 absolute.
constexpr double power_share = 0x1p-14;

float narrow(double x) { return static_cast<float>(x); }

double least_of(double x, double y) { return is_below(y, x) ? y : x; }
double most_of(double x, double y) { return is_below(x, y) ? y : x; }

// What a denormal at an end may have become.  Products that round up to the least normal number
// are flushed by some.
Range flushed(Range a) {
    constexpr double smallest = std::numeric_limits<float>::min();
    if (a.least > 0 && a.least <= smallest) a.least = +0.0;
    if (a.most < 0 && a.most >= -smallest) a.most = -0.0;
    return a;
}

bool holds_zero(const Range& a) { return a.least <= 0 && a.most >= 0; }
bool holds_infinity(const Range& a) {
    return !a.empty() && (std::isinf(a.least) || std::isinf(a.most));
}

// The hull of f over all pairs of ends; NaN results count for nothing.
template <typename Function>
Range corners(const Range& a, const Range& b, Function f) {
    Range result;
    result.nan = a.nan || b.nan;
    if (a.empty() || b.empty()) return result;
    for (double x : {a.least, a.most})
        for (double y : {b.least, b.most}) {
            const double z = static_cast<double>(f(narrow(x), narrow(y)));
            if (z != z) {
                result.nan = true;
                continue;
            }
            result = join(result, Range::between(z, z));
        }
    // Every pair of ends is NaN; what lies between them need not be.
    if (result.empty() && !(a.single() && b.single())) return Range::everything(ir::Scalar::Float);
    return flushed(result);
}

template <typename Function>
Range ends(const Range& a, Function f) {
    if (a.empty()) return {inf, -inf, a.nan};
    return {static_cast<double>(f(narrow(a.least))), static_cast<double>(f(narrow(a.most))), a.nan};
}

double rounded_down(double x) {
    constexpr double greatest = std::numeric_limits<float>::max();
    if (x >= greatest) return x == inf ? inf : greatest;
    if (x < -greatest) return -inf;
    const float f = narrow(x);
    const double result = static_cast<double>(f);
    return result > x ? static_cast<double>(std::nextafter(f, -HUGE_VALF)) : result;
}

}  // namespace

bool is_below(double x, double y) {
    return x < y || (x == y && std::signbit(x) && !std::signbit(y));
}

Range Range::everything(ir::Scalar scalar) {
    switch (scalar) {
        case ir::Scalar::Bool: return between(0, 1);
        case ir::Scalar::Int: return between(-2147483648.0, 2147483647.0);
        case ir::Scalar::Float: break;
    }
    return {-inf, inf, true};
}

Range Range::between(double least, double most) { return flushed({least, most, false}); }

Range Range::of(std::uint32_t bits, ir::Scalar scalar) {
    if (scalar == ir::Scalar::Int) {
        const double value = static_cast<std::int32_t>(bits);
        return between(value, value);
    }
    if (scalar == ir::Scalar::Bool) return truth(bits != 0);
    const double value = static_cast<double>(std::bit_cast<float>(bits));
    if (value != value) return {inf, -inf, true};
    return between(value, value);
}

std::optional<double> Range::single() const {
    if (nan || empty() || least != most || std::signbit(least) != std::signbit(most)) return {};
    return least;
}

Range join(const Range& a, const Range& b) {
    Range result = a.empty() ? b : a;
    result.nan = a.nan || b.nan;
    if (a.empty() || b.empty()) return result;
    result.least = least_of(a.least, b.least);
    result.most = most_of(a.most, b.most);
    return result;
}

Range meet(const Range& a, const Range& b) {
    const Range result = {most_of(a.least, b.least), least_of(a.most, b.most), a.nan && b.nan};
    return is_below(result.most, result.least) ? Range{inf, -inf, result.nan} : result;
}

namespace ranges {

Range widened(Range a, double share) {
    if (a.empty()) return a;
    const auto lowered = [&](double x) {
        return x == 0 || std::isinf(x) ? x : rounded_down(x - std::fabs(x) * share);
    };
    return flushed({lowered(a.least), -lowered(-a.most), a.nan});
}

Range add(const Range& a, const Range& b) {
    Range result;
    result.nan = a.nan || b.nan;
    if (a.empty() || b.empty()) return result;
    const double least = static_cast<double>(F::add(narrow(a.least), narrow(b.least)));
    const double most = static_cast<double>(F::add(narrow(a.most), narrow(b.most)));
    result.nan |= (a.most == inf && b.least == -inf) || (a.least == -inf && b.most == inf);
    result.least = least != least ? -inf : least;
    result.most = most != most ? inf : most;
    return flushed(result);
}

Range sub(const Range& a, const Range& b) { return add(a, neg(b)); }

Range mul(const Range& a, const Range& b) {
    Range result = corners(a, b, F::mul);
    result.nan |= (holds_zero(a) && holds_infinity(b)) || (holds_infinity(a) && holds_zero(b));
    return result;
}

Range square(const Range& a) {
    const Range size = abs(a);
    return {corners(size, size, F::mul).least, corners(size, size, F::mul).most, a.nan};
}

Range div(const Range& a, const Range& b) {
    if (holds_zero(b)) return Range::everything(ir::Scalar::Float);
    Range result = corners(a, b, F::div);
    result.nan |= holds_infinity(a) && holds_infinity(b);
    return widened(result, device_share);
}

Range neg(const Range& a) { return {-a.most, -a.least, a.nan}; }

Range abs(const Range& a) {
    if (a.empty()) return a;
    const double x = std::fabs(a.least), y = std::fabs(a.most);
    return {holds_zero(a) ? 0.0 : std::min(x, y), std::max(x, y), a.nan};
}

// Of two zeros a device may give either.
Range max(const Range& a, const Range& b) {
    Range result = {std::max(a.least, b.least), std::max(a.most, b.most), a.nan && b.nan};
    if (result.least == 0)
        result.least = is_below(a.least, +0.0) || is_below(b.least, +0.0) ? -0.0 : +0.0;
    if (result.most == 0)
        result.most = is_below(a.most, +0.0) && is_below(b.most, +0.0) ? -0.0 : +0.0;
    if (a.empty() || b.empty()) result = {inf, -inf, a.nan && b.nan};
    // If one is NaN, the other.
    if (a.nan) result = join(result, {b.least, b.most, result.nan});
    if (b.nan) result = join(result, {a.least, a.most, result.nan});
    return result;
}

Range min(const Range& a, const Range& b) { return neg(max(neg(a), neg(b))); }

Range saturate(const Range& a) {
    Range result = min(max(a, Range::between(+0.0, +0.0)), Range::between(1, 1));
    if (a.nan) result = join(result, Range::between(+0.0, +0.0));
    result.nan = false;
    return result;
}

Range floor(const Range& a) {
    return ends(a, [](float x) { return std::floor(x); });
}

// a - floor(a) may round to 1.
Range frac(const Range& a) {
    if (a.empty()) return a;
    return {+0.0, 1, a.nan || holds_infinity(a)};
}

Range sqrt(const Range& a) {
    Range result = ends({a.least < 0 ? -0.0 : a.least, a.most < 0 ? -0.0 : a.most, a.nan}, F::sqrt);
    if (a.empty()) return {inf, -inf, a.nan};
    result.nan |= a.least < 0;
    // What is zero, or is flushed to it, has a root of either sign, by compiler.
    if (result.most == 0) result.most = 0.0;
    if (result.least == 0) result.least = -0.0;
    return widened(result, device_share);
}

Range rsqrt(const Range& a) {
    if (a.least <= 0) return Range::everything(ir::Scalar::Float);
    if (a.empty()) return a;
    const Range result = ends(a, F::rsqrt);
    return widened({result.most, result.least, a.nan}, device_share);
}

Range exp2(const Range& a) { return widened(ends(a, F::exp2), power_share); }

Range log2(const Range& a) {
    if (a.least <= 0) return Range::everything(ir::Scalar::Float);
    if (a.empty()) return a;
    return widened(add(ends(a, F::log2), Range::between(-power_share, power_share)), power_share);
}

Range pow(const Range& a, const Range& b) {
    if (a.least <= 0) return Range::everything(ir::Scalar::Float);
    return exp2(mul(b, log2(a)));
}

Range turn(const Range& a) {
    if (a.empty()) return a;
    if (a.nan || a.least < -3.1416 || a.most > 3.1416) return Range::everything(ir::Scalar::Float);
    return Range::between(-1 - 0x1p-10, 1 + 0x1p-10);
}

Range lerp(const Range& a, const Range& b, const Range& c) {
    const Range rest = sub(Range::between(1, 1), c);
    const Range weighed = add(mul(a, rest), mul(b, c)), walked = add(a, mul(sub(b, a), c));
    const Range loose = widened(join(weighed, walked), device_share);
    // In real numbers it is linear in each operand, so that its extremes lie at their ends; the
    // roundings of either form come to less than a share of the greatest term.
    const double farthest = std::max(std::fabs(c.least), std::fabs(c.most));
    if (loose.nan || loose.empty() || farthest > 2) return loose;
    Range ends;
    double size = 0;
    for (double x : {a.least, a.most})
        for (double y : {b.least, b.most})
            for (double z : {c.least, c.most}) {
                const double exact = x * (1 - z) + y * z;
                ends = join(ends, Range::between(exact, exact));
                size = std::max({size, std::fabs(x), std::fabs(y)});
            }
    size *= 4 * device_share;
    Range result =
        Range::between(rounded_down(ends.least - size), -rounded_down(-ends.most - size));
    // Within [0, 1] neither form goes below what both a and b are not below.
    if (!is_below(a.least, +0.0) && !is_below(b.least, +0.0) && c.least >= 0 && c.most <= 1)
        result.least = is_below(result.least, +0.0) ? +0.0 : result.least;
    if (result.most == 0) result.most = +0.0;
    if (result.least == 0 && std::signbit(c.least)) result.least = -0.0;
    return meet(result, loose);
}

Range sum_of_products(const Range* products, int count) {
    Range sum = products[0];
    double size = std::max(std::fabs(sum.least), std::fabs(sum.most));
    bool positive = !is_below(sum.least, +0.0);
    for (int i = 1; i < count; ++i) {
        sum = add(sum, products[i]);
        size += std::max(std::fabs(products[i].least), std::fabs(products[i].most));
        positive &= !is_below(products[i].least, +0.0);
    }
    if (sum.empty() || holds_infinity(sum) || positive) return widened(sum, device_share);
    size *= device_share;
    return flushed({rounded_down(sum.least - size), -rounded_down(-sum.most - size), sum.nan});
}

Range compare(ir::Op op, const Range& a, const Range& b) {
    using ir::Op;
    const Range either = Range::between(0, 1);
    if (op == Op::Greater) return compare(Op::Less, b, a);
    if (op == Op::GreaterEqual) return compare(Op::LessEqual, b, a);
    if (op == Op::NotEqual) {
        const Range equal = compare(Op::Equal, a, b);
        return Range::between(1 - equal.most, 1 - equal.least);
    }
    const bool nan = a.nan || b.nan, numbers = !a.empty() && !b.empty();
    bool always = false, never = !numbers;
    if (op == Op::Less) {
        always = a.most < b.least;
        never |= a.least >= b.most;
    } else if (op == Op::LessEqual) {
        always = a.most <= b.least;
        never |= a.least > b.most;
    } else {
        always = a.least == a.most && b.least == b.most && a.least == b.least;
        never |= a.most < b.least || b.most < a.least;
    }
    if (never) return Range::truth(false);
    return always && !nan ? Range::truth(true) : either;
}

Range whole(ir::Op op, const Range& a, const Range& b) {
    using ir::Op;
    Range result;
    const auto add_pairs = [&](auto f) {
        for (double x : {a.least, a.most})
            for (double y : {b.least, b.most}) {
                const double z = f(x, y);
                result = join(result, Range::between(z, z));
            }
    };
    if (a.empty() || (b.empty() && op != Op::Neg && op != Op::Abs)) return result;
    switch (op) {
        case Op::Add: result = Range::between(a.least + b.least, a.most + b.most); break;
        case Op::Sub: result = Range::between(a.least - b.most, a.most - b.least); break;
        case Op::Mul: add_pairs([](double x, double y) { return x * y; }); break;
        case Op::Min: add_pairs([](double x, double y) { return std::min(x, y); }); break;
        case Op::Max: add_pairs([](double x, double y) { return std::max(x, y); }); break;
        case Op::Neg: result = Range::between(0 - a.most, 0 - a.least); break;
        case Op::Abs: result = abs(a); break;
        default: return Range::everything(ir::Scalar::Int);
    }
    const Range all = Range::everything(ir::Scalar::Int);
    if (result.least < all.least || result.most > all.most) return all;
    // No zero of an int has a sign.
    return Range::between(result.least + 0.0, result.most + 0.0);
}

}  // namespace ranges
}  // namespace intaglio::passes

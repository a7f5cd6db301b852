// The arithmetic of the IR on scalars, in binary32 or binary64: the one place where the semantics
// of the ops table are carried out.  Private to the evaluator.
//
// Single does what lavapipe was measured to do: denormal operands and results of float ops count as
// zeros of their sign (DAZ and FTZ), except where an op only moves or masks bits (neg, abs, select,
// compose, swizzle).  Double keeps denormals.  Every NaN that an op computes is the canonical quiet
// NaN, so that results do not depend on the order in which a compiler hands operands to the
// processor.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace intaglio::ir {

// Storage of one component: the bits of a float, an int, or 0 / 1, whatever its type.
template <typename T>
using Cell = std::conditional_t<std::is_same_v<T, float>, std::uint32_t, std::uint64_t>;

template <typename T>
struct Arithmetic {
    using Number = T;
    static constexpr bool flushes = std::is_same_v<T, float>;
    static constexpr T smallest = std::numeric_limits<T>::min();

    // A constant, an input or a texel as an instruction finds it.
    static T load(double value) { return static_cast<T>(value); }
    // A denormal counts as zero.
    static T in(T value) {
        if constexpr (flushes)
            return std::fabs(value) < smallest ? std::copysign(T(0), value) : value;
        return value;
    }
    static T out(T value) {
        if (value != value) return std::numeric_limits<T>::quiet_NaN();
        return in(value);
    }

    static T add(T a, T b) { return out(in(a) + in(b)); }
    static T sub(T a, T b) { return out(in(a)-in(b)); }
    static T mul(T a, T b) {
        const T x = in(a), y = in(b), product = x * y;
        return out(rounded_up_to_normal(product, [&] { return double(x) * double(y); })
                       ? underflow(product)
                       : product);
    }
    static T div(T a, T b) {
        const T x = in(a), y = in(b), quotient = x / y;
        return out(rounded_up_to_normal(quotient, [&] { return double(x) / double(y); })
                       ? underflow(quotient)
                       : quotient);
    }
    static T neg(T a) { return std::bit_cast<T>(std::bit_cast<Cell<T>>(a) ^ sign_bit); }
    static T abs(T a) { return std::bit_cast<T>(std::bit_cast<Cell<T>>(a) & ~sign_bit); }
    static T min(T a, T b) { return choose(in(a), in(b), in(a) < in(b)); }
    static T max(T a, T b) { return choose(in(a), in(b), in(a) > in(b)); }
    static T saturate(T a) { return min(max(a, T(0)), T(1)); }
    static T floor(T a) { return out(std::floor(in(a))); }
    static T frac(T a) { return sub(a, floor(a)); }
    static T sqrt(T a) { return out(std::sqrt(in(a))); }
    static T rsqrt(T a) { return div(T(1), sqrt(a)); }
    static T exp2(T a) { return out(std::exp2(in(a))); }
    static T log2(T a) { return out(std::log2(in(a))); }
    static T pow(T a, T b) { return exp2(mul(b, log2(a))); }
    static T sin(T a) { return out(std::sin(in(a))); }
    static T cos(T a) { return out(std::cos(in(a))); }
    static T lerp(T a, T b, T c) { return add(mul(a, sub(T(1), c)), mul(b, c)); }

  private:
    static constexpr Cell<T> sign_bit = Cell<T>(1) << (sizeof(T) * 8 - 1);

    // The one that is not NaN; of two numbers, the first if it is preferred.
    static T choose(T a, T b, bool prefer_first) {
        if (a != a) return out(b);
        return b != b || prefer_first ? a : b;
    }

    // A processor that flushes decides after rounding as if the exponent had no lower end, so that
    // a value just below the smallest normal number is flushed although gradual underflow would
    // round it up to that number. The double is exact for products, and exact enough for quotients:
    // floats of 24 bits cannot come closer to the limit, which has 25, than 2^-49 of it without
    // meeting it.
    template <typename Exact>
    static bool rounded_up_to_normal(T result, Exact exact) {
        if constexpr (!flushes) return false;
        constexpr double limit = double(smallest) * (1.0 - 0x1p-25);
        return std::fabs(result) == smallest && std::fabs(exact()) < limit;
    }
    static T underflow(T result) { return std::copysign(T(0), result); }
};

// Ints wrap.
struct IntArithmetic {
    static std::int32_t add(std::int32_t a, std::int32_t b) { return wrap(bits(a) + bits(b)); }
    static std::int32_t sub(std::int32_t a, std::int32_t b) { return wrap(bits(a) - bits(b)); }
    static std::int32_t mul(std::int32_t a, std::int32_t b) { return wrap(bits(a) * bits(b)); }
    static std::int32_t neg(std::int32_t a) { return wrap(0u - bits(a)); }
    static std::int32_t abs(std::int32_t a) { return a < 0 ? neg(a) : a; }
    static std::int32_t min(std::int32_t a, std::int32_t b) { return a < b ? a : b; }
    static std::int32_t max(std::int32_t a, std::int32_t b) { return a > b ? a : b; }

  private:
    static std::uint32_t bits(std::int32_t a) { return static_cast<std::uint32_t>(a); }
    static std::int32_t wrap(std::uint32_t a) { return static_cast<std::int32_t>(a); }
};

}  // namespace intaglio::ir

// The arithmetic that pixel shader hardware of the Direct3D 9 years had, on scalars held in
// binary32.
//   Format24  R300's s16e7 (bias 63, no denormals), results truncated: measured on R300 as errors
//             in [-1, 0] ulp of sums (Hillesland, Lastra: "GPU Floating-Point Paranoia", GP2 2004).
//   Format16  NV30's s10e5 with denormals, rounded to nearest even.
// Edge values follow the text of the Direct3D 9 reference: rcp(0) = rsq(0) = the largest finite
// number, log(0) = its negative, log and pow of a negative number take its absolute value.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "generator/ir/arithmetic.h"

namespace intaglio::ir {

// What all share: comparisons, clamping and the guards of the reference, on top of Base's
// roundings.
template <typename Base>
struct Guarded : Base {
    static float sub(float a, float b) { return Base::add(a, -b); }
    static float rcp(float a) { return a == 0 ? Base::largest : Base::div(1.0f, a); }
    static float rsq(float a) { return a == 0 ? Base::largest : Base::inverse_root(std::fabs(a)); }
    static float log2(float a) { return a == 0 ? -Base::largest : Base::logarithm(std::fabs(a)); }
    static float pow(float a, float b) { return Base::exp2(Base::mul(b, log2(a))); }
    static float frac(float a) { return sub(a, std::floor(a)); }
    // The one that is not NaN, as IEEE 754's minNum; the first of two zeros.
    static float min(float a, float b) { return Arithmetic<float>::min(a, b); }
    static float max(float a, float b) { return Arithmetic<float>::max(a, b); }
    static float saturate(float a) { return min(max(a, 0.0f), 1.0f); }
};

// A format narrower than binary32: each operation in binary64, then rounded once by Format.
template <typename Format>
struct NarrowRounding {
    static constexpr float largest = Format::largest;
    static float load(float value) { return Format::round(static_cast<double>(value)); }
    static float add(float a, float b) {
        const double x = a, y = b, sum = x + y;
        if (!std::isfinite(sum)) return Format::round(sum);
        // The sum of two numbers far apart is not exact in binary64 (Knuth's two-sum tells by how
        // much); truncation must not see it rounded away from zero.
        const double part = sum - x, error = (x - (sum - part)) + (y - part);
        const bool grew = error != 0 && (error < 0) != (sum < 0);
        return Format::round(sum, grew);
    }
    static float mul(float a, float b) {
        return Format::round(static_cast<double>(a) * static_cast<double>(b));
    }
    static float div(float a, float b) {
        return Format::round(static_cast<double>(a) / static_cast<double>(b));
    }
    static float inverse_root(float a) {
        return Format::round(1.0 / std::sqrt(static_cast<double>(a)));
    }
    static float exp2(float a) { return Format::round(std::exp2(static_cast<double>(a))); }
    static float logarithm(float a) { return Format::round(std::log2(static_cast<double>(a))); }
    static float sin(float a) { return Format::round(std::sin(static_cast<double>(a))); }
    static float cos(float a) { return Format::round(std::cos(static_cast<double>(a))); }
};

// 1 sign, 7 exponent (bias 63, the greatest for infinity and NaN), 16 fraction bits; towards zero.
struct Format24 {
    static constexpr float largest = 0x1.FFFFp63f;
    // `grew`: the exact value lies nearer to zero than `value`, by less than its last bit.
    static float round(double value, bool grew = false) {
        if (value != value) return std::numeric_limits<float>::quiet_NaN();
        if (grew) value = std::nextafter(value, 0.0);
        if (std::fabs(value) < 0x1p-62) return static_cast<float>(std::copysign(0.0, value));
        if (std::fabs(value) >= 0x1p64)
            return static_cast<float>(
                std::copysign(std::numeric_limits<double>::infinity(), value));
        constexpr std::uint64_t dropped = (std::uint64_t{1} << (52 - 16)) - 1;
        return static_cast<float>(
            std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) & ~dropped));
    }
};

// IEEE 754's binary16.
struct Format16 {
    static constexpr float largest = 65504.0f;
    // Sums and products of halves are exact in binary64, so `grew` never holds.
    static float round(double value, bool = false) {
        if (value != value) return std::numeric_limits<float>::quiet_NaN();
        if (!std::isfinite(value)) return static_cast<float>(value);
        int exponent = 0;
        std::frexp(value, &exponent);
        const int unit = std::max(exponent - 11, -24);  // exponent of the last place
        const double rounded = std::ldexp(std::nearbyint(std::ldexp(value, -unit)), unit);
        if (std::fabs(rounded) > static_cast<double>(largest))
            return static_cast<float>(
                std::copysign(std::numeric_limits<double>::infinity(), value));
        return static_cast<float>(rounded);
    }
};

// The IR's ops on scalars of a format: what Arithmetic is for binary32 and binary64.
template <typename Format>
struct Narrow : Guarded<NarrowRounding<Format>> {
    using Base = NarrowRounding<Format>;
    using Number = float;
    static float load(double value) { return Format::round(value); }
    static float in(float value) { return value; }
    static float div(float a, float b) { return Base::mul(a, Guarded<Base>::rcp(b)); }
    static float neg(float a) { return Arithmetic<float>::neg(a); }
    static float abs(float a) { return Arithmetic<float>::abs(a); }
    static float floor(float a) { return std::floor(a); }
    static float sqrt(float a) {
        return a == 0 ? a : Base::mul(a, Base::inverse_root(std::fabs(a)));
    }
    static float rsqrt(float a) { return Guarded<Base>::rsq(a); }
    static float lerp(float a, float b, float c) {
        return Base::add(Base::mul(a, Guarded<Base>::sub(1.0f, c)), Base::mul(b, c));
    }
};

}  // namespace intaglio::ir

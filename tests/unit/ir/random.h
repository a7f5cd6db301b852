// A seeded source of random numbers that gives the same sequence with every compiler and standard
// library (the distributions of <random> do not), with a taste for the floats on which arithmetic
// goes wrong.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>

namespace intaglio::ir::testing {

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    std::uint64_t bits() { return engine_(); }
    // Uniform in [0, count), count at least 1.
    int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
    // Uniform in [low, high].
    int between(int low, int high) { return low + below(high - low + 1); }
    bool chance(int percent) { return below(100) < percent; }
    // Uniform in [0, 1), a multiple of 2^-24.
    float unit() { return static_cast<float>(engine_() >> 40) * 0x1p-24f; }

    // Zeros, ones, infinities, NaN, the ends of the normal and denormal ranges, and neighbours of
    // round numbers.
    float special() {
        using Limits = std::numeric_limits<float>;
        constexpr float table[] = {0.0f,
                                   -0.0f,
                                   1.0f,
                                   -1.0f,
                                   0.5f,
                                   2.0f,
                                   -3.0f,
                                   0.1f,
                                   255.0f,
                                   16777216.0f,
                                   0x1.fffffep-1f,
                                   0x1.000002p0f,
                                   1e-10f,
                                   1e10f,
                                   Limits::min(),
                                   -Limits::min(),
                                   Limits::denorm_min(),
                                   1e-40f,
                                   Limits::max(),
                                   Limits::lowest(),
                                   Limits::infinity(),
                                   -Limits::infinity(),
                                   Limits::quiet_NaN()};
        return table[below(static_cast<int>(std::size(table)))];
    }

    // One of the special values, any bits, or (mostly) something between -4 and 4.
    float any_float() {
        const int kind = below(10);
        if (kind < 2) return special();
        if (kind < 3) return std::bit_cast<float>(static_cast<std::uint32_t>(engine_()));
        return unit() * 8.0f - 4.0f;
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace intaglio::ir::testing

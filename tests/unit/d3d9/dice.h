// Seeded draws for random shaders: the same on every standard library, which
// std::uniform_int_distribution is not.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>

namespace intaglio::d3d9 {

class Dice {
  public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}

    std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
    // 0 to `most`, both included.
    int up_to(int most) { return static_cast<int>(bits() % static_cast<std::uint32_t>(most + 1)); }
    bool one_in(int count) { return up_to(count - 1) == 0; }

    template <typename T>
    T pick(std::initializer_list<T> choices) {
        return choices.begin()[up_to(static_cast<int>(choices.size()) - 1)];
    }

    // Any float but NaN and the infinities; often an awkward one.
    std::uint32_t float_bits() {
        if (one_in(3))
            return pick<std::uint32_t>({0x00000000u, 0x80000000u, 0x3F800000u, 0xBF000000u,
                                        0x00000001u, 0x807FFFFFu, 0x00800000u, 0x7F7FFFFFu,
                                        0x4B800001u, 0x4F000000u, 0x4E6E6B28u, 0xCF000000u,
                                        0x5F000000u, 0x3DCCCCCDu, 0x006CE3EEu});
        for (;;)
            if (const std::uint32_t drawn = bits(); (drawn & 0x7F800000u) != 0x7F800000u)
                return drawn;
    }

  private:
    std::mt19937 engine_;
};

}  // namespace intaglio::d3d9

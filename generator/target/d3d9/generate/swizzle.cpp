// The swizzles of each profile.
#include "generator/target/d3d9/generate/code.h"

namespace intaglio::d3d9 {

namespace {
constexpr Swizzle limited_swizzles[] = {{0, 1, 2, 3}, {0, 0, 0, 0}, {1, 1, 1, 1}, {2, 2, 2, 2},
                                        {3, 3, 3, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 2, 1, 0}};
}

std::optional<Swizzle> find_swizzle(const std::array<int, 4>& lanes, const Limits& limits) {
    for (const Swizzle& candidate : limited_swizzles) {
        bool fits = true;
        for (std::size_t k = 0; k < 4; ++k)
            fits = fits && (lanes[k] < 0 || lanes[k] == candidate[k]);
        if (fits) return candidate;
    }
    if (!limits.arbitrary_swizzle) return std::nullopt;
    Swizzle result{};
    int last = 0;
    for (std::size_t k = 0; k < 4; ++k)
        if (lanes[k] >= 0) {
            last = lanes[k];
            break;
        }
    for (std::size_t k = 0; k < 4; ++k) {
        if (lanes[k] >= 0) last = lanes[k];
        result[k] = static_cast<std::uint8_t>(last);
    }
    return result;
}

}  // namespace intaglio::d3d9

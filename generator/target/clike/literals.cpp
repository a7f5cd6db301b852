// Shortest round-trip decimals come from fmt; the rest is making sure that they stay floats in the
// emitted language.
#include "generator/target/clike/literals.h"

#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace intaglio::clike {

Result<std::string> float_literal(std::uint32_t bits, const Spelling& spelling) {
    const float value = std::bit_cast<float>(bits);
    if (!std::isfinite(value)) {
        if (spelling.float_from_bits.empty())
            return input_error("target-limit",
                               fmt::format("this language has no way to write the constant {}",
                                           std::isnan(value) ? "NaN" : "infinity"));
        std::string text(spelling.float_from_bits);
        text.replace(text.find("%0"), 2, fmt::format("0x{:08x}u", bits));
        return text;
    }
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

std::string int_literal(std::uint32_t bits) {
    const auto value = static_cast<std::int32_t>(bits);
    if (value == std::numeric_limits<std::int32_t>::min()) return "(-2147483647 - 1)";
    return fmt::format("{}", value);
}

}  // namespace intaglio::clike

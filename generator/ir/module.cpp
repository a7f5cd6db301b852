// Small helpers of the module.
#include "generator/ir/module.h"

#include <bit>

#include <fmt/format.h>

namespace intaglio::ir {

std::string to_string(Type type) {
    constexpr std::string_view names[] = {"bool", "int", "float"};
    return fmt::format("{}{}", names[static_cast<int>(type.scalar)], type.width);
}

float constant_float(const Instruction& constant, int component) {
    return std::bit_cast<float>(constant.bits[static_cast<std::size_t>(component)]);
}

std::uint32_t float_bits(float value) { return std::bit_cast<std::uint32_t>(value); }

}  // namespace intaglio::ir

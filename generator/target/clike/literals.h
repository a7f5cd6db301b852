// Constants as text that reads back to the same bits.
#pragma once

#include <cstdint>
#include <string>

#include "generator/base/result.h"
#include "generator/target/clike/spelling.h"

namespace intaglio::clike {

// The shortest decimal that reads back to the same float, always with a point or an exponent:
// "0.125", "1.0", "1e-30". Infinities and NaN become a cast from bits; error "target-limit" where
// the language has none.
Result<std::string> float_literal(std::uint32_t bits, const Spelling& spelling);

// "42", "-1"; the smallest int is written as a difference, since its digits alone overflow.
std::string int_literal(std::uint32_t bits);

}  // namespace intaglio::clike

// What differs between the C-like languages, as data: one row for each op, and the few words of
// statements. The shared printer reads these and has no flags: a difference is a spelling here or a
// pass before.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "generator/ir/ops.h"

namespace intaglio::clike {

// How tightly an expression binds, loosest first.  An operand that binds looser than its place gets
// parentheses.
enum class Binds : std::uint8_t {
    Ternary,
    LogicalOr,
    LogicalAnd,
    Equality,
    Relation,
    Sum,
    Product,
    Prefix,
    Postfix
};

// In `text`, %0 to %3 are the operands, %t the name of the result type, %s the sampler.  Text that
// ends in ")" is a call, whose operands need no parentheses; otherwise the row's own strength says
// what they need.
struct OpSpelling {
    ir::Op op;
    std::string_view text;
    Binds binds = Binds::Postfix;
    std::string_view scalars =
        {};             // digits: operands that may stay scalar where the others are vectors
    int dimension = 0;  // texture reads: only for samplers of this dimension; 0: any
};

struct Spelling {
    std::span<const OpSpelling> ops;
    std::array<std::array<std::string_view, 4>, 3> types;  // by ir::Scalar, then width - 1
    OpSpelling splat;                                      // a vector of one repeated scalar
    std::string_view float_from_bits;  // of an infinity or NaN: %0 the bits; empty: cannot be said
    std::string_view
        rolled_loop;           // stands before a loop that the schedule keeps rolled; may be empty
    std::string_view precise;  // "precise ", or empty
    std::string_view next_index = "++%0";  // what a loop does to its index, %0
};

// The rows of two tables.
template <std::size_t n, std::size_t m>
constexpr std::array<OpSpelling, n + m> join(const std::array<OpSpelling, n>& a,
                                             const std::array<OpSpelling, m>& b) {
    std::array<OpSpelling, n + m> both{};
    for (std::size_t i = 0; i < n; ++i) both[i] = a[i];
    for (std::size_t i = 0; i < m; ++i) both[n + i] = b[i];
    return both;
}

// The name of a type.
inline std::string_view type_name(const Spelling& spelling, int scalar, int width) {
    return spelling.types[static_cast<std::size_t>(scalar)][static_cast<std::size_t>(width - 1)];
}

}  // namespace intaglio::clike

// Algebra as a table: each row is an identity that holds to the bit for every input, and a test
// evaluates both sides of each row on special values and random floats.
//
// Bit-exact means: NaN equals any NaN, and denormals are out of the comparison.  A device may flush
// a denormal to zero wherever it computes and need not where it only moves bits, so that already
// `a` and `a * 1` may differ there.
#pragma once

#include <span>
#include <string_view>

#include "generator/ir/module.h"
#include "generator/passes/rewrite.h"

namespace intaglio::passes {

// What a and b range over; components of vectors alike.
enum class Domain : std::uint8_t { Float, Int, Bool, Numeric, Any };

// `a` and `b` are of one type, `c` and `d` are bool1.  A number or truth value stands for a
// constant with that value in every component; 0 is +0.  The right side is a variable, a constant,
// or one op over variables.
struct RewriteRule {
    std::string_view left;
    std::string_view right;
    Domain domain;
};

std::span<const RewriteRule> rewrite_rules();

// A side of a rule as a tree.
struct Pattern {
    enum class Kind : std::uint8_t { Variable, Constant, Operation };
    Kind kind = Kind::Variable;
    char variable = 0;   // 'a' to 'd'
    float constant = 0;  // truth values: 0 and 1
    ir::Op op = ir::Op::Return;
    std::vector<Pattern> operands;
};

// The tree of one side; asserts on text that is none.
Pattern parse_pattern(std::string_view text);

// The bits of a pattern's constant as a component of this kind.
std::uint32_t constant_bits(float constant, ir::Scalar scalar);

}  // namespace intaglio::passes

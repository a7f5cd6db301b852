// The table, and the reading of its rows.
#include "generator/passes/rewrite_rules.h"

#include <cassert>
#include <charconv>

namespace intaglio::passes {
namespace {

using enum Domain;

// Not here, because they are wrong: a + 0 (a = -0), a - a (inf, NaN), a * 0 (inf, NaN, -1), -(a -
// b) = b - a (a = b), not (a < b) = a >= b (NaN), min and max in another order (signs of zeros).
constexpr RewriteRule rules[] = {
    {"add(a, -0)", "a", Float},
    {"add(-0, a)", "a", Float},
    {"add(a, 0)", "a", Int},
    {"add(0, a)", "a", Int},
    {"add(a, neg(b))", "sub(a, b)", Numeric},
    {"add(neg(a), b)", "sub(b, a)", Numeric},
    {"sub(a, 0)", "a", Numeric},
    {"sub(-0, a)", "neg(a)", Float},
    {"sub(0, a)", "neg(a)", Int},
    {"sub(a, neg(b))", "add(a, b)", Numeric},
    {"sub(a, a)", "0", Int},
    {"mul(a, 1)", "a", Numeric},
    {"mul(1, a)", "a", Numeric},
    {"mul(a, -1)", "neg(a)", Numeric},
    {"mul(-1, a)", "neg(a)", Numeric},
    {"mul(a, 0)", "0", Int},
    {"mul(0, a)", "0", Int},
    {"mul(neg(a), neg(b))", "mul(a, b)", Numeric},
    {"div(a, 1)", "a", Float},
    {"div(a, -1)", "neg(a)", Float},
    {"neg(neg(a))", "a", Numeric},
    {"neg(sub(a, b))", "sub(b, a)", Int},
    {"abs(neg(a))", "abs(a)", Numeric},
    {"abs(abs(a))", "abs(a)", Numeric},
    {"min(a, a)", "a", Numeric},
    {"max(a, a)", "a", Numeric},
    {"saturate(saturate(a))", "saturate(a)", Float},
    {"floor(floor(a))", "floor(a)", Float},

    {"less(a, a)", "false", Numeric},
    {"greater(a, a)", "false", Numeric},
    {"less_equal(a, a)", "true", Int},
    {"greater_equal(a, a)", "true", Int},
    {"equal(a, a)", "true", Int},
    {"not_equal(a, a)", "false", Int},
    {"not(equal(a, b))", "not_equal(a, b)", Numeric},
    {"not(not_equal(a, b))", "equal(a, b)", Numeric},
    {"not(less(a, b))", "greater_equal(a, b)", Int},
    {"not(less_equal(a, b))", "greater(a, b)", Int},
    {"not(greater(a, b))", "less_equal(a, b)", Int},
    {"not(greater_equal(a, b))", "less(a, b)", Int},

    {"and(c, true)", "c", Any},
    {"and(true, c)", "c", Any},
    {"and(c, false)", "false", Any},
    {"and(false, c)", "false", Any},
    {"and(c, c)", "c", Any},
    {"or(c, false)", "c", Any},
    {"or(false, c)", "c", Any},
    {"or(c, true)", "true", Any},
    {"or(true, c)", "true", Any},
    {"or(c, c)", "c", Any},
    {"not(not(c))", "c", Any},

    {"select(true, a, b)", "a", Any},
    {"select(false, a, b)", "b", Any},
    {"select(c, a, a)", "a", Any},
    {"select(not(c), a, b)", "select(c, b, a)", Any},
    {"select(c, true, false)", "c", Bool},
    {"select(c, false, true)", "not(c)", Bool},
    {"select(c, true, d)", "or(c, d)", Bool},
    {"select(c, d, false)", "and(c, d)", Bool},
};

class PatternReader {
  public:
    explicit PatternReader(std::string_view text) : text_(text) {}

    Pattern read() {
        const std::size_t start = position_;
        while (position_ < text_.size() && text_[position_] != '(' && text_[position_] != ',' &&
               text_[position_] != ')')
            ++position_;
        const std::string_view word = text_.substr(start, position_ - start);
        if (position_ < text_.size() && text_[position_] == '(') return operation(word);
        return leaf(word);
    }

  private:
    Pattern operation(std::string_view word) {
        const auto op = ir::op_named(word);
        assert(op.has_value());
        Pattern pattern;
        pattern.kind = Pattern::Kind::Operation;
        pattern.op = *op;
        do {
            ++position_;  // "(" or ","
            while (text_[position_] == ' ') ++position_;
            pattern.operands.push_back(read());
        } while (text_[position_] == ',');
        ++position_;  // ")"
        return pattern;
    }

    static Pattern leaf(std::string_view word) {
        Pattern pattern;
        if (word.size() == 1 && word[0] >= 'a' && word[0] <= 'd') {
            pattern.variable = word[0];
            return pattern;
        }
        pattern.kind = Pattern::Kind::Constant;
        if (word == "true" || word == "false") {
            pattern.constant = word == "true" ? 1.0f : 0.0f;
            return pattern;
        }
        const auto [end, error] =
            std::from_chars(word.data(), word.data() + word.size(), pattern.constant);
        assert(error == std::errc{} && end == word.data() + word.size());
        (void)end, (void)error;
        return pattern;
    }

    std::string_view text_;
    std::size_t position_ = 0;
};

}  // namespace

std::span<const RewriteRule> rewrite_rules() { return rules; }

Pattern parse_pattern(std::string_view text) { return PatternReader(text).read(); }

std::uint32_t constant_bits(float constant, ir::Scalar scalar) {
    return scalar == ir::Scalar::Float
               ? ir::float_bits(constant)
               : static_cast<std::uint32_t>(static_cast<std::int32_t>(constant));
}

}  // namespace intaglio::passes

// Every row of the rewrite table, both sides evaluated on special values and random ones; and proof
// that the check would catch a row that is wrong.
#include <gtest/gtest.h>

#include <limits>

#include "generator/ir/builder.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/fold_constants.h"
#include "generator/passes/remove_dead_code.h"
#include "generator/passes/rewrite_rules.h"
#include "tests/rounds.h"
#include "tests/unit/passes/environment.h"

namespace intaglio::passes {
namespace {

using namespace testing;
using namespace ir;

// A function of (a, b, c, d) that returns one side of a rule, with a and b of the given type.
class Side {
  public:
    Side(std::string_view text, Type type, Type result) : type_(type), builder_(module_) {
        module_.stage = Stage::Function;
        for (const char* name : {"a", "b"})
            module_.inputs.push_back({name, type, Semantic::Parameter});
        for (const char* name : {"c", "d"})
            module_.inputs.push_back({name, bool1, Semantic::Parameter});
        module_.outputs.push_back({"result", result, Semantic::Result});
        for (int slot = 0; slot < 4; ++slot) inputs_.push_back(builder_.input(slot));
        const ValueId value = build(parse_pattern(text), result);
        builder_.finish({&value, 1});
    }

    const Module& module() const { return module_; }

  private:
    ValueId build(const Pattern& pattern, Type expected) {
        if (pattern.kind == Pattern::Kind::Variable)
            return inputs_[static_cast<std::size_t>(pattern.variable - 'a')];
        if (pattern.kind == Pattern::Kind::Constant) {
            std::array<std::uint32_t, 4> bits{};
            std::fill_n(bits.begin(), expected.width,
                        constant_bits(pattern.constant, expected.scalar));
            return builder_.constant(expected, bits);
        }
        std::vector<ValueId> operands;
        for (std::size_t i = 0; i < pattern.operands.size(); ++i)
            operands.push_back(build(pattern.operands[i], operand_type(pattern.op, i, expected)));
        return builder_.emit(pattern.op, operands);
    }

    Type operand_type(Op op, std::size_t i, Type expected) const {
        switch (info(op).type_rule) {
            case TypeRule::Compare: return type_;
            case TypeRule::Logic: return bool1;
            case TypeRule::Select: return i == 0 ? bool1 : expected;
            default: return expected;
        }
    }

    Type type_;
    Module module_;
    Builder builder_;
    std::vector<ValueId> inputs_;
};

bool compares(const Pattern& pattern) {
    if (pattern.kind == Pattern::Kind::Operation && info(pattern.op).type_rule == TypeRule::Compare)
        return true;
    return std::any_of(pattern.operands.begin(), pattern.operands.end(), compares);
}

std::vector<Type> types_of(const RewriteRule& rule) {
    std::vector<Scalar> scalars;
    if (rule.domain != Domain::Int && rule.domain != Domain::Bool) scalars.push_back(Scalar::Float);
    if (rule.domain != Domain::Float && rule.domain != Domain::Bool) scalars.push_back(Scalar::Int);
    if (rule.domain == Domain::Bool || rule.domain == Domain::Any) scalars.push_back(Scalar::Bool);
    std::vector<Type> types;
    for (Scalar scalar : scalars) {
        types.push_back({scalar, 1});
        const bool names_type = rule.left.find('a', rule.left.find('(')) != std::string_view::npos;
        if (!compares(parse_pattern(rule.left)) && rule.domain != Domain::Bool && names_type)
            types.push_back({scalar, 3});
    }
    return types;
}

Type result_of(const RewriteRule& rule, Type type) {
    const TypeRule root = info(parse_pattern(rule.left).op).type_rule;
    return root == TypeRule::Compare || root == TypeRule::Logic ? bool1 : type;
}

std::vector<double> interesting_values(Scalar scalar, Random& random) {
    if (scalar == Scalar::Bool) return {0, 1};
    if (scalar == Scalar::Int)
        return {0,
                1,
                -1,
                2,
                7,
                -2147483648.0,
                2147483647.0,
                static_cast<double>(random.between(-1000, 1000))};
    using Limits = std::numeric_limits<float>;
    std::vector<double> values;
    for (float value : {0.0f,
                        -0.0f,
                        1.0f,
                        -1.0f,
                        0.5f,
                        3.0f,
                        0.1f,
                        16777216.0f,
                        1e30f,
                        -1e-30f,
                        Limits::min(),
                        -Limits::min(),
                        Limits::max(),
                        Limits::lowest(),
                        Limits::infinity(),
                        -Limits::infinity(),
                        Limits::quiet_NaN(),
                        Limits::denorm_min(),
                        random.unit(),
                        random.unit() * -100.0f})
        values.push_back(static_cast<double>(value));
    return values;
}

// Empty, or the inputs on which the sides differ.
std::string counterexample(const RewriteRule& rule, Type type) {
    const Type result = result_of(rule, type);
    const Side left(rule.left, type, result), right(rule.right, type, result);
    const Evaluator left_evaluator(left.module()), right_evaluator(right.module());
    Random random(7);
    for (int round = 0; round < rounds(4); ++round) {
        const std::vector<double> values = interesting_values(type.scalar, random);
        for (double a : values)
            for (double b : values)
                for (int bools = 0; bools < 4; ++bools) {
                    Environment environment;
                    environment.inputs = {
                        {a, b, a, b}, {b, b, a, a}, {double(bools & 1)}, {double(bools >> 1)}};
                    const std::string found = difference(
                        left_evaluator.run(environment, Precision::Single),
                        right_evaluator.run(environment, Precision::Single), Precision::Single);
                    if (!found.empty())
                        return fmt::format("a = {}, b = {}, bools = {}: {}", a, b, bools, found);
                }
    }
    return {};
}

TEST(RewriteRules, HoldToTheBit) {
    for (const RewriteRule& rule : rewrite_rules())
        for (Type type : types_of(rule))
            EXPECT_EQ(counterexample(rule, type), "")
                << rule.left << " is not " << rule.right << " for " << to_string(type);
}

TEST(RewriteRules, AreApplied) {
    for (const RewriteRule& rule : rewrite_rules())
        for (Type type : types_of(rule)) {
            const Type result = result_of(rule, type);
            Module left = Side(rule.left, type, result).module(),
                   right = Side(rule.right, type, result).module();
            const Status status = verify(left);
            ASSERT_TRUE(status.ok()) << to_string(status.error());
            fold_constants(left);
            remove_dead_code(left);
            remove_dead_code(right);
            const auto count = [](const Module& module) { return module.body.body.size(); };
            EXPECT_EQ(count(left), count(right))
                << rule.left << " stayed for " << to_string(type) << "\n"
                << print(left);
        }
}

// Identities of real numbers that floats do not have: the check must find each one out.
TEST(RewriteRules, CheckRefusesWrongRows) {
    constexpr RewriteRule wrong[] = {
        {"add(a, 0)", "a", Domain::Float},
        {"sub(a, a)", "0", Domain::Float},
        {"mul(a, 0)", "0", Domain::Float},
        {"sub(0, a)", "neg(a)", Domain::Float},
        {"neg(sub(a, b))", "sub(b, a)", Domain::Float},
        {"not(less(a, b))", "greater_equal(a, b)", Domain::Float},
        {"equal(a, a)", "true", Domain::Float},
        {"sub(add(a, b), b)", "a", Domain::Float},
        {"max(a, 0)", "a", Domain::Int},
        {"select(c, a, b)", "b", Domain::Any},
        {"and(c, d)", "c", Domain::Any},
    };
    for (const RewriteRule& rule : wrong)
        for (Type type : types_of(rule))
            EXPECT_NE(counterexample(rule, type), "") << rule.left << " = " << rule.right;
}

// The rewrite that is no row: x / 2^k = x * 2^-k, at both ends of the exponents and one beyond
// them.
TEST(RewriteRules, DivisionByPowersOfTwo) {
    for (int exponent = -126; exponent <= 127; ++exponent)
        for (float sign : {1.0f, -1.0f}) {
            Module module;
            module.stage = Stage::Function;
            module.inputs = {{"a", float1, Semantic::Parameter}};
            module.outputs = {{"result", float1, Semantic::Result}};
            Builder builder(module);
            const ValueId a = builder.input(0),
                          divisor = builder.constant(std::ldexp(sign, exponent));
            const ValueId quotient = builder.emit(Op::Div, {a, divisor});
            builder.finish({&quotient, 1});
            Module folded = module;
            fold_constants(folded);
            bool divides = false;
            for_each_instruction(folded.body,
                                 [&](const Instruction& i) { divides |= i.op == Op::Div; });
            EXPECT_EQ(divides, exponent == 127) << "2^-127 is a denormal; exponent " << exponent;
            Random random(static_cast<std::uint64_t>(exponent + 200));
            for (int i = 0; i < rounds(200); ++i) {
                Environment environment;
                environment.inputs = {random_vector(random, float1)};
                ASSERT_EQ(difference(Evaluator(module).run(environment, Precision::Single),
                                     Evaluator(folded).run(environment, Precision::Single),
                                     Precision::Single),
                          "")
                    << environment.inputs[0][0] << " / " << sign << " * 2^" << exponent;
            }
        }
}

}  // namespace
}  // namespace intaglio::passes

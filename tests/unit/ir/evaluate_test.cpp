// The evaluator against values known by hand, against arithmetic rounded from double, and against
// itself op by op.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "generator/ir/evaluate.h"
#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "tests/rounds.h"
#include "tests/unit/ir/random_environment.h"
#include "tests/unit/ir/random_module.h"

namespace intaglio::ir {
namespace {

using ::testing::ElementsAre;
using testing::Random;

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float denormal = 1e-40f;
constexpr float smallest = std::numeric_limits<float>::min();

// One scalar float op in Single, on bits.
float run_op(Op op, std::vector<float> operands) {
    Instruction instruction;
    instruction.op = op;
    std::vector<Type> types(operands.size(), float1);
    std::vector<ConstantBits> bits;
    for (std::size_t i = 0; i < operands.size(); ++i) {
        instruction.operands.push_back(static_cast<ValueId>(i));
        bits.push_back({float_bits(operands[i])});
    }
    return std::bit_cast<float>((*evaluate_op(instruction, types, bits))[0]);
}

std::uint32_t run_bits(Op op, std::vector<float> operands) {
    return float_bits(run_op(op, std::move(operands)));
}

std::uint32_t run_int(Op op, std::vector<std::int32_t> operands) {
    Instruction instruction;
    instruction.op = op;
    std::vector<Type> types(operands.size(), int1);
    std::vector<ConstantBits> bits;
    for (std::int32_t operand : operands) {
        instruction.operands.push_back(static_cast<ValueId>(bits.size()));
        bits.push_back({static_cast<std::uint32_t>(operand)});
    }
    return (*evaluate_op(instruction, types, bits))[0];
}

Module parsed(const char* text) {
    auto module = parse(text, "test.ir");
    EXPECT_TRUE(module) << (module ? "" : to_string(module.error()));
    const Status status = verify(*module);
    EXPECT_TRUE(status) << (status ? "" : to_string(status.error()));
    return *std::move(module);
}

// The exact result rounded once to 24 bits; below the normal numbers zero of its sign; one NaN.
float flushed(double exact) {
    constexpr double limit = double(smallest) * (1.0 - 0x1p-25);
    if (std::isnan(exact)) return nan;
    return std::fabs(exact) < limit ? static_cast<float>(std::copysign(0.0, exact))
                                    : static_cast<float>(exact);
}
double operand(float value) {
    return std::fabs(value) < smallest ? std::copysign(0.0, value) : value;
}

// Rounding a sum, product, quotient or root from 53 bits to 24 is the same as rounding it once (53
// >= 2 * 24 + 2).
TEST(EvaluateOp, RoundsOnceAndFlushesDenormals) {
    constexpr std::uint64_t seed = 5;
    Random random(seed);
    for (int i = 0; i < rounds(50000); ++i) {
        float a = random.any_float(), b = random.any_float();
        if (i % 3 == 0)
            a = std::ldexp(1.0f + random.unit(), random.between(-70, -55)),
            b = std::ldexp(a, 0) * 0.5f;
        const double x = operand(a), y = operand(b);
        ASSERT_EQ(run_bits(Op::Add, {a, b}), float_bits(flushed(x + y)))
            << a << " " << b << " seed " << seed;
        ASSERT_EQ(run_bits(Op::Sub, {a, b}), float_bits(flushed(x - y))) << a << " " << b;
        ASSERT_EQ(run_bits(Op::Mul, {a, b}), float_bits(flushed(x * y))) << a << " " << b;
        ASSERT_EQ(run_bits(Op::Div, {a, b}), float_bits(flushed(x / y))) << a << " " << b;
        ASSERT_EQ(run_bits(Op::Sqrt, {a}), float_bits(flushed(std::sqrt(x)))) << a;
        const float root = flushed(std::sqrt(x));
        ASSERT_EQ(run_bits(Op::Rsqrt, {a}), float_bits(flushed(1.0 / operand(root)))) << a;
        const float c = random.any_float();
        const float left = flushed(x * operand(flushed(1.0 - operand(c)))),
                    right = flushed(y * operand(c));
        ASSERT_EQ(run_bits(Op::Lerp, {a, b, c}),
                  float_bits(flushed(operand(left) + operand(right))));
    }
}

TEST(EvaluateOp, FlushesWhatRoundsUpToTheSmallestNormalNumber) {
    // (1 - 2^-24) * 2^-126 is a tie between the last denormal number and the first normal one, and
    // rounds to the latter with gradual underflow; with 24 bits at any exponent it stays below, and
    // is flushed.
    const float below_one = 0x1.fffffep-1f;
    EXPECT_EQ(smallest * below_one, smallest) << "the processor's own rounding, for contrast";
    EXPECT_EQ(run_bits(Op::Mul, {smallest, below_one}), 0u);
    EXPECT_EQ(run_bits(Op::Mul, {-smallest, below_one}), 0x80000000u);
    EXPECT_EQ(run_bits(Op::Mul, {smallest, 1.0f}), float_bits(smallest));
}

TEST(EvaluateOp, FollowsTheTableOnSpecialValues) {
    EXPECT_EQ(run_op(Op::Min, {nan, 1.0f}), 1.0f);
    EXPECT_EQ(run_op(Op::Min, {1.0f, nan}), 1.0f);
    EXPECT_EQ(run_op(Op::Max, {nan, -inf}), -inf);
    EXPECT_EQ(run_bits(Op::Max, {nan, nan}), 0x7fc00000u);
    EXPECT_EQ(run_op(Op::Min, {2.0f, -3.0f}), -3.0f);
    EXPECT_EQ(run_bits(Op::Saturate, {nan}), 0u);
    EXPECT_EQ(run_bits(Op::Saturate, {-0.0f}), 0u);
    EXPECT_EQ(run_op(Op::Saturate, {inf}), 1.0f);
    EXPECT_EQ(run_op(Op::Saturate, {0.25f}), 0.25f);
    EXPECT_EQ(run_op(Op::Floor, {-0.5f}), -1.0f);
    EXPECT_EQ(run_bits(Op::Floor, {-denormal}), 0x80000000u);
    EXPECT_EQ(run_op(Op::Frac, {-0.25f}), 0.75f);
    EXPECT_EQ(run_op(Op::Frac, {-1e-10f}), 1.0f) << "a - floor(a), rounded once";
    EXPECT_TRUE(std::isnan(run_op(Op::Frac, {inf})));
    EXPECT_EQ(run_bits(Op::Neg, {denormal}), float_bits(-denormal))
        << "flips the sign bit, no more";
    EXPECT_EQ(run_bits(Op::Neg, {nan}), 0xffc00000u);
    EXPECT_EQ(run_bits(Op::Abs, {-0.0f}), 0u);
    EXPECT_EQ(run_bits(Op::Div, {0.0f, 0.0f}), 0x7fc00000u);
    EXPECT_EQ(run_op(Op::Div, {1.0f, -0.0f}), -inf);
    EXPECT_EQ(run_op(Op::Rsqrt, {4.0f}), 0.5f);
    EXPECT_EQ(run_op(Op::Exp2, {3.0f}), 8.0f);
    EXPECT_EQ(run_op(Op::Log2, {8.0f}), 3.0f);
    EXPECT_EQ(run_op(Op::Pow, {2.0f, 10.0f}), 1024.0f);
    EXPECT_TRUE(std::isnan(run_op(Op::Pow, {-2.0f, 2.0f})));
    EXPECT_EQ(run_op(Op::Sin, {0.0f}), 0.0f);
    EXPECT_EQ(run_op(Op::Cos, {0.0f}), 1.0f);
    EXPECT_EQ(run_op(Op::Lerp, {2.0f, 6.0f, 0.25f}), 3.0f);
    for (Op op : {Op::Less, Op::LessEqual, Op::Greater, Op::GreaterEqual, Op::Equal})
        EXPECT_EQ(run_bits(op, {nan, nan}), 0u);
    EXPECT_EQ(run_bits(Op::NotEqual, {nan, nan}), 1u);
    EXPECT_EQ(run_bits(Op::Equal, {-0.0f, 0.0f}), 1u);
    EXPECT_EQ(run_bits(Op::Equal, {denormal, 0.0f}), 1u) << "a denormal counts as zero";
    EXPECT_EQ(run_bits(Op::Less, {0.0f, denormal}), 0u);
}

TEST(EvaluateOp, WrapsInts) {
    constexpr std::int32_t most = 0x7fffffff, least = -most - 1;
    EXPECT_EQ(run_int(Op::Add, {most, 1}), 0x80000000u);
    EXPECT_EQ(run_int(Op::Sub, {least, 1}), 0x7fffffffu);
    EXPECT_EQ(run_int(Op::Mul, {65536, 65536}), 0u);
    EXPECT_EQ(run_int(Op::Neg, {least}), 0x80000000u);
    EXPECT_EQ(run_int(Op::Abs, {-5}), 5u);
    EXPECT_EQ(run_int(Op::Min, {-1, 1}), 0xffffffffu);
    EXPECT_EQ(run_int(Op::Less, {-1, 1}), 1u);
    EXPECT_EQ(run_int(Op::ToFloat, {16777217}), float_bits(16777216.0f));
}

TEST(EvaluateOp, GoesLeftToRightInADotProduct) {
    Instruction dot;
    dot.op = Op::Dot;
    dot.operands = {ValueId{0}, ValueId{1}};
    const std::vector<Type> types(2, float3);
    const std::vector<ConstantBits> operands = {
        {float_bits(1e8f), float_bits(1.0f), float_bits(-1e8f)},
        {float_bits(1.0f), float_bits(1.0f), float_bits(1.0f)}};
    EXPECT_EQ((*evaluate_op(dot, types, operands))[0], 0u)
        << "1e8 + 1 loses the 1 before -1e8 is added";
}

TEST(EvaluateOp, LeavesAloneWhatIsNoFunctionOfItsOperands) {
    for (Op op : {Op::Input, Op::Uniform, Op::SampleLevel, Op::Ddx, Op::Loop, Op::If, Op::Return}) {
        Instruction instruction;
        instruction.op = op;
        EXPECT_EQ(evaluate_op(instruction, {}, {}), std::nullopt);
    }
}

// Random modules without control flow and texture reads: the evaluator gives what evaluate_op gives
// op by op.
TEST(Evaluator, AgreesWithEvaluateOp) {
    testing::RandomModuleOptions options;
    options.max_depth = 0;
    options.samples = options.derivatives = false;
    int compared = 0;
    for (std::uint64_t seed = 0; seed < rounds(1000u); ++seed) {
        const Module module = testing::random_module(seed, options);
        const auto environment = testing::random_environment(module, seed).environment;
        std::map<ValueId, ConstantBits> values;
        const auto read = [&](const Environment::Vector& source, Type type) {
            ConstantBits bits{};
            for (std::size_t i = 0; i < static_cast<std::size_t>(type.width); ++i)
                bits[i] = type.scalar == Scalar::Float
                              ? float_bits(static_cast<float>(source[i]))
                              : static_cast<std::uint32_t>(static_cast<int>(source[i]));
            return bits;
        };
        for (const Instruction& instruction : module.body.body) {
            if (instruction.op == Op::Return) break;
            const Type type = module.type(instruction.result());
            const auto slot = static_cast<std::size_t>(instruction.slot);
            ConstantBits& result = values[instruction.result()];
            if (instruction.op == Op::Constant) {
                result = instruction.bits;
            } else if (instruction.op == Op::Input) {
                result = read(environment.inputs[slot], type);
            } else if (instruction.op == Op::Uniform) {
                result =
                    read(environment.uniforms[slot][static_cast<std::size_t>(instruction.element)],
                         type);
            } else {
                std::vector<Type> types;
                std::vector<ConstantBits> operands;
                for (ValueId id : instruction.operands) {
                    types.push_back(module.type(id));
                    operands.push_back(values[id]);
                }
                result = *evaluate_op(instruction, types, operands, type.width);
            }
        }
        const Evaluation evaluation = Evaluator(module).run(environment, Precision::Single);
        const auto& returned = module.body.body.back().operands;
        for (std::size_t i = 0; i < returned.size(); ++i) {
            const Type type = module.type(returned[i]);
            for (std::size_t j = 0; j < static_cast<std::size_t>(type.width); ++j, ++compared) {
                const std::uint32_t bits = values[returned[i]][j];
                const double got = evaluation.outputs[i][j];
                if (type.scalar != Scalar::Float)
                    ASSERT_EQ(got, static_cast<std::int32_t>(bits)) << "seed " << seed;
                else if (std::isnan(std::bit_cast<float>(bits)))
                    ASSERT_TRUE(std::isnan(got)) << "seed " << seed;
                else
                    ASSERT_EQ(float_bits(static_cast<float>(got)), bits) << "seed " << seed << "\n"
                                                                         << print(module);
            }
        }
    }
    EXPECT_GT(compared, rounds(2500));
}

TEST(Evaluator, CarriesLoopValuesAllAtOnce) {
    // Fibonacci by swapping, left when the index reaches the input.
    const Module module =
        parsed(R"(function "fibonacci" input n int1 parameter output a int1 result {
        %n int1 = input n  %zero int1 = const 0  %one int1 = const 1
        %ra int1, %rb int1 = loop "grow" 20 (%zero, %one) { (%i int1, %a int1, %b int1):
            %done bool1 = greater_equal %i, %n
            break_if %done (%a, %b)
            %sum int1 = add %a, %b
            yield (%b, %sum)
        }
        return (%ra) })");
    const Evaluator evaluator(module);
    const auto at = [&](int n) {
        return evaluator.run({.inputs = {{double(n)}}}, Precision::Single).outputs[0][0];
    };
    EXPECT_EQ(at(0), 0);
    EXPECT_EQ(at(1), 1);
    EXPECT_EQ(at(2), 1);
    EXPECT_EQ(at(10), 55);
    EXPECT_EQ(at(1000), 6765) << "the trip count ends it at 20";
    // A loop, then a compare, a break and an add an iteration; the last iteration has no add.
    EXPECT_EQ(evaluator.run({.inputs = {{2.0}}}, Precision::Single).instructions, 1 + 2 * 3 + 2);
}

TEST(Evaluator, NestsLoopsAndBranches) {
    const Module module = parsed(R"(function "nest" input n int1 parameter output o int1 result {
        %n int1 = input n  %zero int1 = const 0  %one int1 = const 1  %two int1 = const 2
        %never int1 = loop "none" 0 (%two) { (%k int1, %c int1): yield (%zero) }
        %r int1 = loop "outer" 4 (%never) { (%i int1, %acc int1):
            %s int1 = loop "inner" 5 (%acc) { (%j int1, %t int1):
                %stop bool1 = greater %j, %i
                break_if %stop (%t)
                %u int1 = add %t, %one
                yield (%u)
            }
            %odd bool1 = equal %i, %n
            %v int1 = if %odd { %w int1 = mul %s, %two yield (%w) } else { yield (%s) }
            yield (%v)
        }
        return (%r) })");
    const Evaluator evaluator(module);
    // From 2, add i + 1 for each i, and double after i == n.
    EXPECT_EQ(evaluator.run({.inputs = {{9.0}}}, Precision::Single).outputs[0][0],
              2 + 1 + 2 + 3 + 4);
    EXPECT_EQ(evaluator.run({.inputs = {{1.0}}}, Precision::Double).outputs[0][0],
              (2 + 1 + 2) * 2 + 3 + 4);
}

TEST(Evaluator, TakesDerivativesFromTheNeighbours) {
    const Module module = parsed(R"(pixel "d" input p float2 interpolant
        output x float2 target output y float2 target output xx float2 target {
        %p float2 = input p  %q float2 = mul %p, %p
        %x float2 = ddx %q  %y float2 = ddy %q  %xx float2 = ddx %x  return (%x, %y, %xx) })");
    Environment environment{
        .inputs = {{2.0, 3.0}}, .right_inputs = {{2.5, 3.0}}, .lower_inputs = {{2.0, 5.0}}};
    const Evaluator evaluator(module);
    EXPECT_THAT(evaluator.run(environment, Precision::Double).outputs,
                ElementsAre(std::array{2.25, 0.0, 0.0, 0.0}, std::array{0.0, 16.0, 0.0, 0.0},
                            std::array{0.0, 0.0, 0.0, 0.0}));
    environment.right_inputs.clear();
    EXPECT_EQ(evaluator.run(environment, Precision::Double).outputs[1][1], 0.0);
}

TEST(Evaluator, ReadsWhatIsMissingAsZeroAndConvertsWhatIsOdd) {
    const Module module = parsed(
        R"(function "m" input a float2 parameter input i int1 parameter input b bool1 parameter
        uniform u float3[2] sampler s 2d
        output o float2 result output oi int1 result output ob bool1 result output ou float3 result
        output os float4 result {
        %a float2 = input a  %i int1 = input i  %b bool1 = input b  %u float3 = uniform u[1]
        %s float4 = sample s %a  return (%a, %i, %b, %u, %s) })");
    const Evaluator evaluator(module);
    for (const auto& output : evaluator.run({}, Precision::Single).outputs)
        EXPECT_THAT(output, ElementsAre(0.0, 0.0, 0.0, 0.0));
    const auto outputs =
        evaluator.run({.inputs = {{0.1, 1e300}, {1e300}, {-2.0}}}, Precision::Single).outputs;
    EXPECT_THAT(outputs[0], ElementsAre(double(0.1f), double(inf), 0.0, 0.0));
    EXPECT_EQ(outputs[1][0], 2147483647.0);
    EXPECT_EQ(outputs[2][0], 1.0);
}

// Each of some twenty roundings costs at most half an ulp of a value below 8; the sum loses no more
// than that by cancellation, because all terms are positive.
TEST(Evaluator, ComputesTheSameInBothPrecisionsUpToRounding) {
    const Module module = parsed(R"(function "c" input a float3 parameter input b float3 parameter
        output o float1 result {
        %a float3 = input a  %b float3 = input b  %d float1 = dot %a, %b  %r float1 = rsqrt %d
        %s float3 = lerp %a, %b, %a  %t float1 = swizzle %s.y  %e float1 = exp2 %r  %l float1 = log2 %e
        %x float1 = add %e, %l  %y float1 = mul %x, %t  return (%y) })");
    const Evaluator evaluator(module);
    Random random(3);
    bool differs = false;
    for (int i = 0; i < 2000; ++i) {
        Environment environment{.inputs = {{}, {}}};
        for (auto& input : environment.inputs)
            for (std::size_t j = 0; j < 3; ++j) input[j] = 0.25f + 0.5f * random.unit();
        const double single = evaluator.run(environment, Precision::Single).outputs[0][0];
        const double exact = evaluator.run(environment, Precision::Double).outputs[0][0];
        ASSERT_NEAR(single, exact, 20 * 4 * 0x1p-24 * 8);
        differs |= single != exact;
    }
    EXPECT_TRUE(differs);
}

TEST(Evaluator, KeepsDenormalsInDouble) {
    const Module module = parsed(R"(function "d" input a float1 parameter output o float1 result {
        %a float1 = input a  %half float1 = const 0.5  %o float1 = mul %a, %half  return (%o) })");
    const Evaluator evaluator(module);
    EXPECT_EQ(evaluator.run({.inputs = {{1e-310}}}, Precision::Double).outputs[0][0], 0.5e-310);
    EXPECT_EQ(evaluator.run({.inputs = {{1e-38}}}, Precision::Single).outputs[0][0], 0.0);
}

// Whatever the module and the numbers: an answer, always the same one, also after a round through
// text.
TEST(Evaluator, RunsEveryRandomModule) {
    long reads = 0, instructions = 0;
    for (std::uint64_t seed = 0; seed < rounds(800u); ++seed) {
        const Module module = testing::random_module(seed, {.instructions = 80});
        const auto environment = testing::random_environment(module, seed);
        const Evaluator evaluator(module), again(*parse(print(module), "again.ir"));
        for (Precision precision : {Precision::Single, Precision::Double}) {
            const Evaluation first = evaluator.run(environment.environment, precision);
            ASSERT_EQ(first.outputs.size(), module.outputs.size());
            ASSERT_TRUE(testing::same_outputs(first, again.run(environment.environment, precision)))
                << "seed " << seed << "\n"
                << print(module);
            reads += first.texture_reads;
            instructions += first.instructions;
        }
    }
    EXPECT_GT(reads, rounds(400));
    EXPECT_GT(instructions, rounds(40000));
}

}  // namespace
}  // namespace intaglio::ir

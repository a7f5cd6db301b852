// The evaluator in 24 and 16 bits: against the formats' own rounding, and at the edges that the
// Direct3D 9 reference defines.
#include <gtest/gtest.h>

#include <cmath>

#include "generator/ir/evaluate.h"
#include "generator/ir/narrow.h"
#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "tests/unit/ir/random_environment.h"
#include "tests/unit/ir/random_module.h"

namespace intaglio::ir {
namespace {

double rounded(double value, Precision precision) {
    return precision == Precision::Narrow24 ? Format24::round(value) : Format16::round(value);
}

// A function of a and b.
double run(const std::string& op, double a, double b, Precision precision) {
    const auto module = parse(
        R"(function "f" input a float1 parameter input b float1 parameter output o float1 result {
        %a float1 = input a  %b float1 = input b  %o float1 = )" +
            op + " return (%o) }",
        "narrow.ir");
    EXPECT_TRUE(module) << to_string(module.error());
    return Evaluator(*module).run({.inputs = {{a}, {b}}}, precision).outputs[0][0];
}

constexpr std::array narrow = {Precision::Narrow24, Precision::Narrow16};

TEST(NarrowEvaluation, RoundsOnceAfterEachOperation) {
    testing::Random random(20);
    SCOPED_TRACE("seed 20");
    for (int i = 0; i < 300; ++i)
        for (Precision precision : narrow) {
            const double a = rounded(random.between(-3000, 3000) / 101.0, precision),
                         b = rounded(random.between(-3000, 3000) / 103.0, precision);
            if (b == 0) continue;
            EXPECT_EQ(run("mul %a, %b", a, b, precision), rounded(a * b, precision));
            EXPECT_EQ(run("add %a, %b", a, b, precision), rounded(a + b, precision));
            EXPECT_EQ(run("max %a, %b", a, b, precision), std::max(a, b)) << "nothing to round";
            // A reciprocal and a product: two roundings, each by an ulp at most.
            const double ulp = precision == Precision::Narrow24 ? 0x1p-16 : 0x1p-10;
            EXPECT_NEAR(run("div %a, %b", a, b, precision), a / b, std::abs(a / b) * 2 * ulp);
        }
}

TEST(NarrowEvaluation, DefinesEdgesAsTheDirect3D9ReferenceDoes) {
    EXPECT_EQ(run("div %a, %b", 1, 0, Precision::Narrow24), 0x1.FFFFp63);
    EXPECT_EQ(run("div %a, %b", 0, 0, Precision::Narrow24), 0);
    EXPECT_EQ(run("div %a, %b", 1, 0, Precision::Narrow16), 65504);
    EXPECT_EQ(run("rsqrt %a", 0, 0, Precision::Narrow16), 65504);
    EXPECT_EQ(run("sqrt %a", 0, 0, Precision::Narrow16), 0);
    EXPECT_EQ(run("mul %a, %b", 1e-5, 1e-5, Precision::Narrow16), 0) << "below the least half";
    EXPECT_TRUE(std::isinf(run("mul %a, %b", 300, 300, Precision::Narrow16)));
}

// Whatever goes in, whatever is computed: no value that the format does not have.
TEST(NarrowEvaluation, EveryValueIsOneOfTheFormat) {
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const Module module = testing::random_module(seed, {});
        const auto random = testing::random_environment(module, seed);
        for (Precision precision : narrow) {
            const Evaluation done = Evaluator(module).run(random.environment, precision);
            const auto& returned = module.body.body.back().operands;
            for (std::size_t i = 0; i < returned.size(); ++i) {
                if (module.type(returned[i]).scalar != Scalar::Float) continue;
                for (double value : done.outputs[i])
                    if (!std::isnan(value)) {
                        ASSERT_EQ(value, rounded(value, precision)) << "seed " << seed << "\n"
                                                                    << print(module);
                        ++compared;
                    }
            }
        }
    }
    EXPECT_GT(compared, 1000);
}

}  // namespace
}  // namespace intaglio::ir

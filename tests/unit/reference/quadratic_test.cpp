// The root finder alone: exact cases, touches, degenerate coefficients, and random quadratics
// against sampling.
#include "src/reference/quadratic.h"

#include "tests/unit/reference/witness.h"

namespace intaglio::reference {
namespace {

double value(const Quadratic& g, double s) {
    return g.from + (g.to - g.from) * s - g.bend * s * (1 - s);
}

TEST(Quadratic, FindsExactRoots) {
    EXPECT_EQ((Quadratic{-1, 1, 0}.first_nonnegative()), 0.5);
    EXPECT_EQ((Quadratic{-0.25, 0.75, 1}.first_nonnegative()), 0.5);         // s^2 - 1/4
    EXPECT_EQ((Quadratic{-0.1875, -0.1875, -1}.first_nonnegative()), 0.25);  // -(s - 1/4)(s - 3/4)
    EXPECT_EQ((Quadratic{-0.5, 0, 0}.first_nonnegative()), 1);
    EXPECT_EQ((Quadratic{0, -1, 0}.first_nonnegative()), 0);
    EXPECT_EQ((Quadratic{3, -1, 7}.first_nonnegative()), 0);
}

TEST(Quadratic, TakesATouchFromBelowAsContact) {
    EXPECT_EQ((Quadratic{-0.25, -0.25, -1}.first_nonnegative()), 0.5);       // -(s - 1/2)^2
    EXPECT_EQ((Quadratic{-0.0625, -0.5625, -1}.first_nonnegative()), 0.25);  // -(s - 1/4)^2
    EXPECT_GT((Quadratic{-0.25 - 1e-12, -0.25 - 1e-12, -1}.first_nonnegative()), 1);
    EXPECT_NEAR((Quadratic{-0.25 + 1e-12, -0.25 + 1e-12, -1}.first_nonnegative()), 0.5 - 1e-6,
                1e-9);
}

TEST(Quadratic, SaysWhenThereIsNone) {
    EXPECT_GT((Quadratic{-1, -1, 0}.first_nonnegative()), 1);
    EXPECT_GT((Quadratic{-1, -1e-300, 0}.first_nonnegative()), 1);
    EXPECT_GT((Quadratic{-1, -0.5, 100}.first_nonnegative()), 1);
    EXPECT_GT((Quadratic{-1, -3, -0.5}.first_nonnegative()), 1);  // the summit is before s = 0
    EXPECT_FALSE((Quadratic{NAN, 1, 0}.first_nonnegative() <= 1));
    EXPECT_FALSE((Quadratic{-1, NAN, 0}.first_nonnegative() <= 1));
}

TEST(Quadratic, KeepsItsDigitsWhenTheBendIsTinyOrTheRootIs) {
    // (-b + sqrt(b^2 - 4ac)) / 2a would lose them all.
    EXPECT_NEAR((Quadratic{-1, 2, 1e-17}.first_nonnegative()), 1.0 / 3, 1e-16);
    EXPECT_NEAR((Quadratic{-1, 2, -1e-17}.first_nonnegative()), 1.0 / 3, 1e-16);
    EXPECT_NEAR((Quadratic{-1e-20, 1, -1}.first_nonnegative()) / 0.5e-20, 1, 1e-15);
    EXPECT_NEAR((Quadratic{-1e-20, 1, 1}.first_nonnegative()) / 1e-10, 1, 1e-9);
    EXPECT_EQ((Quadratic{-1e-100, 1e-100, 0}.first_nonnegative()), 0.5);
}

TEST(Quadratic, RandomOnesAgreeWithSampling) {
    witness::Random random(witness::seed());
    for (int i = 0; i < 200000; ++i) {
        const double bend_size = std::pow(10.0, random.real(-18, 1));
        const Quadratic g{random.real(-1, 0.1), random.real(-1, 1), random.real(-1, 1) * bend_size};
        const double s = g.first_nonnegative();
        const double largest = 1 + std::abs(g.bend);
        double highest = -INFINITY;
        for (int k = 0; k <= 64; ++k) {
            const double at = k / 64.0, sampled = value(g, at);
            highest = std::max(highest, sampled);
            if (at < s) {
                ASSERT_LT(sampled, 1e-15 * largest) << g.from << " " << g.to << " " << g.bend;
            }
        }
        if (s <= 1) {
            // 4e-16 of the root finder and as much of value().
            ASSERT_GE(s, 0);
            ASSERT_TRUE(s == 0 ? g.from >= 0 : std::abs(value(g, s)) <= 1e-15 * largest)
                << g.from << " " << g.to << " " << g.bend << " s " << s;
        } else {
            ASSERT_LT(g.maximum(), 1e-15 * largest);
        }
        // A summit is at most bend / 4 (half a sample)^2 above the nearest sample.
        ASSERT_GE(g.maximum(), highest - 1e-15 * largest);
        ASSERT_LE(g.maximum(), highest + std::abs(g.bend) / (128.0 * 128.0) + 1e-15 * largest);
    }
}

}  // namespace
}  // namespace intaglio::reference

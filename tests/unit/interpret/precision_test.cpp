// The number formats by their known roundings, and what a shader shows of them.
#include "generator/target/d3d9/precision.h"

#include <random>

#include "tests/unit/interpret/programs.h"

namespace intaglio::d3d9 {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(Narrow24, KnownRoundings) {
    EXPECT_EQ(Narrow24::div(1, 3), 0x1.5555p-2f);
    EXPECT_EQ(Narrow24::div(2, 3), 0x1.5555p-1f);  // nearest would be 0x1.5556p-1
    EXPECT_EQ(Narrow24::load(0.1f), 0x1.9999p-4f);
    EXPECT_EQ(Narrow24::load(-0.1f), -0x1.9999p-4f);
    EXPECT_EQ(Narrow24::add(1, 0x1p-16f), 1 + 0x1p-16f);
    EXPECT_EQ(Narrow24::add(1, 0x1.8p-16f), 1 + 0x1p-16f);
    // Of a number next to nothing below 1 the truncated sum is the number before 1, even where
    // binary64 cannot hold the exact sum.
    for (const float small : {0x1p-17f, 0x1p-40f, 0x1p-62f}) {
        EXPECT_EQ(Narrow24::sub(1, small), 1 - 0x1p-17f) << small;
        EXPECT_EQ(Narrow24::add(1, small), 1) << small;
        EXPECT_EQ(Narrow24::sub(small, 1), -(1 - 0x1p-17f)) << small;
    }
}

TEST(Narrow24, Spacing) {
    // On [0.5, 1) numbers lie 2^-17 apart, on [1, 2) 2^-16.
    EXPECT_EQ(Narrow24::load(0.75f + 0x1p-17f), 0.75f + 0x1p-17f);
    EXPECT_EQ(Narrow24::load(0.75f + 0x1p-18f), 0.75f);
    EXPECT_EQ(Narrow24::load(1.5f + 0x1p-16f), 1.5f + 0x1p-16f);
    EXPECT_EQ(Narrow24::load(1.5f + 0x1p-17f), 1.5f);
}

TEST(Narrow24, Range) {
    EXPECT_EQ(Narrow24::load(0x1p-62f), 0x1p-62f);
    EXPECT_EQ(Narrow24::load(0x1.FFFFp-63f), 0);  // no denormals
    EXPECT_TRUE(std::signbit(Narrow24::load(-0x1p-63f)));
    EXPECT_EQ(Narrow24::mul(0x1p-31f, 0x1p-32f), 0);
    EXPECT_EQ(Narrow24::largest, Narrow24::load(0x1.FFFFFEp63f));
    EXPECT_EQ(Narrow24::load(0x1p64f), infinity);
    EXPECT_EQ(Narrow24::mul(-Narrow24::largest, 2), -infinity);
    EXPECT_EQ(Narrow24::rcp(0), Narrow24::largest);
    EXPECT_TRUE(std::isnan(Narrow24::mul(infinity, 0)));
    EXPECT_EQ(Narrow24::saturate(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(Narrow16, KnownRoundings) {
    EXPECT_EQ(Narrow16::div(1, 3), 0x1.554p-2f);
    EXPECT_EQ(Narrow16::load(0.1f), 0x1.998p-4f);
    EXPECT_EQ(Narrow16::add(2048, 1), 2048);  // ties go to even
    EXPECT_EQ(Narrow16::add(2048, 3), 2052);
    EXPECT_EQ(Narrow16::load(65519), 65504);
    EXPECT_EQ(Narrow16::load(65520), infinity);
    EXPECT_EQ(Narrow16::load(0x1p-24f), 0x1p-24f);  // the smallest denormal
    EXPECT_EQ(Narrow16::load(0x1p-25f), 0);
    EXPECT_EQ(Narrow16::load(0x1.8p-24f), 0x1p-23f);
    EXPECT_EQ(Narrow16::load(0x1.FFCp-15f), 0x1.FF8p-15f + 0x1p-24f);
    EXPECT_TRUE(std::signbit(Narrow16::load(-0x1p-26f)));
}

TEST(Single, FlushesDenormals) {
    EXPECT_EQ(Single::load(1e-39f), 0);
    EXPECT_EQ(Single::mul(1e-20f, 1e-20f), 0);
    EXPECT_EQ(Single::rcp(1e-39f), 1.0f / 1e-39f) << "rcp itself is given loaded numbers";
    EXPECT_EQ(Single::rcp(Single::load(1e-39f)), std::numeric_limits<float>::max());
}

// Narrow formats keep order, keep what they hold already, and err by less than a unit in the last
// place.
template <typename A>
void check_rounding(int fraction_bits, float low, float high, std::uint32_t seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> exponent(std::log2(low), std::log2(high));
    float last_value = low, last_rounded = A::load(low);
    for (int i = 0; i < 20000; ++i) {
        const float value = std::exp2(exponent(random));
        const float rounded = A::load(value);
        ASSERT_EQ(A::load(rounded), rounded) << value;
        ASSERT_EQ(A::load(-value), -rounded) << value;
        ASSERT_LT(std::fabs(rounded - value), std::ldexp(value, -fraction_bits)) << value;
        ASSERT_FALSE(value < last_value && rounded > last_rounded) << value;
        last_value = value;
        last_rounded = rounded;
    }
}

TEST(Precision, RoundingIsMonotoneAndIdempotent) {
    check_rounding<Narrow24>(16, 0x1p-60f, 0x1p60f, 1);
    check_rounding<Narrow16>(10, 0x1p-13f, 0x1p15f, 2);
}

// A longer computation comes nearer to the binary32 result with every format.
TEST(Precision, WiderIsNearer) {
    const std::string code =
        "mul_pp r0, r0, r1\nadd_pp r0, r0, r2\nnrm_pp r1.xyz, r0\ndp3_pp r0, r1, r2\nmad_pp r0, "
        "r0, r0, r1.y\n";
    const std::vector<Vector> constants = {
        {0.3f, 0.7f, 0.2f, 1}, {0.9f, 0.11f, 0.35f, 1}, {0.6f, 0.13f, 0.77f, 1}, {0, 0, 0, 0}};
    const auto error = [&](Arithmetic arithmetic) {
        const float exact = r0_after(code, constants, Arithmetic::Fp32)[0];
        return std::fabs(r0_after(code, constants, arithmetic)[0] - exact);
    };
    EXPECT_GT(error(Arithmetic::Fp24), 0);
    EXPECT_LT(error(Arithmetic::Fp24), 1e-4f);
    EXPECT_GT(error(Arithmetic::Fp16Partial), error(Arithmetic::Fp24));
    EXPECT_LT(error(Arithmetic::Fp16Partial), 1e-2f);
}

TEST(Precision, PartialPrecisionIsForMarkedInstructionsOnly) {
    const std::vector<Vector> constants = {{1, 1, 1, 1}, {0x1p-12f, 0, 0, 0}, {}, {}};
    EXPECT_EQ(r0_after("add r0, r0, r1", constants, Arithmetic::Fp16Partial)[0], 1 + 0x1p-12f);
    EXPECT_EQ(r0_after("add_pp r0, r0, r1", constants, Arithmetic::Fp16Partial)[0], 1);
    EXPECT_EQ(r0_after("add_pp r0, r0, r1", constants, Arithmetic::Fp32)[0], 1 + 0x1p-12f);
}

}  // namespace
}  // namespace intaglio::d3d9

// The reconstructed surface at points, against the definition and at the places where conventions
// show.
#include "src/reference/height_field.h"

#include "tests/unit/reference/witness.h"

namespace intaglio::reference {
namespace {

TEST(HeightAt, TexelCentresAreTheTexels) {
    HeightField field{4, 2, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}};
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp}) {
        for (const FilterWeights weights : {FilterWeights::Exact, FilterWeights::EightBit}) {
            field.wrap = wrap;
            field.weights = weights;
            for (int y = 0; y < 2; ++y) {
                for (int x = 0; x < 4; ++x) {
                    EXPECT_EQ(height_at(field, {(x + 0.5) / 4, (y + 0.5) / 2}),
                              field.heights[static_cast<std::size_t>(4 * y + x)]);
                }
            }
        }
    }
}

TEST(HeightAt, WrapsOrClampsBeyondTheBorder) {
    HeightField field{2, 1, {0, 1}};
    EXPECT_EQ(height_at(field, {0, 0.5}), 0.5);
    EXPECT_EQ(height_at(field, {1, 0.5}), 0.5);
    EXPECT_EQ(height_at(field, {-0.25, 7}), 1);
    EXPECT_EQ(height_at(field, {1e5 + 0.25, -1e5}), 0);
    field.wrap = Wrap::Clamp;
    EXPECT_EQ(height_at(field, {0, 0.5}), 0);
    EXPECT_EQ(height_at(field, {1, 0.5}), 1);
    EXPECT_EQ(height_at(field, {-1e300, 0.5}), 0);
    EXPECT_EQ(height_at(field, {1e300, -1e300}), 1);
}

TEST(HeightAt, EightBitWeightsAreRoundedToTheNearest) {
    const HeightField field{2, 1, {0, 1}, Wrap::Clamp, FilterWeights::EightBit};
    const auto at = [&](double texels) { return height_at(field, {(texels + 0.5) / 2, 0.5}); };
    EXPECT_EQ(at(0.499 / 256), 0);
    EXPECT_EQ(at(0.501 / 256), 1 / 256.0);
    EXPECT_EQ(at(100.4 / 256), 100 / 256.0);
    EXPECT_EQ(at(255.4 / 256), 255 / 256.0);
    EXPECT_EQ(at(255.6 / 256), 1);
}

TEST(HeightAt, AgreesWithTheDefinition) {
    witness::Random random(witness::seed());
    for (int i = 0; i < 2000; ++i) {
        HeightField field = witness::random_field(random, 9);
        for (int k = 0; k < 20; ++k) {
            const Vec2 uv{random.real(-3, 3), random.real(-3, 3)};
            field.weights = k % 2 ? FilterWeights::Exact : FilterWeights::EightBit;
            // 3 * 9 texels of 1e-16 each; random points are never that close to a step.
            ASSERT_NEAR(height_at(field, uv), witness::bilinear(field, uv.x, uv.y), 1e-13);
        }
    }
}

TEST(HeightAt, IsNotANumberWhereThereIsNoAnswer) {
    const HeightField field{2, 2, {0, 1, 0, 1}};
    EXPECT_TRUE(std::isnan(height_at(field, {NAN, 0})));
    EXPECT_TRUE(std::isnan(height_at(field, {0, INFINITY})));
    EXPECT_TRUE(std::isnan(height_at({}, {0, 0})));
    EXPECT_TRUE(std::isnan(height_at({2, 2, {0, 1, 0}}, {0, 0})));
    EXPECT_TRUE(std::isnan(height_at({-1, -1, {0}}, {0, 0})));
}

}  // namespace
}  // namespace intaglio::reference

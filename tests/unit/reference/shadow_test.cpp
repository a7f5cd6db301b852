// The exact shadow against closed forms, against sampling in small steps, and for 8-bit weights
// against the sorted list of all steps of the staircase.
#include "tests/unit/reference/witness.h"

namespace intaglio::reference {
namespace {

using witness::Case;
using witness::Random;

witness::Path path_to_light(const Case& c, double height) {
    return {c.uv, c.move(), height, 1, 1 - height};
}

TEST(Shadow, RandomLightsAgainstSmallSteps) {
    Random random(witness::seed());
    int dark = 0, bright = 0, undecided = 0;
    for (int i = 0; i < 30000; ++i) {
        const Case c = witness::random_case(random, 9, 85);
        const double height = std::min(1.0, witness::bilinear(c.field, c.uv.x, c.uv.y) +
                                                random.integer(0, 1) * random.real(0, 0.3));
        const bool is_lit = lit(c.field, c.uv, height, c.direction, c.scale);
        const witness::Path path = path_to_light(c, height);
        const double rounding = 1e-14 * c.extent();
        const int steps = 16 + static_cast<int>(64 * c.texels());
        for (int k = 0; k <= steps; ++k) {
            const double gap = path.gap(c.field, path.end * k / steps);
            if (gap <= contact_tolerance + rounding) continue;
            ASSERT_FALSE(is_lit) << "a sample is " << gap << " above the path from " << height
                                 << ": " << describe(c);
            break;
        }
        const double greatest = witness::greatest_gap(c.field, path);
        if (std::abs(greatest - contact_tolerance) <= rounding) {
            ++undecided;
            continue;
        }
        ASSERT_EQ(is_lit, greatest <= contact_tolerance)
            << greatest << " above the path from " << height << ": " << describe(c);
        ++(is_lit ? bright : dark);
    }
    EXPECT_GT(dark, 1000);
    EXPECT_GT(bright, 3000);
    EXPECT_LT(undecided, 30);
}

TEST(Shadow, EightBitWeightsAgainstEveryStepOfTheStaircase) {
    Random random(witness::seed());
    int dark = 0, bright = 0;
    for (int i = 0; i < 5000; ++i) {
        Case c = witness::random_case(random, 6, 80);
        c.field.weights = FilterWeights::EightBit;
        // Off the edges of the steps, where the side is a matter of rounding.
        c.uv = {c.uv.x + 1.23e-4, c.uv.y + 2.34e-4};
        const double height =
            witness::bilinear(c.field, c.uv.x, c.uv.y) + random.integer(0, 1) * random.real(0, 0.1);
        if (height >= 1) continue;
        const witness::Path path = path_to_light(c, height);
        const std::vector<double> limits = witness::stretches(c.field, path);
        double greatest = -1;
        for (std::size_t k = 0; k + 1 < limits.size(); ++k) {
            const double a = limits[k], middle = (a + limits[k + 1]) / 2;
            if (limits[k + 1] - a < 1e-12) continue;  // a corner, split by rounding
            greatest = std::max(greatest, path.gap(c.field, middle) + (middle - a));
        }
        if (std::abs(greatest - contact_tolerance) < 1e-12) continue;
        const bool is_lit = lit(c.field, c.uv, height, c.direction, c.scale);
        ASSERT_EQ(is_lit, greatest <= contact_tolerance)
            << greatest << " above the path from " << height << ": " << describe(c);
        ++(is_lit ? bright : dark);
    }
    EXPECT_GT(dark, 200);
    EXPECT_GT(bright, 200);
}

TEST(Shadow, LightAtTheEyeReachesEveryHit) {
    // The light's path is the view ray, backwards, and that was free up to the hit.
    Random random(witness::seed());
    for (int i = 0; i < 5000; ++i) {
        const Case c = witness::random_case(random, 9, 85);
        const Hit hit = first_hit(c.field, c.uv, c.direction, c.scale);
        ASSERT_TRUE(hit.found);
        ASSERT_TRUE(lit(c.field, hit.uv, hit.height, c.direction, c.scale)) << describe(c);
    }
}

TEST(Shadow, StepThrowsAShadowAsLongAsTheLightIsLow) {
    // A wall from 0 at texel 9 to 1 at texel 10; the light is behind it.  Its top shades the floor
    // up to x = 10 - d.
    HeightField step{32, 1, std::vector<double>(32, 0.0), Wrap::Clamp, FilterWeights::Exact};
    for (std::size_t x = 10; x < 32; ++x) step.heights[x] = 1;
    for (const double d : {1.5, 2.0, 3.7, 8.0}) {  // texels that the path moves while it rises by 1
        const auto floor_lit = [&](double x) {
            return lit(step, {(x + 0.5) / 32, 0.5}, 0, {d, 0, 32}, 1);
        };
        for (double x = 0; x < 9; x += 0.125) {
            EXPECT_EQ(floor_lit(x), x <= 10 - d + 1e-9) << "x " << x << ", d " << d;
        }
        EXPECT_TRUE(floor_lit(10 - d - 1e-6));
        EXPECT_FALSE(floor_lit(10 - d + 1e-6) && 10 - d < 9);
    }
}

TEST(Shadow, LightAlongASlopeTouchesItAndIsNoShadow) {
    // h = x / 8 over the whole map; a path that rises exactly so, a bit more steeply, and a bit
    // less.
    HeightField ramp{9, 1, {}, Wrap::Clamp, FilterWeights::Exact};
    for (int x = 0; x < 9; ++x) ramp.heights.push_back(x / 8.0);
    for (const double x : {0.0, 0.5, 1.0, 3.3, 6.0}) {
        const Vec2 uv{(x + 0.5) / 9, 0.5};
        EXPECT_TRUE(lit(ramp, uv, x / 8, {8, 0, 9}, 1)) << x;
        EXPECT_TRUE(lit(ramp, uv, x / 8, {7.99, 0, 9}, 1)) << x;
        EXPECT_FALSE(lit(ramp, uv, x / 8, {8.01, 0, 9}, 1)) << x;
        EXPECT_TRUE(lit(ramp, uv, x / 8, {-80, 0, 9}, 1)) << x;
    }
}

TEST(Shadow, FlatReliefIsLitFromEveryDirectionAboveIt) {
    for (const double h : {0.0, 0.25, 1.0}) {
        for (const FilterWeights weights : {FilterWeights::Exact, FilterWeights::EightBit}) {
            const HeightField flat{4, 3, std::vector<double>(12, h), Wrap::Repeat, weights};
            for (const Vec3 light :
                 {Vec3{0, 0, 1}, Vec3{1, 0, 1e-3}, Vec3{-0.4, 0.9, 0.01}, Vec3{1, 1, 1}}) {
                EXPECT_TRUE(lit(flat, {0.3, 0.7}, h, light, 0.1));
                EXPECT_TRUE(lit(flat, {1e5, -64}, h, light, 0.1));
                EXPECT_EQ(lit(flat, {0.3, 0.7}, h - 0.1, light, 0.1), false);
            }
        }
    }
}

TEST(Shadow, StraightUpIsFreeOnTheSurfaceAndNotInside) {
    Random random(witness::seed());
    for (int i = 0; i < 1000; ++i) {
        const Case c = witness::random_case(random, 9, 80);
        const double h = witness::bilinear(c.field, c.uv.x, c.uv.y);
        ASSERT_TRUE(lit(c.field, c.uv, h, {0, 0, 1}, c.scale));
        ASSERT_TRUE(lit(c.field, c.uv, h, c.direction, 0));
        ASSERT_FALSE(lit(c.field, c.uv, h - 1e-6, {0, 0, 1}, c.scale));
    }
}

TEST(Shadow, RiserOfTheStaircaseLooksToItsOwnSide) {
    // A point half way up a riser, where a view ray met it: free towards the lower step, buried
    // towards the higher.
    const HeightField steps{2, 1, {0, 1}, Wrap::Clamp, FilterWeights::EightBit};
    const Vec2 on_riser{(100.5 / 256 + 0.5) / 2, 0.5};
    for (const double rounding : {0.0, 1e-12, -1e-12}) {
        const Vec2 uv{on_riser.x + rounding, on_riser.y};
        EXPECT_TRUE(lit(steps, uv, 100.5 / 256, {-1, 0, 0.1}, 1));
        EXPECT_FALSE(lit(steps, uv, 100.5 / 256, {1, 0, 0.1}, 1));
    }
}

TEST(Shadow, ToleranceLeavesOutWhatIsLower) {
    HeightField bump{8, 1, std::vector<double>(8, 0.5)};
    bump.heights[4] = 0.6;
    // At texel 4, two texels away, the path has risen by 0.05.
    const Vec3 light{2 / 0.05, 0, 8};
    EXPECT_FALSE(lit(bump, {2.5 / 8, 0}, 0.5, light, 1));
    EXPECT_FALSE(lit(bump, {2.5 / 8, 0}, 0.5, light, 1, 0.049));
    EXPECT_TRUE(lit(bump, {2.5 / 8, 0}, 0.5, light, 1, 0.051));
}

TEST(Shadow, UnusableInputIsNotLit) {
    const HeightField field{2, 2, {0, 0, 0, 0}};
    for (const Vec3 light :
         {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -1}, Vec3{NAN, 0, 1}, Vec3{0, 0, NAN},
          Vec3{INFINITY, 0, 1}, Vec3{0, 0, INFINITY}, Vec3{1, 0, 1e-300}}) {
        EXPECT_FALSE(lit(field, {0.5, 0.5}, 0.5, light, 0.1));
    }
    EXPECT_FALSE(lit(field, {NAN, 0}, 0.5, {0, 0, 1}, 0.1));
    EXPECT_FALSE(lit(field, {0, 0}, NAN, {0, 0, 1}, 0.1));
    EXPECT_FALSE(lit(field, {0, 0}, 0.5, {0, 0, 1}, NAN));
    EXPECT_FALSE(lit(field, {0, 0}, 0.5, {0, 0, 1}, 0.1, NAN));
    EXPECT_FALSE(lit({}, {0, 0}, 0.5, {0, 0, 1}, 0.1));
    EXPECT_TRUE(lit(field, {0, 0}, 0.5, {0, 0, 1}, 0.1));
}

}  // namespace
}  // namespace intaglio::reference

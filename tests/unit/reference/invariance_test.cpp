// What must not matter to the first hit and the shadow: whole turns of uv, mirroring, swapped axes,
// the length of the direction, how a repeated map is cut.  Every relation holds for any map, so
// random ones are used.
#include "tests/unit/reference/witness.h"

namespace intaglio::reference {
namespace {

using witness::Case;
using witness::Random;

// Calls check(case, hit) for random cases, with exact and with 8-bit weights.
template <typename Check>
void for_random_cases(int count, Check&& check) {
    Random random(witness::seed());
    for (int i = 0; i < count; ++i) {
        Case c = witness::random_case(random, 9, 85);
        if (i % 4 == 0) c.field.weights = FilterWeights::EightBit;
        // Multiples of 2^-20: sums with 10^5 stay exact, and so the comparison is of the walk
        // alone.
        c.uv = {std::round(c.uv.x * 0x1p20) * 0x1p-20, std::round(c.uv.y * 0x1p20) * 0x1p-20};
        check(c, first_hit(c.field, c.uv, c.direction, c.scale));
        if (::testing::Test::HasFatalFailure()) return;
    }
}

// The transformed case rounds its positions differently, by some 1e-16 of the extent in texels.
// Where the ray passes a summit that closely either answer is right, so a hit may differ if the
// earlier is such a touch.
void expect_same_t(const Case& c, const Hit& hit, const Hit& other) {
    ASSERT_TRUE(hit.found && other.found) << describe(c);
    if (c.field.weights == FilterWeights::Exact && std::abs(hit.t - other.t) > 1e-7) {
        const double t = std::min(hit.t, other.t);
        const double behind = t + 1e-9;
        const Vec2 move = c.move();
        const double gap =
            witness::bilinear(c.field, c.uv.x - move.x * behind, c.uv.y - move.y * behind) -
            (1 - behind);
        ASSERT_LE(gap, 1e-14 * c.extent()) << describe(c);
        return;
    }
    // A near touch: the root moves by the square root of the rounding.
    ASSERT_NEAR(hit.t, other.t, 1e-7) << describe(c);
}

TEST(FirstHitInvariance, WholeTurnsOfTheCoordinate) {
    for_random_cases(2000, [](Case& c, const Hit&) {
        c.field.wrap = Wrap::Repeat;
        const Hit hit = first_hit(c.field, c.uv, c.direction, c.scale);
        for (const double turns : {1.0, 64.0, 1000.0, 1e5, -3.0}) {
            const Hit far =
                first_hit(c.field, {c.uv.x + turns, c.uv.y - turns}, c.direction, c.scale);
            ASSERT_EQ(far.t, hit.t);
            ASSERT_NEAR(far.uv.x - turns, hit.uv.x, 1e-16 * 2e5);
            ASSERT_NEAR(far.uv.y + turns, hit.uv.y, 1e-16 * 2e5);
        }
    });
}

TEST(FirstHitInvariance, FarCoordinatesKeepTheirFraction) {
    Random random(witness::seed());
    for (int i = 0; i < 2000; ++i) {
        Case c = witness::random_case(random, 9, 85);
        c.field.wrap = Wrap::Repeat;
        const Vec2 far{random.real(1e5, 1e5 + 1), random.real(-65, -64)};
        const Vec2 near{far.x - 1e5, far.y + 65};  // exact
        ASSERT_EQ(first_hit(c.field, far, c.direction, c.scale).t,
                  first_hit(c.field, near, c.direction, c.scale).t);
        ASSERT_EQ(height_at(c.field, far), height_at(c.field, near));
        // So far out there are no fractions left.
        ASSERT_EQ(first_hit(c.field, {1e300, -1e17}, c.direction, c.scale).t,
                  first_hit(c.field, {0, 0}, c.direction, c.scale).t);
    }
}

TEST(FirstHitInvariance, LengthOfTheView) {
    for_random_cases(2000, [](Case& c, const Hit& hit) {
        for (const double k :
             {0.25, 1024.0}) {  // powers of two: the quotients are the same numbers
            const Vec3 view{c.direction.x * k, c.direction.y * k, c.direction.z * k};
            ASSERT_EQ(first_hit(c.field, c.uv, view, c.scale).t, hit.t);
        }
        const Vec3 view{c.direction.x * 0.3, c.direction.y * 0.3, c.direction.z * 0.3};
        if (c.field.weights == FilterWeights::Exact) {
            expect_same_t(c, hit, first_hit(c.field, c.uv, view, c.scale));
        }
    });
}

TEST(FirstHitInvariance, ViewAndScaleTogether) {
    for_random_cases(2000, [](Case& c, const Hit& hit) {
        const Vec3 view{-c.direction.x, -c.direction.y, c.direction.z};
        ASSERT_EQ(first_hit(c.field, c.uv, view, -c.scale).t, hit.t);
        ASSERT_EQ(first_hit(c.field, c.uv, {c.direction.x / 2, c.direction.y / 2, c.direction.z},
                            c.scale * 2)
                      .t,
                  hit.t);
    });
}

TEST(FirstHitInvariance, SwappedAxes) {
    for_random_cases(2000, [](Case& c, const Hit& hit) {
        HeightField swapped = c.field;
        std::swap(swapped.width, swapped.height);
        for (int y = 0; y < c.field.height; ++y) {
            for (int x = 0; x < c.field.width; ++x) {
                swapped.heights[static_cast<std::size_t>(x * c.field.height + y)] =
                    witness::texel(c.field, x, y);
            }
        }
        const Hit other = first_hit(swapped, {c.uv.y, c.uv.x},
                                    {c.direction.y, c.direction.x, c.direction.z}, c.scale);
        expect_same_t(c, hit, other);
    });
}

TEST(FirstHitInvariance, MirroredMap) {
    for_random_cases(2000, [](Case& c, const Hit& hit) {
        // Mirroring turns "halves up" of the 8-bit weights around; only rays on a step's very edge
        // see it.
        if (c.field.weights == FilterWeights::EightBit) return;
        HeightField mirrored = c.field;
        for (int y = 0; y < c.field.height; ++y) {
            for (int x = 0; x < c.field.width; ++x) {
                mirrored
                    .heights[static_cast<std::size_t>(y * c.field.width + c.field.width - 1 - x)] =
                    witness::texel(c.field, x, y);
            }
        }
        const Hit other = first_hit(mirrored, {1 - c.uv.x, c.uv.y},
                                    {-c.direction.x, c.direction.y, c.direction.z}, c.scale);
        expect_same_t(c, hit, other);
    });
}

TEST(FirstHitInvariance, RepeatedMapCutTwiceAsLarge) {
    for_random_cases(2000, [](Case& c, const Hit&) {
        c.field.wrap = Wrap::Repeat;
        c.field.weights = FilterWeights::Exact;
        HeightField twice = c.field;
        twice.width *= 2;
        twice.heights.clear();
        for (int y = 0; y < c.field.height; ++y) {
            for (int x = 0; x < twice.width; ++x)
                twice.heights.push_back(witness::texel(c.field, x, y));
        }
        const Hit hit = first_hit(c.field, c.uv, c.direction, c.scale);
        const Hit other = first_hit(twice, {c.uv.x / 2, c.uv.y},
                                    {c.direction.x / 2, c.direction.y, c.direction.z}, c.scale);
        expect_same_t(c, hit, other);
    });
}

TEST(FirstHitInvariance, ClampIsRepeatWhileTheRayStaysInside) {
    int inside = 0;
    for_random_cases(4000, [&](Case& c, const Hit&) {
        const double border_x = 0.5 / c.field.width, border_y = 0.5 / c.field.height;
        c.uv.x = std::round((border_x + (1 - 2 * border_x) * (c.uv.x + 2) / 5) * 0x1p20) * 0x1p-20;
        c.uv.y = std::round((border_y + (1 - 2 * border_y) * (c.uv.y + 2) / 5) * 0x1p20) * 0x1p-20;
        c.field.wrap = Wrap::Repeat;
        const Hit repeated = first_hit(c.field, c.uv, c.direction, c.scale);
        const auto is_inside = [&](Vec2 uv) {
            return uv.x >= border_x && uv.x <= 1 - border_x && uv.y >= border_y &&
                   uv.y <= 1 - border_y;
        };
        if (!is_inside(c.uv) || !is_inside(repeated.uv)) return;
        ++inside;
        c.field.wrap = Wrap::Clamp;
        ASSERT_EQ(first_hit(c.field, c.uv, c.direction, c.scale).t, repeated.t) << describe(c);
    });
    EXPECT_GT(inside, 500);
}

TEST(FirstHitInvariance, HigherReliefIsHitNoLater) {
    for_random_cases(2000, [](Case& c, const Hit& hit) {
        for (double& h : c.field.heights) h = 0.5 + 0.5 * h;
        // Rounding of a position where the relief did not change (h = 1).
        ASSERT_LE(first_hit(c.field, c.uv, c.direction, c.scale).t, hit.t + 1e-15) << describe(c);
    });
}

}  // namespace
}  // namespace intaglio::reference

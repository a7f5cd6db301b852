// The first hit against closed forms, against sampling in very small steps, and for 8-bit weights
// against the sorted list of all steps of the staircase.
#include "tests/unit/reference/witness.h"

namespace intaglio::reference {
namespace {

using witness::Case;
using witness::Random;

witness::Path ray_of(const Case& c, double end) {
    return {c.uv, {-c.move().x, -c.move().y}, 1, -1, end};
}

// A hit lies on the ray and on the surface, and neither a sample before it nor a summit of a cell
// is above the ray.
void expect_first(const Case& c, const Hit& hit, double samples_per_texel) {
    // |f| <= slope * rounding of the position; no slope is above 1 per texel and axis.  The witness
    // rounds as much.
    const double rounding = 1e-15 * c.extent();
    const Vec2 move = c.move();
    ASSERT_TRUE(hit.found) << describe(c);
    ASSERT_GE(hit.t, 0);
    ASSERT_LE(hit.t, 1);
    ASSERT_EQ(hit.height, 1 - hit.t);
    ASSERT_NEAR(hit.uv.x, c.uv.x - move.x * hit.t, 1e-15 * c.extent());
    ASSERT_NEAR(hit.uv.y, c.uv.y - move.y * hit.t, 1e-15 * c.extent());
    const double gap = witness::bilinear(c.field, hit.uv.x, hit.uv.y) - hit.height;
    ASSERT_GE(gap, -rounding) << describe(c);
    if (hit.t > 0) {
        ASSERT_LE(gap, rounding) << describe(c);
    }

    const int steps = 16 + static_cast<int>(samples_per_texel * c.texels());
    const witness::Path ray = ray_of(c, hit.t);
    for (int k = 0; k < steps; ++k) {
        const double t = static_cast<double>(k) / steps;
        if (t >= hit.t) break;
        ASSERT_LE(ray.gap(c.field, t), rounding)
            << "the sample at " << t << " is above the ray, the hit is at " << hit.t << ": "
            << describe(c);
    }
    ASSERT_LE(witness::greatest_gap(c.field, ray), rounding + std::max(gap, 0.0)) << describe(c);
}

TEST(FirstHit, RandomRaysAgainstSmallSteps) {
    Random random(witness::seed());
    for (int i = 0; i < 50000; ++i) {
        const Case c = witness::random_case(random, 9, 88);
        expect_first(c, first_hit(c.field, c.uv, c.direction, c.scale), 64);
        if (HasFatalFailure()) return;
    }
}

TEST(FirstHit, GrazingRaysAgainstSmallSteps) {
    Random random(witness::seed());
    for (int i = 0; i < 200; ++i) {
        Case c = witness::random_case(random, 40, 88);
        const double azimuth = random.real(0, 2 * witness::pi), angle = 89.9 * witness::pi / 180;
        c.direction = {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
                       std::cos(angle)};
        expect_first(c, first_hit(c.field, c.uv, c.direction, c.scale), 24);
        if (HasFatalFailure()) return;
    }
}

TEST(FirstHit, ThinMapsAgainstSmallSteps) {
    Random random(witness::seed());
    for (int i = 0; i < 3000; ++i) {
        Case c = witness::random_case(random, 9, 85);
        const int longer = random.integer(1, 64);
        c.field.width = i % 2 ? 1 : longer;
        c.field.height = i % 2 ? longer : 1;
        c.field.heights.resize(static_cast<std::size_t>(longer));
        for (double& h : c.field.heights) h = random.real(0, 1);
        expect_first(c, first_hit(c.field, c.uv, c.direction, c.scale), 64);
        if (HasFatalFailure()) return;
    }
}

TEST(FirstHit, ThinPeaksAgainstVerySmallSteps) {
    // Rays that pass a spike's flank within a hundredth of a texel: 4000 samples in each texel.
    Random random(witness::seed());
    for (int i = 0; i < 300; ++i) {
        Case c{{5, 5, std::vector<double>(25, 0.0)}, {}, {}, 0.2};
        c.field.heights[12] = random.real(0.5, 1);
        const double height = random.real(0.01, 1) * c.field.heights[12];
        const double beside = std::sqrt(random.real(0, 1));
        c.direction = {1, random.real(-1, 1), random.real(0.5, 1)};
        // Through the point beside the peak at which the flank has nearly this height.
        const Vec2 move = c.move();
        c.uv = {0.5 + move.x * (1 - height),
                0.5 + beside * (1 - height / c.field.heights[12]) / 5 + move.y * (1 - height)};
        expect_first(c, first_hit(c.field, c.uv, c.direction, c.scale), 4000);
        if (HasFatalFailure()) return;
    }
}

// Whether rounding decides on which side of a corner between four steps of the staircase a ray
// passes.
bool is_on_corner_of_steps(const HeightField& field, Vec2 uv) {
    const auto is_on_edge = [](double texels) {
        const double x = texels * 256 + 0.5;
        return std::abs(x - std::round(x)) < 1e-9;
    };
    return is_on_edge(uv.x * field.width - 0.5) && is_on_edge(uv.y * field.height - 0.5);
}

TEST(FirstHit, EightBitWeightsAgainstEveryStepOfTheStaircase) {
    Random random(witness::seed());
    int undecided = 0;
    for (int i = 0; i < 3000; ++i) {
        Case c = witness::random_case(random, 6, 80);
        c.field.weights = FilterWeights::EightBit;
        const witness::Path ray = ray_of(c, 1);
        const std::vector<double> limits = witness::stretches(c.field, ray);
        double expected = 2, left = 2;  // contact with a step, and where the ray leaves that step
        for (std::size_t k = 0; k + 1 < limits.size() && expected > 1; ++k) {
            const double a = limits[k], b = limits[k + 1], middle = (a + b) / 2;
            if (b - a < 1e-12) continue;  // a corner, split by rounding
            const double h = ray.gap(c.field, middle) + (1 - middle);
            if (h < 1 - b) continue;
            expected = std::max(a, 1 - h);
            left = b;
        }
        const Hit hit = first_hit(c.field, c.uv, c.direction, c.scale);
        ASSERT_TRUE(hit.found) << describe(c);
        ASSERT_EQ(hit.height, 1 - hit.t);
        // Limits are off by the rounding of a position, divided by how many texels a t of 1 spans.
        if (std::abs(hit.t - expected) <= 1e-12) continue;
        // Rounding decides where the ray just touches a step: at a corner, or where it leaves it.
        const bool touches =
            hit.t < expected ? is_on_corner_of_steps(c.field, hit.uv) : left - expected <= 1e-12;
        ASSERT_TRUE(touches) << "expected " << expected << ", found " << hit.t << ": "
                             << describe(c);
        ++undecided;
    }
    EXPECT_LT(undecided, 10);
}

TEST(FirstHit, EightBitCornersThatTheRayOnlyTouchesDoNotCount) {
    // Exactly along the diagonal of h = x (1 - y), through the corners of the steps.  The steps
    // beside it reach 128 * 129 / 65536 = 0.252 where those on it reach 0.25; the ray passes at
    // 0.251.
    const double d = 64, corner = 127.5 / 256, start = corner - (1 - 257.0 / 1024) * d;
    for (const std::vector<double>& heights :
         {std::vector<double>{0, 1, 0, 0}, std::vector<double>{0, 0, 1, 0}}) {
        const HeightField field{2, 2, heights, Wrap::Clamp, FilterWeights::EightBit};
        const Hit hit = first_hit(field, {(start + 0.5) / 2, (start + 0.5) / 2}, {-d, -d, 2}, 1);
        EXPECT_TRUE(hit.found);
        EXPECT_EQ(hit.t, 1);
    }
}

TEST(FirstHit, EightBitWeightsStayCloseToExactOnes) {
    // The staircase is within 1/256 of the surface here, and the ray falls by 1 over a flat enough
    // map.
    Random random(witness::seed());
    for (int i = 0; i < 2000; ++i) {
        Case c = witness::random_case(random, 8, 0);
        const double exact = first_hit(c.field, c.uv, {0, 0, 1}, c.scale).t;
        c.field.weights = FilterWeights::EightBit;
        ASSERT_NEAR(first_hit(c.field, c.uv, {0, 0, 1}, c.scale).t, exact, 1.01 / 256)
            << describe(c);
    }
}

TEST(FirstHit, PlaneIsHitWhereTheRayHasItsHeight) {
    Random random(witness::seed());
    for (int i = 0; i < 1000; ++i) {
        Case c = witness::random_case(random, 9, 89.9);
        const double h = i < 5 ? i / 4.0 : random.real(0, 1);
        c.field.heights.assign(c.field.heights.size(), h);
        for (const FilterWeights weights : {FilterWeights::Exact, FilterWeights::EightBit}) {
            c.field.weights = weights;
            const Hit hit = first_hit(c.field, c.uv, c.direction, c.scale);
            ASSERT_TRUE(hit.found);
            ASSERT_NEAR(hit.t, 1 - h, 4e-16) << describe(c);
        }
    }
}

TEST(FirstHit, RampAndStepFacesAreHitWhereTwoLinesCross) {
    // The face between texels 1 and 2 rises from 0 to 1: h = x - 1 in texels.  From x0 before it
    // with step d per t: x0 + d t - 1 = 1 - t.
    const HeightField step{4, 1, {0, 0, 1, 1}, Wrap::Clamp, FilterWeights::Exact};
    Random random(witness::seed());
    for (int i = 0; i < 1000; ++i) {
        const double x0 = random.real(0, 1.9), d = std::pow(10.0, random.real(-1, 4));
        const double t = (2 - x0) / (1 + d);
        const double x = x0 + d * t;
        const Hit hit = first_hit(step, {(x0 + 0.5) / 4, 0.3}, {-d, 0, 4}, 1);
        ASSERT_TRUE(hit.found);
        if (x < 1) {
            ASSERT_NEAR(hit.t, 1, 1e-15);  // the floor is reached first
        } else {
            ASSERT_NEAR(hit.t, t, 1e-15 * (1 + t * d));
            ASSERT_NEAR(hit.uv.x, (x + 0.5) / 4, 1e-15 * (4 + d));
            ASSERT_EQ(hit.uv.y, 0.3);
        }
    }
}

TEST(FirstHit, PyramidIsHitAlongAxisAndDiagonal) {
    // A peak of 1 amid zeros: 1 - |x| along the axis through it, (1 - |x|)^2 along the diagonal.
    const HeightField peak{3, 3, {0, 0, 0, 0, 1, 0, 0, 0, 0}, Wrap::Clamp, FilterWeights::Exact};
    for (const double sign_x : {-1.0, 1.0}) {
        for (const double sign_y : {-1.0, 1.0}) {
            for (const double start : {1.0, 0.75, 0.5, 0.25, 0.1, 1e-3, 1e-9}) {
                for (const double d : {0.25, 0.5, 1.0, 3.0, 100.0}) {
                    // Heading for the peak from `start` texels away; 1 - start + d t = 1 - t.
                    const double axis = start / (1 + d);
                    const Hit on_axis =
                        first_hit(peak, {0.5 - sign_x * start / 3, 0.5}, {-sign_x * d, 0, 3}, 1);
                    EXPECT_NEAR(on_axis.t, axis, 1e-14 * (1 + d));
                    // (q + d t)^2 = 1 - t with q = 1 - start: the root of d^2 t^2 + (2 q d + 1) t +
                    // q^2 - 1.
                    const double q = 1 - start, b = 2 * q * d + 1, c = (q - 1) * (q + 1);
                    const double diagonal = -2 * c / (b + std::sqrt(b * b - 4 * d * d * c));
                    const Hit across =
                        first_hit(peak, {0.5 - sign_x * start / 3, 0.5 - sign_y * start / 3},
                                  {-sign_x * d, -sign_y * d, 3}, 1);
                    EXPECT_NEAR(across.t, diagonal, 1e-14 * (1 + d)) << start << " " << d;
                }
            }
        }
    }
}

TEST(FirstHit, PeakJustAboveTheRayIsHitAndJustBelowIsPassed) {
    // A saddle, h = x + y - 2 x y times k, met along its rising and falling diagonal: k 2 f (1 - f)
    // has its summit k / 2 inside the cell. The ray 1 - t is as high as the summit at t = 1 - k /
    // 2; it is steeper there, so it touches a bit before.
    for (const double excess : {1e-11, -1e-11}) {
        const double k = 0.8, d = 4;
        // g(f) = 2 k f (1 - f) - (height0 - (f / d)); touch: discriminant zero.
        const double b = 2 * k + 1 / d;
        const double touching = b * b / (8 * k);
        const double height0 = touching - excess;  // of the ray over the corner f = 0
        const HeightField saddle{2, 2, {0, k, k, 0}, Wrap::Clamp, FilterWeights::Exact};
        const double start = -(1 - height0) * d;  // where the ray has height 1
        const Hit hit = first_hit(saddle, {(start + 0.5) / 2, (start + 0.5) / 2}, {-d, -d, 2}, 1);
        ASSERT_TRUE(hit.found);
        const double f = start + d * hit.t;
        if (excess > 0) {
            EXPECT_NEAR(f, b / (4 * k) - std::sqrt(excess / (2 * k)), 1e-8);
        } else {
            EXPECT_GT(f, 1);
        }
    }
}

TEST(FirstHit, WallOfOneTexelIsNeverPassed) {
    HeightField wall{64, 1, std::vector<double>(64, 0.0)};
    wall.heights[40] = 1;
    for (const double d : {1.0, 7.0, 39.0, 41.0, 1000.0, 1e6}) {
        const Hit hit = first_hit(wall, {10.5 / 64, 0}, {-d, 0, 64}, 1);
        ASSERT_TRUE(hit.found);
        // x = 10 + d t meets h = x - 39 at 1 - t, unless the floor comes first.
        const double t = std::min(1.0, 30 / (1 + d));
        EXPECT_NEAR(hit.t, t, 1e-14 * (64 + d) / d);
    }
}

TEST(FirstHit, StraightDownAndScaleZeroGiveTheHeightBelow) {
    Random random(witness::seed());
    for (int i = 0; i < 2000; ++i) {
        Case c = witness::random_case(random, 9, 80);
        const double h = height_at(c.field, c.uv);
        for (const Hit& hit : {first_hit(c.field, c.uv, {0, 0, 0.7}, c.scale),
                               first_hit(c.field, c.uv, c.direction, 0),
                               first_hit(c.field, c.uv, {1e-320, -1e-320, 1}, c.scale)}) {
            ASSERT_TRUE(hit.found);
            ASSERT_NEAR(hit.t, 1 - h, 4e-16) << describe(c);
            ASSERT_NEAR(hit.uv.x, c.uv.x, 1e-300);
            ASSERT_NEAR(hit.uv.y, c.uv.y, 1e-300);
        }
    }
}

TEST(FirstHit, StartsAtOnceWhereTheReliefReachesThePolygon) {
    HeightField field{3, 3, std::vector<double>(9, 1.0)};
    const Hit hit = first_hit(field, {0.3, 0.6}, {0.9, 0.1, 0.3}, 0.1);
    EXPECT_TRUE(hit.found);
    EXPECT_EQ(hit.t, 0);
    EXPECT_EQ(hit.uv.x, 0.3);
    EXPECT_EQ(hit.uv.y, 0.6);
    field.heights.assign(9, 1.5);
    EXPECT_EQ(first_hit(field, {0.3, 0.6}, {0.9, 0.1, 0.3}, 0.1).t, 0);
    field.heights.assign(9, -0.5);
    EXPECT_FALSE(first_hit(field, {0.3, 0.6}, {0.9, 0.1, 0.3}, 0.1).found);
}

TEST(FirstHit, UnusableInputIsNotFoundAndLeavesTheCoordinate) {
    const HeightField field{2, 2, {0, 1, 0, 1}};
    const double inf = INFINITY;
    const auto expect_none = [](const Hit& hit, Vec2 uv) {
        EXPECT_FALSE(hit.found);
        EXPECT_EQ(hit.t, 0);
        EXPECT_TRUE(hit.uv.x == uv.x || (std::isnan(hit.uv.x) && std::isnan(uv.x)));
        EXPECT_EQ(hit.uv.y, uv.y);
    };
    const Vec2 uv{0.25, 0.75};
    for (const Vec3 view : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.1, 0.1, -1}, Vec3{NAN, 0, 1},
                            Vec3{0, NAN, 1}, Vec3{0, 0, NAN}, Vec3{inf, 0, 1}, Vec3{0, -inf, 1},
                            Vec3{0, 0, inf}, Vec3{1, 1, 1e-300}, Vec3{1, 0, 5e-324}}) {
        expect_none(first_hit(field, uv, view, 0.1), uv);
        HeightField steps = field;
        steps.weights = FilterWeights::EightBit;
        expect_none(first_hit(steps, uv, view, 0.1), uv);
    }
    expect_none(first_hit(field, uv, {0.1, 0, 1}, NAN), uv);
    expect_none(first_hit(field, uv, {0.1, 0, 1}, inf), uv);
    expect_none(first_hit(field, {NAN, 0}, {0.1, 0, 1}, 0.1), {NAN, 0});
    expect_none(first_hit(field, {inf, 0}, {0.1, 0, 1}, 0.1), {inf, 0});
    expect_none(first_hit({}, uv, {0, 0, 1}, 0.1), uv);
    expect_none(first_hit({3, 2, {1, 1}}, uv, {0, 0, 1}, 0.1), uv);
}

TEST(FirstHit, HeightsThatAreNotNumbersAreNoSurface) {
    HeightField field{4, 1, {0, NAN, 1, 1}, Wrap::Clamp, FilterWeights::Exact};
    const Hit hit = first_hit(field, {0.125, 0.5}, {-3, 0, 1}, 1);
    EXPECT_TRUE(hit.found);
    EXPECT_EQ(hit.t, 1.0 / 6);  // texel 2 is two texels away, 12 texels per t
    field.heights.assign(4, NAN);
    EXPECT_FALSE(first_hit(field, {0.125, 0.5}, {-3, 0, 1}, 1).found);
}

}  // namespace
}  // namespace intaglio::reference

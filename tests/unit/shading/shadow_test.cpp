// Shadows against the exact reference, point by point on the surface, and the relations that hold
// whatever the map.
#include "tests/unit/shading/pixel.h"

#include <algorithm>

namespace intaglio::templates::testing {
namespace {

using reference::height_at;
using reference::lit;

const std::vector<std::string> makers = {"bricks", "smooth", "spikes", "fur", "text"};
// Those that throw shadows; `none` and `fur_depth` follow no light.
const std::vector<std::string> casting = {"march", "soft", "occlusion_profile", "exact"};

Vec3 random_light(Random& random, double lowest) {
    // A third on the axes and diagonals: rays through texel lines and corners.
    const double azimuth = random.chance(0.33) ? 45.0 * random.integer(0, 7) : random.real(0, 360);
    return direction(random.real(lowest, 90), azimuth);
}

HeightField random_field(Random& random, int width, int height) {
    HeightField field;
    field.width = width;
    field.height = height;
    for (int i = 0; i < width * height; ++i)
        field.heights.push_back(static_cast<float>(random.real(0, 1)));
    return field;
}

// What binary32 may make of a height on the way to the light: the coordinate is good to half an ulp
// of its largest value, which the map's size turns into texels, and a texel is worth at most the
// whole range of heights on a map of noise.  4 ulps of that, and 1e-5 for the quadratic's own sums.
double rounding_of(const HeightField& field, Vec3 light, double scale) {
    const double travel = std::max(std::abs(light.x), std::abs(light.y)) / light.z * scale + 1;
    return 4 * travel * std::max(field.width, field.height) * 0x1p-24 + 1e-5;
}

struct Agreement {
    int asked = 0, undecided = 0, shaded = 0;
};

// Points where the reference says the same a rounding below and above the bias.
void expect_exact(Random& random, const HeightField& field, double lowest, double largest_scale,
                  int points, Agreement& agreement) {
    constexpr double bias = 1.0 / 4096;
    const Visibility leaping("exact", field, {{"shadow_cells", "4096"}});
    const Visibility walking("exact", field, {{"shadow_cells", "4096"}, {"shadow_leaps", "0"}});
    for (int i = 0; i < points; ++i) {
        const Visibility& exact = i % 2 == 0 ? leaping : walking;
        Draw draw{field};
        // As the shader gets them.
        draw.uv = {static_cast<float>(random.real(0, 1)), static_cast<float>(random.real(0, 1))};
        draw.to_light = random_light(random, lowest);
        draw.scale = static_cast<float>(random.real(0.01, largest_scale));
        const double height = height_at(field, draw.uv);
        const double slack = rounding_of(field, draw.to_light, draw.scale);
        const bool least =
            lit(field, draw.uv, height, draw.to_light, draw.scale, std::max(bias - slack, 1e-9));
        const bool most = lit(field, draw.uv, height, draw.to_light, draw.scale, bias + slack);
        ++agreement.asked;
        agreement.shaded += !least;
        if (least != most) {
            ++agreement.undecided;
            continue;
        }
        EXPECT_EQ(exact(draw, height), least ? 1 : 0)
            << "uv " << draw.uv.x << " " << draw.uv.y << ", light " << draw.to_light.x << " "
            << draw.to_light.y << " " << draw.to_light.z << ", scale " << draw.scale << ", map "
            << field.width << " x " << field.height;
    }
}

TEST(ExactShadow, AgreesWithTheReferenceOnEveryMap) {
    Random random(reference::witness::seed());
    Agreement agreement;
    for (const std::string& maker : makers)
        expect_exact(random, made_field(maker, 64, 32), 1, 0.5, 500, agreement);
    EXPECT_GT(agreement.shaded, agreement.asked / 4) << "the scene has shadows";
    EXPECT_LT(agreement.undecided, agreement.asked / 20);
}

TEST(ExactShadow, AgreesWithTheReferenceOnNoise) {
    Random random(reference::witness::seed() + 1);
    Agreement agreement;
    for (int map = 0; map < 40; ++map) {
        const int sizes[] = {1, 2, 3, 8, 16, 31};
        expect_exact(random,
                     random_field(random, sizes[random.integer(0, 5)], sizes[random.integer(0, 5)]),
                     3, 0.3, 100, agreement);
    }
    EXPECT_GT(agreement.shaded, agreement.asked / 10) << "maps of one texel throw none";
    EXPECT_LT(agreement.undecided, agreement.asked / 20);
}

TEST(ExactShadow, FindsAWallOneTexelThin) {
    // The wall stands in one column; a march of eight samples steps over it from most points.
    const HeightField wall = field_of(
        64, 4, [](double u, double) { return std::abs(u - 32.5 / 64) < 0.25 / 64 ? 1.0 : 0.0; });
    const Visibility exact("exact", wall), profile("occlusion_profile", wall);
    Draw draw{wall};
    draw.to_light = direction(20, 0);
    draw.scale = 0.1;  // the light ray runs 17.6 texels
    int missed = 0;
    for (int x = 17; x < 31; ++x) {
        draw.uv = {(x + 0.5) / 64, 0.5};
        EXPECT_EQ(exact(draw, 0), 0) << x;
        missed += profile(draw, 0) == 1;
    }
    EXPECT_GT(missed, 3) << "samples 2 texels apart, a wall 2 texels wide at its foot";
    for (int x = 0; x < 14; ++x) {
        draw.uv = {(x + 0.5) / 64, 0.5};
        EXPECT_EQ(exact(draw, 0), 1) << "beyond the wall's reach: " << x;
    }
}

TEST(ExactShadow, BeyondItsCellsTheRayIsFree) {
    const HeightField wall = field_of(64, 1, [](double u, double) { return u > 0.5 ? 1.0 : 0.0; });
    Draw draw{wall};
    draw.uv = {0.25, 0.5};
    draw.to_light = direction(10, 0);
    draw.scale = 0.1;
    EXPECT_EQ(Visibility("exact", wall, {{"shadow_cells", "64"}, {"shadow_leaps", "0"}})(draw, 0), 0);
    EXPECT_EQ(Visibility("exact", wall, {{"shadow_cells", "4"}, {"shadow_leaps", "0"}})(draw, 0), 1);
}

TEST(ExactShadow, APointReportedBelowTheSurfaceIsNotInItsOwnShadow) {
    const HeightField flat = field_of(16, 16, [](double, double) { return 0.5; });
    Draw draw{flat};
    draw.to_light = direction(30, 20);
    EXPECT_EQ(Visibility("exact", flat)(draw, 0.45), 1);
    EXPECT_EQ(Visibility("exact", flat)(draw, 0.55), 1) << "nor one above it";
}

TEST(ExactShadow, WithoutMapsReadsTwiceForEachTexelLine) {
    const HeightField flat = field_of(64, 64, [](double, double) { return 0.0; });
    const Visibility exact("exact", flat, {{"shadow_leaps", "0"}});
    Draw draw{flat};
    draw.uv = {0.1, 0.1};
    draw.to_light = direction(45, 0);
    for (double texels : {0.4, 3.0, 10.0}) {
        draw.scale = texels / 64;
        const long cells =
            std::lround(std::floor(0.1 * 64 - 0.5 + texels) - std::floor(0.1 * 64 - 0.5)) + 1;
        EXPECT_EQ(exact.run(draw, 0).texture_reads, 1 + 2 * cells) << texels;
    }
}

TEST(OcclusionProfile, ShadesOnlyWhatTheReferenceShades) {
    Random random(reference::witness::seed() + 2);
    int shaded = 0, wrong_with_many = 0, asked = 0;
    for (const std::string& maker : makers) {
        const HeightField field = made_field(maker, 64, 64);
        const Visibility few("occlusion_profile", field, {{"profile_bias", "0.0001"}});
        const Visibility many("occlusion_profile", field,
                              {{"profile_bias", "0.0001"}, {"shadow_taps", "256"}});
        for (int i = 0; i < 150; ++i) {
            Draw draw{field};
            draw.uv = {static_cast<float>(random.real(0, 1)),
                       static_cast<float>(random.real(0, 1))};
            draw.to_light = random_light(random, 10);
            draw.scale = 0.08;
            const double height = height_at(field, draw.uv);
            // A sample above the ray is a witness; the bias is ten times what rounding can do.
            const bool free = lit(field, draw.uv, height, draw.to_light, draw.scale);
            if (free) {
                EXPECT_EQ(few(draw, height), 1) << maker;
            }
            shaded += few(draw, height) == 0;
            wrong_with_many += (many(draw, height) == 1) != free;
            ++asked;
        }
    }
    EXPECT_GT(shaded, asked / 10);
    EXPECT_LT(wrong_with_many, asked / 20) << "256 taps miss next to nothing at 64 texels";
}

TEST(OcclusionProfile, MoreTapsMissLess) {
    const HeightField spikes = made_field("spikes", 64, 64);
    Random random(reference::witness::seed() + 3);
    std::vector<Draw> draws;
    for (int i = 0; i < 400; ++i) {
        Draw draw{spikes};
        draw.uv = {static_cast<float>(random.real(0, 1)), static_cast<float>(random.real(0, 1))};
        draw.to_light = random_light(random, 15);
        draws.push_back(draw);
    }
    int before = 1000, first = 0;
    for (const char* taps : {"2", "8", "32", "128"}) {
        const Visibility profile("occlusion_profile", spikes, {{"shadow_taps", taps}});
        int missed = 0;
        for (const Draw& draw : draws) {
            const double height = height_at(spikes, draw.uv);
            missed += profile(draw, height) == 1 &&
                      !lit(spikes, draw.uv, height, draw.to_light, draw.scale);
        }
        EXPECT_LE(missed, before) << taps;
        if (before == 1000) first = missed;
        before = missed;
    }
    EXPECT_LT(before, first / 4);
}

TEST(SoftShadow, IsTheFormulaOfItsSource) {
    // fShadow = max over taps of (h(uv + ray t) - h0 - t) * k * softening, visibility 1 - fShadow.
    const double rises[] = {0.88, 0.77, 0.66, 0.55, 0.44, 0.33, 0.22};
    const double weights[] = {1, 2, 4, 6, 8, 10, 12};
    const HeightField field = made_field("bricks", 64, 64);
    Random random(reference::witness::seed() + 4);
    for (int undivided : {0, 1}) {
        const Visibility soft("soft", field, {{"soft_undivided", std::to_string(undivided)}});
        for (int i = 0; i < 200; ++i) {
            Draw draw{field};
            draw.uv = {random.real(0, 1), random.real(0, 1)};
            draw.to_light = random_light(random, 5);
            draw.precision = ir::Precision::Double;
            const double along = draw.scale / (undivided ? 1 : draw.to_light.z);
            const double h0 = height_at(field, draw.uv);
            double shadow = 0;
            for (int tap = 0; tap < 7; ++tap) {
                const double t = rises[tap];
                const double h = height_at(field, {draw.uv.x + draw.to_light.x * along * t,
                                                   draw.uv.y + draw.to_light.y * along * t});
                shadow = std::max(shadow, (h - h0 - t) * weights[tap] * 0.58);
            }
            // The template's constants are floats.
            EXPECT_NEAR(soft(draw, h0), 1 - std::min(shadow, 1.0), 1e-5);
        }
    }
}

TEST(SoftShadow, ReadsEightTimes) {
    const HeightField field = made_field("bricks", 16, 16);
    EXPECT_EQ(Visibility("soft", field).run(Draw{field}, 0.5).texture_reads, 8);
}

TEST(SoftShadow, DarkensOnlyWhatTheReferenceShadesAndMoreTheStronger) {
    Random random(reference::witness::seed() + 5);
    int darkened = 0;
    for (const std::string& maker : makers) {
        const HeightField field = made_field(maker, 64, 64);
        std::vector<Visibility> soft;
        for (const char* softening : {"0", "0.25", "0.58", "2", "16"})
            soft.emplace_back("soft", field, Knobs{{"softening", softening}});
        for (int i = 0; i < 100; ++i) {
            Draw draw{field};
            draw.uv = {static_cast<float>(random.real(0, 1)),
                       static_cast<float>(random.real(0, 1))};
            draw.to_light = random_light(random, 10);
            const double height = height_at(field, draw.uv);
            double before = 1;
            for (const Visibility& stronger : soft) {
                const double now = stronger(draw, height);
                EXPECT_LE(now, before) << maker;
                EXPECT_GE(now, 0);
                before = now;
            }
            EXPECT_EQ(soft[0](draw, height), 1) << "no softening, no shadow";
            // 16 * 12 times the rounding of a height.
            if (lit(field, draw.uv, height, draw.to_light, draw.scale)) {
                EXPECT_GT(before, 1 - 1e-3) << maker;
            }
            darkened += before < 0.5;
        }
    }
    EXPECT_GT(darkened, 20);
}

TEST(SoftShadow, FallsAsWhatStandsInTheLightRises) {
    double before = 2;
    for (double wall : {0.0, 0.5, 0.6, 0.7, 0.8, 1.0}) {
        const HeightField field =
            field_of(64, 1, [&](double u, double) { return u > 0.5 ? wall : 0.0; });
        Draw draw{field};
        draw.uv = {0.46, 0.5};
        draw.to_light = direction(45, 0);
        draw.scale = 0.125;
        const double now = Visibility("soft", field)(draw, 0);
        EXPECT_TRUE(now < before || now == 0 || now == 1) << wall;
        before = now;
    }
    EXPECT_EQ(before, 0) << "a full wall near by throws a full shadow";
}

TEST(Shadows, LightStraightUpReachesEveryPointOfTheSurface) {
    Random random(reference::witness::seed() + 6);
    for (const std::string& shadow : casting)
        for (const std::string& maker : makers) {
            const HeightField field = made_field(maker, 32, 32);
            const Visibility visibility(shadow, field);
            for (int i = 0; i < 50; ++i) {
                Draw draw{field};
                draw.uv = {static_cast<float>(random.real(0, 1)),
                           static_cast<float>(random.real(0, 1))};
                EXPECT_EQ(visibility(draw, static_cast<float>(height_at(field, draw.uv))), 1)
                    << shadow << " on " << maker;
            }
        }
}

TEST(Shadows, FlatMapsShadeNothingAtAnyElevation) {
    for (const std::string& shadow : casting)
        for (double height : {0.0, 0.5, 1.0}) {
            const HeightField field = field_of(16, 8, [&](double, double) { return height; });
            const Visibility visibility(shadow, field);
            Draw draw{field};
            for (double elevation : {90.0, 60.0, 10.0, 1.0, 0.01})
                for (double azimuth : {0.0, 45.0, 90.0, 200.0})
                    for (double scale : {0.0, 0.08, 1.0}) {
                        draw.to_light = direction(elevation, azimuth);
                        draw.scale = scale;
                        EXPECT_EQ(visibility(draw, height), 1)
                            << shadow << ", height " << height << ", elevation " << elevation;
                    }
        }
}

TEST(Shadows, ALightAtOrBelowTheHorizonLightsNothing) {
    const HeightField field = made_field("bricks", 16, 16);
    for (const std::string& shadow : casting) {
        const Visibility visibility(shadow, field);
        for (const Vec3 light :
             {Vec3{1, 0, 0}, Vec3{0, 0, 0}, Vec3{0, 0, -1}, Vec3{0.6, 0, -0.8}}) {
            Draw draw{field};
            draw.to_light = light;
            EXPECT_EQ(visibility(draw, 1), 0) << shadow << " " << light.z;
        }
    }
}

TEST(Shadows, WithoutReliefThereIsNoShadow) {
    const HeightField field = made_field("spikes", 16, 16);
    // Scale 0: every point looks straight up its own column.
    for (const std::string& shadow : casting) {
        Draw draw{field};
        draw.to_light = direction(20, 77);
        draw.scale = 0;
        for (double u : {0.1, 0.37, 0.9}) {
            draw.uv = {u, 0.3};
            const double height = static_cast<float>(height_at(field, draw.uv)) + 1e-6;
            EXPECT_EQ(Visibility(shadow, field)(draw, height), 1) << shadow;
        }
    }
}

TEST(Shadows, AMirroredMapUnderAMirroredLightShadesTheSame) {
    Random random(reference::witness::seed() + 7);
    const HeightField field = made_field("text", 32, 32);
    HeightField mirrored = field;
    for (int y = 0; y < 32; ++y)
        std::reverse(mirrored.heights.begin() + y * 32, mirrored.heights.begin() + (y + 1) * 32);
    for (const std::string& shadow : casting) {
        const Visibility there(shadow, field), here(shadow, mirrored);
        int same = 0;
        for (int i = 0; i < 200; ++i) {
            Draw draw{field};
            // A power of two's fractions: mirrored without rounding.
            draw.uv = {random.integer(0, 4095) / 4096.0, random.integer(0, 4095) / 4096.0};
            draw.to_light = random_light(random, 10);
            const double height = height_at(field, draw.uv);
            Draw other{mirrored, {1 - draw.uv.x, draw.uv.y}};
            other.to_light = {-draw.to_light.x, draw.to_light.y, draw.to_light.z};
            same += std::abs(there(draw, height) - here(other, height)) < 1e-3;
        }
        // A sample that touches the ray may round to either side.
        EXPECT_GE(same, 198) << shadow;
    }
}

TEST(Shadows, AreFiniteWhateverTheyAreGiven) {
    const HeightField field = made_field("spikes", 8, 8);
    for (const auto& row : all_techniques().shadows) {
        const Visibility visibility(row.name, field);
        for (double u : {0.0, 1.0, -3.5, 64.0, 1000.0, 1e5})
            for (const Vec3 light : {Vec3{0, 0, 0}, Vec3{1e-20, 0, 1e-20}, Vec3{1, 0, 1e-9},
                                     Vec3{0, 1, 1e-30}, Vec3{1e5, 1e5, 1}, Vec3{-1, 0, -1}})
                for (double height : {0.0, 0.5, 1.0}) {
                    Draw draw{field, {u, -u}};
                    draw.to_light = light;
                    const double v = visibility(draw, height);
                    EXPECT_TRUE(v >= 0 && v <= 1) << row.name << " gives " << v;
                }
    }
}

}  // namespace
}  // namespace intaglio::templates::testing

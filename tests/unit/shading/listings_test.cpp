// The listings of the sources, transcribed line by line in double, against the techniques that come
// from them: equal within rounding where a listing is right, and how far off where it is not.  The
// finite differences and the smoothed normal are in normal_test.cpp, the depth in output_test.cpp,
// the phong map's offset in shading_test.cpp, parallax and its limited form in
// tests/unit/templates/offsets_test.cpp.
#include <algorithm>

#include "tests/unit/shading/pixel.h"

namespace intaglio::templates::testing {
namespace {

using reference::height_at;

struct Vec4 {
    double x, y, z, w;
};

double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec3 normalize(Vec3 v) {
    const double length = std::sqrt(dot(v, v));
    return {v.x / length, v.y / length, v.z / length};
}
double mix(double a, double b, double share) { return a * (1 - share) + b * share; }

// Of elevation z = sine, any azimuth.
Vec3 at_height(double z, double azimuth) {
    const double flat = std::sqrt(1 - z * z);
    return {flat * std::cos(azimuth), flat * std::sin(azimuth), z};
}

Vec3 random_unit(Random& random) { return at_height(random.real(-1, 1), random.real(0, 2 * pi)); }

double apart(const std::array<double, 4>& pixel, Vec2 uv) {
    return std::hypot(pixel[0] - uv.x, pixel[1] - uv.y);
}

// Both run in double; the generator's constants are floats.
constexpr double rounding = 1e-6;

// ---- Brawley and Tatarchuk, the chapter ----

// The vertex stage of parallax_occlusion and the pixel stage behind it, with the ray per vertex as
// the chapter has it.
class ChapterSurface {
  public:
    ChapterSurface(const HeightField& field, const std::string& bias)
        : field_(field),
          program_(recorded(bias)),
          vertex_(program_.vertex),
          pixel_(program_.pixel, field) {}

    std::array<double, 4> operator()(const std::map<std::string, Vector>& attributes,
                                     const std::map<std::string, std::vector<Vector>>& uniforms) {
        ir::Environment environment;
        for (const ir::Declaration& input : program_.vertex.inputs)
            environment.inputs.push_back(attributes.at(input.name));
        for (const ir::Uniform& uniform : program_.vertex.uniforms)
            environment.uniforms.push_back(uniforms.at(uniform.name));
        const ir::Evaluation done = vertex_.run(environment, ir::Precision::Double);
        std::map<std::string, Vector> interpolants;
        for (std::size_t i = 0; i < done.outputs.size(); ++i)
            interpolants[program_.vertex.outputs[i].name] = done.outputs[i];
        Draw draw{field_};
        draw.precision = ir::Precision::Double;
        draw.scale = uniforms.at("scale")[0][0];
        return pixel_(draw, interpolants).outputs[0];
    }

  private:
    static ir::Program recorded(const std::string& bias) {
        Result<ir::Program> program = dsl::record_surface(
            surface_named("parallax_occlusion,output=displaced",
                          {{"ray_per_vertex", "1"}, {"perspective_bias", bias}}),
            {"glsl_450", {}, false});
        EXPECT_TRUE(program.ok()) << to_string(program.error());
        return *program;
    }

    const HeightField& field_;
    ir::Program program_;
    ir::Evaluator vertex_;
    Judge pixel_;
};

TEST(Chapter, ItsVertexShaderHandsOnOurRay) {
    // On a flat map of height 0 the chapter's pixel shader answers vParallax, the whole of it.
    const HeightField floor = field_of(4, 4, [](double, double) { return 0; });
    Random random(reference::witness::seed());
    int turned = 0, asked = 0;
    for (const char* bias : {"1", "0.75", "0.25"}) {
        ChapterSurface ours(floor, bias);
        for (int i = 0; i < 60; ++i) {
            const Vec3 inNormal = random_unit(random);
            const Vec3 inTangent = normalize(cross(inNormal, random_unit(random)));
            const double side = random.chance(0.5) ? 1 : -1;
            Vec3 inBinormal = cross(inNormal, inTangent);
            inBinormal = {side * inBinormal.x, side * inBinormal.y, side * inBinormal.z};
            const Vec3 inPosition = {random.real(-2, 2), random.real(-2, 2), random.real(-2, 2)};
            const Vec2 inTexCoord = {random.real(0, 1), random.real(0, 1)};
            // matView: a turn, and the eye at the origin.
            const Vec3 right = random_unit(random);
            const Vec3 up = normalize(cross(right, random_unit(random))), back = cross(right, up);
            const Vec3 eye = {random.real(-9, 9), random.real(-9, 9), random.real(-9, 9)};
            const auto mul = [&](Vec4 v) -> Vec3 {
                const Vec3 from{v.x - eye.x * v.w, v.y - eye.y * v.w, v.z - eye.z * v.w};
                return {dot(right, from), dot(up, from), dot(back, from)};
            };
            const auto direction_of = [&](Vec3 v) { return mul({v.x, v.y, v.z, 0}); };
            const double fHeightScale = random.real(0.01, 0.2), fPerspectiveBias = std::atof(bias);

            const Vec3 placed = mul({inPosition.x, inPosition.y, inPosition.z, 1});
            const Vec3 vView = normalize({-placed.x, -placed.y, -placed.z});
            const Vec3 vViewTS = {dot(direction_of(inTangent), vView),
                                  dot(direction_of(inBinormal), vView),
                                  dot(direction_of(inNormal), vView)};
            if (vViewTS.z < 0.05) continue;  // from below, where the chapter has no guard
            const double flat = std::hypot(vViewTS.x, vViewTS.y);
            const Vec2 vParallaxDirection = {vViewTS.x / flat, vViewTS.y / flat};
            const double fParallaxLength = -std::sqrt(1 - vViewTS.z * vViewTS.z) / vViewTS.z;
            const double fParallaxBias =
                fPerspectiveBias + (1 - fPerspectiveBias) * (2 * vViewTS.z - 1);
            const double factor = -fParallaxLength * fParallaxBias * fHeightScale;
            const Vec2 vParallax = {vParallaxDirection.x * factor, vParallaxDirection.y * factor};

            const std::array<double, 4> pixel = ours(
                {{"position", {inPosition.x, inPosition.y, inPosition.z}},
                 {"normal", {inNormal.x, inNormal.y, inNormal.z}},
                 {"tangent", {inTangent.x, inTangent.y, inTangent.z, side}},
                 {"uv", {inTexCoord.x, inTexCoord.y}}},
                {{"world", {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}},
                 {"eye", {{eye.x, eye.y, eye.z, 1}}},
                 {"light", {{0, 0, 1, 0}}},
                 {"scale", {{fHeightScale}}},
                 {"view_projection", {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
            ++asked;
            if (fParallaxBias < 0) {  // the chapter's ray turns round, ours stays
                ++turned;
                EXPECT_LT(apart(pixel, inTexCoord), rounding);
                continue;
            }
            EXPECT_LT(apart(pixel, {inTexCoord.x - vParallax.x, inTexCoord.y - vParallax.y}),
                      rounding * (1 + std::abs(factor)));
        }
    }
    EXPECT_GT(asked, 60);
    EXPECT_GT(turned, 3);
}

TEST(Chapter, ItsEquationsGiveTheEndOfOurRay) {
    const HeightField floor = field_of(4, 4, [](double, double) { return 0; });
    const Pixel ours("parallax_occlusion,output=displaced", floor);
    Random random(reference::witness::seed());
    for (int i = 0; i < 100; ++i) {
        Draw draw{floor, {random.real(0, 1), random.real(0, 1)}};
        draw.precision = ir::Precision::Double;
        const Vec3 E = draw.to_eye = at_height(random.real(0.05, 0.99), random.real(0, 2 * pi));
        const Vec3 N = {0, 0, 1}, P_b = cross(N, E), P = normalize(cross(N, P_b));
        const double alpha = std::acos(dot(E, P)), V = draw.scale;
        const double l_p = 1 / std::tan(alpha) * std::abs(V);
        // "Therefore we negate the computed parallax displacement vector."
        EXPECT_LT(apart(ours(draw), {draw.uv.x - P.x * l_p, draw.uv.y - P.y * l_p}),
                  rounding * (1 + std::abs(l_p)));
    }
}

// The ps_2_0 listing: where it displaces the coordinate to.
Vec2 chapter_pixel(const HeightField& tNormalMap, Vec2 inTexCoord, Vec2 vParallax) {
    const auto tex2D = [&](double share) {
        return height_at(tNormalMap,
                         {inTexCoord.x - vParallax.x * share, inTexCoord.y - vParallax.y * share});
    };
    const double h0 = tex2D(1.000), h1 = tex2D(0.875), h2 = tex2D(0.750), h3 = tex2D(0.625);
    const double h4 = tex2D(0.500), h5 = tex2D(0.375), h6 = tex2D(0.250), h7 = tex2D(0.125);
    double x, y, xh, yh;
    if (h7 > 0.875)
        x = 0.875, y = 1.000, xh = h7, yh = h7;
    else if (h6 > 0.750)
        x = 0.750, y = 0.875, xh = h6, yh = h7;
    else if (h5 > 0.625)
        x = 0.625, y = 0.750, xh = h5, yh = h6;
    else if (h4 > 0.500)
        x = 0.500, y = 0.625, xh = h4, yh = h5;
    else if (h3 > 0.375)
        x = 0.375, y = 0.500, xh = h3, yh = h4;
    else if (h2 > 0.250)
        x = 0.250, y = 0.375, xh = h2, yh = h3;
    else if (h1 > 0.125)
        x = 0.125, y = 0.250, xh = h1, yh = h2;
    else
        x = 0.000, y = 0.125, xh = h0, yh = h1;
    const double fParallaxEffect = (x * (y - yh) - y * (x - xh)) / ((y - yh) - (x - xh));
    return {inTexCoord.x - vParallax.x * (1 - fParallaxEffect),
            inTexCoord.y - vParallax.y * (1 - fParallaxEffect)};
}

TEST(Chapter, ItsPixelShaderIsParallaxOcclusionWith8Taps) {
    Random random(reference::witness::seed());
    for (const char* maker : {"smooth", "bricks", "cobbles", "spikes", "fur", "flat0", "flat1"}) {
        const HeightField field = made_field(maker, 64, 64);
        const Pixel ours("parallax_occlusion,output=displaced", field);
        for (int i = 0; i < 200; ++i) {
            Draw draw{field, {random.real(0, 1), random.real(0, 1)}};
            draw.precision = ir::Precision::Double;
            draw.to_eye = at_height(random.real(0.1, 0.99), random.real(0, 2 * pi));
            const double along = draw.scale / draw.to_eye.z;
            const Vec2 theirs =
                chapter_pixel(field, draw.uv, {draw.to_eye.x * along, draw.to_eye.y * along});
            EXPECT_LT(apart(ours(draw), theirs), rounding) << maker;
        }
    }
}

TEST(Chapter, ItsLastIntersectionIsUndefinedAlongASlope) {
    // The relief lies along the ray: no sample is above it, and the last two are on it.
    const HeightField slope = field_of(64, 4, [](double u, double) { return 2 * u - 0.5; });
    Draw draw{slope, {0.75, 0.5}};
    draw.to_eye = at_height(0.6, 0);
    draw.scale = 0.5 * 0.6 / draw.to_eye.x;
    EXPECT_TRUE(std::isnan(chapter_pixel(slope, draw.uv, {0.5, 0}).x));
    const double u = Pixel("parallax_occlusion,output=displaced", slope)(draw)[0];
    EXPECT_TRUE(u >= 0.25 - rounding && u <= 0.75) << "anywhere on the slope is right: " << u;
}

// ---- McGuire and McGuire, the abstract ----

struct Marched {
    Vec2 t;
    double height;  // of the relief where the march ended
};

// `while (nb.a < height) { height -= step; t += dt; ... }`
Marched abstract_march(const HeightField& NB, Vec2 texCoord, Vec3 E, double bumpScale, int n) {
    const double step = 1.0 / n;
    const Vec2 dt = {E.x * bumpScale / (n * E.z), E.y * bumpScale / (n * E.z)};
    double height = 1;
    Vec2 t = texCoord;
    double nb = height_at(NB, t);
    while (nb < height) {
        height -= step;
        t = {t.x + dt.x, t.y + dt.y};
        nb = height_at(NB, t);
    }
    return {t, nb};
}

TEST(SteepParallaxAbstract, ItsMarchIsOurs) {
    Random random(reference::witness::seed());
    // A step that doubles can say, so that the listing's height reaches 0 after n of them.
    const Knobs sixteen = {{"min_steps", "16"}, {"max_steps", "16"}};
    for (const char* maker : {"smooth", "bricks", "spikes", "fur", "flat0"}) {
        const HeightField field = made_field(maker, 64, 64);
        const Pixel ours("steep_parallax,output=displaced", field, sixteen);
        int differing = 0;
        for (int i = 0; i < 200; ++i) {
            Draw draw{field, {random.real(0, 1), random.real(0, 1)}};
            draw.precision = ir::Precision::Double;
            draw.to_eye = at_height(random.real(0.1, 0.99), random.real(0, 2 * pi));
            // "From the eye", on tangents that run against the map's: with E = -V on the map's own
            // the march would go towards the eye.
            const Vec3 E = {draw.to_eye.x, draw.to_eye.y, -draw.to_eye.z};
            const Marched theirs = abstract_march(field, draw.uv, E, draw.scale, 16);
            const std::array<double, 4> pixel = ours(draw);
            differing += apart(pixel, theirs.t) > rounding ||
                         std::abs(pixel[2] - theirs.height) > 64 * rounding;
            const Marched literal = abstract_march(
                field, draw.uv, {-draw.to_eye.x, -draw.to_eye.y, -draw.to_eye.z}, draw.scale, 16);
            EXPECT_GE((literal.t.x - draw.uv.x) * draw.to_eye.x +
                          (literal.t.y - draw.uv.y) * draw.to_eye.y,
                      0);
        }
        EXPECT_LE(differing, 1) << maker << ": a sample within rounding of the ray";
    }
}

// "The same as the above listing except we increase height each iteration and increment t along the
// light vector, by dt = -L.xy * bumpScale / (n L.z)."  It ends in shadow only; the page stops it at
// the top.
bool abstract_lit(const HeightField& NB, Marched from, Vec3 L, double bumpScale, int n) {
    const Vec2 dt = {-L.x * bumpScale / (n * L.z), -L.y * bumpScale / (n * L.z)};
    double height = from.height + 0.1 / n, nb = from.height;
    for (Vec2 t = from.t; nb < height && height < 1; nb = height_at(NB, t)) {
        height += 1.0 / n;
        t = {t.x + dt.x, t.y + dt.y};
    }
    return nb < height;
}

TEST(SteepParallaxAbstract, ItsShadowIsOurs) {
    Random random(reference::witness::seed());
    for (const char* maker : {"bricks", "cobbles", "spikes"}) {
        const HeightField field = made_field(maker, 64, 64);
        const Visibility march("march", field,
                               {{"shadow_min_steps", "16"}, {"shadow_max_steps", "16"}});
        int differing = 0, shaded = 0;
        for (int i = 0; i < 200; ++i) {
            Draw draw{field, {random.real(0, 1), random.real(0, 1)}};
            draw.precision = ir::Precision::Double;
            draw.to_light = at_height(random.real(0.1, 0.9), random.real(0, 2 * pi));
            const double height = height_at(field, draw.uv);
            // "From the light", on the same tangents as E.
            const Vec3 L = {draw.to_light.x, draw.to_light.y, -draw.to_light.z};
            const bool lit = abstract_lit(field, {draw.uv, height}, L, draw.scale, 16);
            differing += march(draw, height) != (lit ? 1 : 0);
            shaded += !lit;
        }
        EXPECT_LE(differing, 1) << maker << ": a sample within rounding of the ray";
        EXPECT_GT(shaded, 20) << maker;
    }
}

// ---- McGuire and McGuire, the page ----

// The page's pixel shader, its lost braces where they must have been, its colours of light as
// arguments.  Its bitmaps have row 0 at the bottom: texture2D(u, v) is our map at (u, 1 - v).
struct Page {
    const HeightField& bitmap;
    Vec3 tsN;  // of the whole map
    double bumpScale;

    double NB_a(Vec2 at) const { return height_at(bitmap, {at.x, 1 - at.y}); }

    double march(Vec3 tsE, Vec2& offsetCoord) const {
        double height = 1.0, numSteps = 5;
        double NB = NB_a(offsetCoord);
        numSteps = mix(numSteps * 2, numSteps, tsE.z);
        const double step = 1.0 / numSteps;
        const Vec2 delta = {-tsE.x * bumpScale / (tsE.z * numSteps),
                            tsE.y * bumpScale / (tsE.z * numSteps)};
        while (NB < height) {
            height -= step;
            offsetCoord = {offsetCoord.x + delta.x, offsetCoord.y + delta.y};
            NB = NB_a(offsetCoord);
        }
        return NB;
    }

    double self_shadow(Vec3 tsL, Vec2 offsetCoord, double NB) const {
        const int numShadowSteps = static_cast<int>(mix(60, 5, tsL.z));
        const double step = 1.0 / numShadowSteps;
        const Vec2 delta = {tsL.x * bumpScale / (numShadowSteps * tsL.z),
                            -tsL.y * bumpScale / (numShadowSteps * tsL.z)};
        double height = NB + step * 0.1;
        while (NB < height && height < 1) {
            height += step;
            offsetCoord = {offsetCoord.x + delta.x, offsetCoord.y + delta.y};
            NB = NB_a(offsetCoord);
        }
        return NB < height ? 1 : 0;
    }

    // Of a colour's red, whose albedo, ambient light and light are given.
    double shade(Vec2 texCoord, Vec3 tsE, Vec3 tsL, double color, double ambient,
                 double lightColor) const {
        const double NB = march(tsE, texCoord);
        const double NdotL = std::max(0.0, dot(tsN, tsL));
        double selfShadow = 0;
        if (NdotL > 0) selfShadow = self_shadow(tsL, texCoord, NB);
        return color * ambient + color * NdotL * selfShadow * lightColor;
    }
};

const Knobs page_steps = {{"min_steps", "5"}, {"max_steps", "10"}};

TEST(SteepParallaxPage, ItsPixelShaderIsOurs) {
    Random random(reference::witness::seed());
    const Vec3 tsN = {0.48, -0.36, 0.8};
    ir::Texture normal;  // one texel
    normal.levels = {{0.74f, 0.32f, 0.9f, 1.0f}};
    for (const char* maker : {"smooth", "bricks", "cobbles", "fur"}) {
        HeightField field = made_field(maker, 64, 64);
        // The page's height is a sum of steps, and rounding leaves it above 0 at times: on a floor
        // of 0 it would take a step more, below the floor.
        for (double& height : field.heights) height = std::max(height, 0.01);
        const Page page{field, tsN, 0.08};
        const Pixel place("steep_parallax,output=displaced", field, page_steps),
            shade("steep_parallax,shadow=march,shading=lambert", field, page_steps);
        int differing = 0, shaded = 0, unlit = 0;
        for (int i = 0; i < 200; ++i) {
            Draw draw{field, {random.real(0, 1), random.real(0, 1)}};
            draw.precision = ir::Precision::Double;
            draw.normal_map = &normal;
            // Counts of steps that are whole, and that truncating and rounding agree in.
            draw.to_eye = at_height(random.integer(1, 5) / 5.0, random.real(0, 2 * pi));
            draw.to_light = at_height((random.integer(3, 53) + 0.75) / 55, random.real(0, 2 * pi));
            const Vec2 texCoord = {draw.uv.x, 1 - draw.uv.y};
            Vec2 offsetCoord = texCoord;
            const double NB = page.march(draw.to_eye, offsetCoord);
            const std::array<double, 4> at = place(draw);
            const double theirs = page.shade(texCoord, draw.to_eye, draw.to_light, 0.5, 0.25, 1);
            differing += apart(at, {offsetCoord.x, 1 - offsetCoord.y}) > rounding ||
                         std::abs(at[2] - NB) > 64 * rounding ||
                         std::abs(shade(draw)[0] - theirs) > rounding;
            const bool faces = dot(tsN, draw.to_light) > 0;
            unlit += !faces;
            shaded += faces && theirs == 0.5 * 0.25;
        }
        EXPECT_LE(differing, 2) << maker << ": a sample within rounding of a ray";
        EXPECT_GT(unlit, 5) << maker;
        EXPECT_GT(shaded, maker == std::string("smooth") ? 0 : 10) << maker;
    }
}

TEST(SteepParallaxPage, ItsLastStepEndsBelowTheFloorUnlessTheStepsAreWhole) {
    const HeightField floor = field_of(4, 4, [](double, double) { return 0; });
    const Page page{floor, {0, 0, 1}, 0.08};
    const Pixel ours("steep_parallax,output=displaced", floor, page_steps);
    Draw draw{floor, {0.5, 0.5}};
    draw.precision = ir::Precision::Double;
    draw.to_eye = at_height(0.54, 0.3);  // 7.3 steps
    const auto share = [&](double u) {
        return (draw.uv.x - u) * draw.to_eye.z / (draw.to_eye.x * draw.scale);
    };
    Vec2 theirs = {draw.uv.x, 1 - draw.uv.y};
    page.march(draw.to_eye, theirs);
    EXPECT_NEAR(share(theirs.x), 8 / 7.3, 1e-9);
    EXPECT_NEAR(share(ours(draw)[0]), 1, 1e-6);
}

}  // namespace
}  // namespace intaglio::templates::testing

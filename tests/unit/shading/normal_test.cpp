// Normal sources against closed forms, and the listings of their sources transcribed.
#include "tests/unit/shading/pixel.h"

#include <algorithm>

namespace intaglio::templates::testing {
namespace {

using reference::height_at;

Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator*(Vec3 a, double b) { return {a.x * b, a.y * b, a.z * b}; }
Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec3 unit(Vec3 v) { return v * (1 / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z)); }

double distance(Vec3 a, Vec3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

// A normal source, seen through shading by ambient light alone on a module made for it: the normal
// itself is what the surface writes.
class Normal {
  public:
    Normal(const std::string& source, const HeightField& field, const Knobs& knobs = {})
        : judge_(recorded(source, knobs), field) {}

    Vec3 operator()(const Draw& draw) const {
        const std::array<double, 4> n = judge_(draw, {{"uv", {draw.uv.x, draw.uv.y}}}).outputs[0];
        return {n[0], n[1], n[2]};
    }

  private:
    static ir::Module recorded(const std::string& source, const Knobs& knobs) {
        using namespace dsl;
        const Surface surface = surface_named("search=none,normal=" + source, knobs);
        ir::Module module;
        module.name = source;
        module.stage = ir::Stage::Pixel;
        Recorder recorder(module);
        const float2 uv = input<2>("uv");
        const Relief relief{sampler2D("height_map", "heights"), false, uniform<1>("scale", "depth"),
                            uniform<2>("map_size", "texels"), 0.0f};
        const float3 normal =
            surface.normal->normal(relief, Hit{uv, 1.0f}, Footprint{ddx(uv), ddy(uv)});
        module.outputs = {{"normal", ir::float3, ir::Semantic::Target}};
        EXPECT_TRUE(recorder.finish({normal.id()}).ok());
        return module;
    }
    Judge judge_;
};

// In binary32 a slope is a difference of heights, each good to 2^-24, times size and scale.
constexpr double rounding = 2e-5;

const std::vector<std::pair<std::string, Knobs>> from_heights = {
    {"blinn", {{"central", "0"}}},
    {"blinn", {{"central", "1"}}},
    {"blinn", {{"central", "1"}, {"difference", "3"}}},
    {"blinn", {{"central", "0"}, {"tangents", "1"}}},
    {"from_hit", {}}};

TEST(Normals, OnAPlaneAreThePlanesOwn) {
    Random random(reference::witness::seed());
    for (int map = 0; map < 40; ++map) {
        const double a = random.real(-0.4, 0.4), b = random.real(-0.4, 0.4);
        const HeightField plane = field_of(
            32, 16, [&](double u, double v) { return 0.5 + a * (u - 0.5) + b * (v - 0.5); });
        Draw draw{plane};
        draw.scale = random.real(0.01, 0.5);
        draw.uv = {random.real(0.25, 0.75), random.real(0.25, 0.75)};
        const Vec3 expected = unit({-a * draw.scale, -b * draw.scale, 1});
        for (const auto& [source, knobs] : from_heights)
            EXPECT_LT(distance(Normal(source, plane, knobs)(draw), expected), rounding) << source;
    }
}

TEST(Normals, WithoutReliefAreThePolygons) {
    const HeightField spikes = made_field("spikes", 16, 16);
    Draw draw{spikes};
    draw.scale = 0;
    for (const auto& [source, knobs] : from_heights)
        for (double u : {0.0, 0.3, 0.77}) {
            draw.uv = {u, 0.4};
            EXPECT_LT(distance(Normal(source, spikes, knobs)(draw), {0, 0, 1}), 1e-7) << source;
        }
}

TEST(Normals, OfAParaboloidByCentralDifferencesAreExactAtTexelCentres) {
    // (f(x + d) - f(x - d)) / 2d is the derivative of any quadratic.
    const HeightField bowl = field_of(64, 64, [](double u, double v) {
        return 1.6 * ((u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5));
    });
    const Normal central("blinn", bowl, {{"central", "1"}}),
        forward("blinn", bowl, {{"central", "0"}});
    double worst_forward = 0;
    for (int x : {10, 32, 50})
        for (int y : {13, 31, 44}) {
            Draw draw{bowl, {(x + 0.5) / 64, (y + 0.5) / 64}};
            draw.scale = 0.25;
            const Vec3 expected = unit(
                {-3.2 * (draw.uv.x - 0.5) * draw.scale, -3.2 * (draw.uv.y - 0.5) * draw.scale, 1});
            EXPECT_LT(distance(central(draw), expected), rounding);
            worst_forward = std::max(worst_forward, distance(forward(draw), expected));
        }
    EXPECT_GT(worst_forward, 100 * rounding) << "half a texel off, forward differences are not";
}

// The largest error of a normal over a wave, at texel centres of maps of `size` texels.
double wave_error(int size, const std::string& source, const Knobs& knobs) {
    const auto phase = [](double x) { return 2 * pi * x; };
    const HeightField wave = field_of(size, size, [&](double u, double v) {
        return 0.5 + 0.25 * std::sin(phase(u)) * std::cos(phase(v));
    });
    const Normal normal(source, wave, knobs);
    double worst = 0;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) {
            Draw draw{wave, {(i * (size / 8) + 0.5) / size, (j * (size / 8) + 0.5) / size}};
            draw.scale = 0.2;
            const double u = phase(draw.uv.x), v = phase(draw.uv.y);
            const double slope = 0.25 * 2 * pi * draw.scale;
            worst = std::max(worst,
                             distance(normal(draw), unit({-slope * std::cos(u) * std::cos(v),
                                                          slope * std::sin(u) * std::sin(v), 1})));
        }
    return worst;
}

TEST(Blinn, ConvergesAtTheOrderOfItsDifferences) {
    for (int size : {16, 32, 64}) {
        const double forward = wave_error(size, "blinn", {{"central", "0"}}) /
                               wave_error(2 * size, "blinn", {{"central", "0"}});
        EXPECT_NEAR(forward, 2, 0.15) << "first order at " << size;
        const double central = wave_error(size, "blinn", {{"central", "1"}}) /
                               wave_error(2 * size, "blinn", {{"central", "1"}});
        EXPECT_NEAR(central, 4, 0.4) << "second order at " << size;
    }
    // The patch's slope at its corner is a forward difference.
    EXPECT_NEAR(wave_error(32, "from_hit", {}) / wave_error(64, "from_hit", {}), 2, 0.15);
}

TEST(Blinn, IsTheNotesFormula) {
    // h_s ~ (h(s + ds, t) - h(s, t)) / ds, N' = N - h_t P_t - h_s P_s, with h in the surface's
    // unit.
    const HeightField field = made_field("bricks", 32, 32);
    const Normal normal("blinn", field, {{"central", "0"}});
    Random random(reference::witness::seed());
    for (int i = 0; i < 200; ++i) {
        Draw draw{field, {random.real(0, 1), random.real(0, 1)}};
        draw.precision = ir::Precision::Double;
        const double ds = 1.0 / 32, dt = 1.0 / 32;
        const auto h = [&](double s, double t) { return draw.scale * height_at(field, {s, t}); };
        const double h_s = (h(draw.uv.x + ds, draw.uv.y) - h(draw.uv.x, draw.uv.y)) / ds;
        const double h_t = (h(draw.uv.x, draw.uv.y + dt) - h(draw.uv.x, draw.uv.y)) / dt;
        const Vec3 n{0, 0, 1}, p_s{1, 0, 0}, p_t{0, 1, 0};
        EXPECT_LT(distance(normal(draw), unit(n + p_t * -h_t + p_s * -h_s)), 1e-9);
    }
}

TEST(Blinn, IsTheCrossProductOnAnyTangents) {
    // P'_s x P'_t of the displaced plane, turned to the side of N: whatever the tangents' lengths,
    // the angle between them and their handedness.
    const HeightField plane = field_of(
        32, 32, [](double u, double v) { return 0.5 + 0.3 * (u - 0.5) - 0.2 * (v - 0.5); });
    const Normal normal("blinn", plane, {{"central", "1"}, {"tangents", "1"}});
    Random random(reference::witness::seed());
    int mirrored = 0, notes_wrong = 0;
    for (int i = 0; i < 300; ++i) {
        Draw draw{plane};
        draw.scale = random.real(0.05, 2);
        const double size = std::pow(10, random.real(-3, 3));
        const Vec3 s{size * random.real(-1, 1), size * random.real(-1, 1), 0};
        const Vec3 t{size * random.real(-1, 1), size * random.real(-1, 1), 0};
        const double area = s.x * t.y - s.y * t.x;
        if (std::abs(area) < 0.05 * size * size) continue;
        mirrored += area < 0;
        draw.map_tangents = {s.x, s.y, t.x, t.y};
        const Vec3 n{0, 0, 1};
        const Vec3 along_s = s + n * (0.3 * draw.scale), along_t = t + n * (-0.2 * draw.scale);
        const Vec3 expected = unit(cross(along_s, along_t)) * (area < 0 ? -1 : 1);
        // Rounding of the heights, of which the tangents' smallness makes slopes.
        const double slack = rounding * (1 + draw.scale / size);
        EXPECT_LT(distance(normal(draw), expected), slack);
        const Vec3 notes = unit(n + s * (-0.3 * draw.scale) + t * (0.2 * draw.scale));
        notes_wrong += distance(notes, expected) > 0.05;
    }
    EXPECT_GT(mirrored, 50);
    EXPECT_GT(notes_wrong, 100) << "the notes' last step holds for unit tangents at right angles";
}

TEST(Blinn, OnTangentsWithoutAreaIsThePolygons) {
    const HeightField field = made_field("bricks", 16, 16);
    const Normal normal("blinn", field, {{"tangents", "1"}});
    for (const Vector& tangents :
         {Vector{0, 0, 0, 0}, Vector{1, 0, 2, 0}, Vector{1e-20, 0, 0, 1e-20}}) {
        Draw draw{field, {0.3, 0.6}};
        draw.map_tangents = tangents;
        EXPECT_LT(distance(normal(draw), {0, 0, 1}), 1e-6);
    }
}

TEST(FromHit, IsThePatchsOwnNormal) {
    Random random(reference::witness::seed());
    for (const char* maker : {"bricks", "spikes", "smooth"}) {
        const HeightField field = made_field(maker, 32, 16);
        const Normal normal("from_hit", field);
        for (int i = 0; i < 100; ++i) {
            Draw draw{field, {random.real(0, 1), random.real(0, 1)}};
            draw.precision = ir::Precision::Double;
            // Well inside the cell, where the patch has a slope.
            const double inside_x = draw.uv.x * 32 - 0.5, inside_y = draw.uv.y * 16 - 0.5;
            if (std::abs(inside_x - std::round(inside_x)) < 0.01 ||
                std::abs(inside_y - std::round(inside_y)) < 0.01)
                continue;
            const double d = 1e-5;
            const auto h = [&](double u, double v) { return height_at(field, {u, v}); };
            const double h_u =
                (h(draw.uv.x + d, draw.uv.y) - h(draw.uv.x - d, draw.uv.y)) / (2 * d);
            const double h_v =
                (h(draw.uv.x, draw.uv.y + d) - h(draw.uv.x, draw.uv.y - d)) / (2 * d);
            // Differences over 2e-5 of heights good to 1e-16.
            EXPECT_LT(distance(normal(draw), unit({-h_u * draw.scale, -h_v * draw.scale, 1})), 1e-8)
                << maker;
        }
    }
}

TEST(FromHit, WrapsAtTheEdgesOfTheTile) {
    const HeightField field = made_field("text", 16, 16);
    const Normal normal("from_hit", field);
    for (double u : {0.01, 0.5, 0.99})
        for (double shift : {-3.0, 1.0, 64.0}) {
            Draw draw{field, {u, 0.99}}, shifted{field, {u + shift, 0.99 - shift}};
            draw.precision = shifted.precision = ir::Precision::Double;
            EXPECT_LT(distance(normal(draw), normal(shifted)), 1e-9);
        }
}

// A normal map and its heights, as textures of random smooth hills.
ir::Texture random_normals(Random& random, int size) {
    ir::Texture map;
    map.width = map.height = size;
    std::vector<float>& texels = map.levels.emplace_back();
    for (int i = 0; i < size * size; ++i) {
        const Vec3 n = unit({random.real(-1, 1), random.real(-1, 1), random.real(0.3, 1)});
        for (double c : {n.x, n.y, n.z}) texels.push_back(static_cast<float>(c * 0.5 + 0.5));
        texels.push_back(1);
    }
    return map;
}

TEST(Smoothed, IsThePagesLineUnderItsFlippedBitmap) {
    // tsN = normalize(texture2D(normalBumpMap, offsetCoord + vec2(tsN.x, -tsN.y) * mipScale).xyz
    //                 * 2 - 1 + tsN)
    // In the page's bitmap row 0 is the bottom, and its v grows upwards.
    Random random(reference::witness::seed());
    constexpr int size = 16;
    const ir::Texture ours = random_normals(random, size);
    ir::Texture theirs = ours;
    for (int y = 0; y < size; ++y)
        std::copy_n(ours.levels[0].begin() + 4 * size * y, 4 * size,
                    theirs.levels[0].begin() + 4 * size * (size - 1 - y));
    const auto texture2D = [&](double u, double v) {
        const std::array<double, 4> texel = ir::sample_level<double>(theirs, {u, v, 0}, 0);
        return Vec3{texel[0] * 2 - 1, texel[1] * 2 - 1, texel[2] * 2 - 1};
    };
    const HeightField heights = made_field("flat1", size, size);
    const Normal normal("smoothed", heights, {{"smoothing", "3"}});
    const Normal map("map", heights), none("smoothed", heights, {{"smoothing", "0"}});
    for (int i = 0; i < 200; ++i) {
        Draw draw{heights, {random.real(0, 1), random.real(0, 1)}};
        draw.normal_map = &ours;
        draw.precision = ir::Precision::Double;
        const double mip_scale = 3.0 / size;
        Vec3 ts_n = texture2D(draw.uv.x, 1 - draw.uv.y);
        ts_n = unit(texture2D(draw.uv.x + ts_n.x * mip_scale, 1 - draw.uv.y - ts_n.y * mip_scale) +
                    ts_n);
        EXPECT_LT(distance(normal(draw), ts_n), 1e-6);
        EXPECT_LT(distance(none(draw), map(draw)), 1e-6) << "no distance, no smoothing";
    }
}

// The normals of a field by central differences, as a texture.
ir::Texture normals_of(const HeightField& field, double scale) {
    ir::Texture normals;
    normals.width = field.width;
    normals.height = field.height;
    std::vector<float>& texels = normals.levels.emplace_back();
    for (int y = 0; y < field.height; ++y)
        for (int x = 0; x < field.width; ++x) {
            const double du = 1.0 / field.width, dv = 1.0 / field.height;
            const double u = (x + 0.5) * du, v = (y + 0.5) * dv;
            const auto h = [&](double s, double t) { return scale * height_at(field, {s, t}); };
            const Vec3 normal = unit({(h(u - du, v) - h(u + du, v)) / (2 * du),
                                      (h(u, v - dv) - h(u, v + dv)) / (2 * dv), 1});
            for (double c : {normal.x, normal.y, normal.z, 1.0})
                texels.push_back(static_cast<float>(c * 0.5 + 0.5));
        }
    return normals;
}

TEST(Smoothed, SoftensTheSlicesOfAMarch) {
    // Along four lines of pixels: how far the shade is from that where the ray is met exactly, and
    // the squared jumps from pixel to pixel, of which a staircase has more than the slope it
    // climbs.
    struct Scan {
        double error = 0, jumps = 0;
    };
    for (const char* maker : {"smooth", "noise"}) {
        const HeightField field = made_field(maker, 64, 64);
        const double scale = 0.15;
        const ir::Texture normals = normals_of(field, scale);
        const auto shades = [&](const std::string& surface, const Knobs& knobs) {
            const Pixel pixel(surface + ",shading=lambert", field, knobs);
            std::vector<double> line;
            for (int i = 0; i < 2048; ++i) {
                Draw draw{field, {(i % 512) / 512.0, 0.3 + 0.1 * (i / 512)}};
                draw.scale = scale;
                draw.normal_map = &normals;
                draw.to_eye = direction(30, 20);
                draw.to_light = direction(40, 130);
                line.push_back(pixel(draw)[0]);
            }
            return line;
        };
        const std::vector<double> exact = shades("search=exact", {});
        const auto scan = [&](const std::vector<double>& line) {
            Scan result;
            for (std::size_t i = 1; i < line.size(); ++i) {
                result.error += (line[i] - exact[i]) * (line[i] - exact[i]);
                result.jumps += (line[i] - line[i - 1]) * (line[i] - line[i - 1]);
            }
            return result;
        };
        const auto of_march = [&](const char* texels) {
            return scan(shades("steep_parallax,normal=smoothed",
                               {{"min_steps", "8"}, {"max_steps", "8"}, {"smoothing", texels}}));
        };
        const double slope = scan(exact).jumps;
        const Scan plain = of_march("0"), two = of_march("2"), eight = of_march("8");
        EXPECT_GT(plain.jumps, 1.5 * slope) << maker << ": the march shows its slices";
        EXPECT_LT(two.jumps, 0.97 * plain.jumps) << maker;
        EXPECT_LT(two.error, plain.error) << maker << ": it also moves towards where the ray hit";
        EXPECT_LT(eight.jumps - slope, 0.75 * (plain.jumps - slope)) << maker;
        EXPECT_GT(eight.error, plain.error) << maker << ": more of it blurs";
    }
}

TEST(Normals, AreUnitWhateverTheyAreGiven) {
    const HeightField spikes = made_field("spikes", 8, 8);
    for (const auto& row : all_techniques().normals) {
        const Normal normal(row.name, spikes);
        for (double u : {0.0, 1.0, -3.5, 64.0, 1000.0, 1e5})
            for (double scale : {0.0, 0.08, 1.0, 1000.0}) {
                Draw draw{spikes, {u, 0.4 - u}};
                draw.scale = scale;
                EXPECT_NEAR(distance(normal(draw), {0, 0, 0}), 1, 1e-5) << row.name << " at " << u;
            }
    }
}

}  // namespace
}  // namespace intaglio::templates::testing

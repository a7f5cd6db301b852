// What a pixel writes beside its colour: the depth of the point that the ray met, and whether it is
// kept.
#include <gmock/gmock.h>

#include "tests/rounds.h"
#include "tests/unit/shading/pixel.h"

#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/target/target.h"

namespace intaglio::templates::testing {
namespace {

using reference::witness::Random;

// A camera on a flat polygon: rows of the matrix from world to clip space.
struct Camera {
    std::array<Vector, 4> rows;
    Vec3 eye;

    Vector clip(const Vector& point) const {
        Vector result{};
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t i = 0; i < 4; ++i) result[row] += rows[row][i] * point[i];
        return result;
    }
};

// Looks from `eye` along (a, b, -1), perspective with near and far plane, depth from 0 to 1.
Camera camera_at(Vec3 eye, double a, double b, double near, double far) {
    const double length = std::sqrt(a * a + b * b + 1);
    const Vec3 forward{a / length, b / length, -1 / length};
    const double right_length = std::hypot(forward.y, forward.x);
    const Vec3 right{-forward.y / right_length, forward.x / right_length, 0};
    const Vec3 up{right.y * forward.z, -right.x * forward.z,
                  right.x * forward.y - right.y * forward.x};
    const auto row = [&](Vec3 axis, double scale) {
        return Vector{axis.x * scale, axis.y * scale, axis.z * scale,
                      -(axis.x * eye.x + axis.y * eye.y + axis.z * eye.z) * scale};
    };
    Camera camera{{}, eye};
    camera.rows = {row(right, 1.5), row(up, 1.5), row(forward, far / (far - near)),
                   row(forward, 1)};
    camera.rows[2][3] -= far * near / (far - near);
    return camera;
}

// The pixel stage of output=depth: outputs are colour and depth.
struct Depth {
    Judge judge;

    static ir::Module recorded(const std::string& surface, const Knobs& knobs) {
        Result<ir::Program> program =
            dsl::record_surface(surface_named(surface, knobs), {"glsl_450", {}, false});
        EXPECT_TRUE(program.ok());
        EXPECT_TRUE(ir::verify(program->pixel).ok());
        return program->pixel;
    }
    Depth(const std::string& surface, const HeightField& field, const Knobs& knobs = {})
        : judge(recorded(surface + ",output=depth", knobs), field) {}

    // The polygon is z = 0, its texture coordinates are x and y.
    double operator()(Draw draw, const Camera& camera) const {
        const Vec3 to_eye{camera.eye.x - draw.uv.x, camera.eye.y - draw.uv.y, camera.eye.z};
        const Vector here = camera.clip({draw.uv.x, draw.uv.y, 0, 1});
        const Vector there = camera.clip({to_eye.x, to_eye.y, to_eye.z, 0});
        return judge(draw, {{"uv", {draw.uv.x, draw.uv.y}},
                            {"to_eye", {to_eye.x, to_eye.y, to_eye.z}},
                            {"to_light", {0, 0, 1}},
                            {"depth_line", {here[2], here[3], there[2], there[3]}}})
            .outputs[1][0];
    }
};

Camera random_camera(Random& random) {
    return camera_at({random.real(-2, 3), random.real(-2, 3), random.real(0.3, 3)},
                     random.real(-1, 1), random.real(-1, 1), 0.1, 20);
}

TEST(Depth, IsThatOfAPolygonThroughThePoint) {
    // On a flat map of height h every ray meets the plane z = -(1 - h) scale.
    Random random(reference::witness::seed());
    int asked = 0;
    for (int i = 0; i < rounds(300); ++i) {
        const double h = static_cast<float>(random.real(0, 1));
        const HeightField field = field_of(8, 8, [&](double, double) { return h; });
        Draw draw{field, {random.real(0, 1), random.real(0, 1)}};
        draw.scale = random.real(0.01, 0.3);
        draw.precision = ir::Precision::Double;
        const Camera camera = random_camera(random);
        const Vec3 eye = camera.eye;
        const double along = (1 - h) * draw.scale / eye.z;  // beyond the polygon, in lengths to it
        const Vector place =
            camera.clip({draw.uv.x + (draw.uv.x - eye.x) * along,
                         draw.uv.y + (draw.uv.y - eye.y) * along, -(1 - h) * draw.scale, 1});
        if (place[3] < 0.1 || place[2] < 0 || place[2] > place[3]) continue;  // out of sight
        ++asked;
        const double expected = place[2] / place[3];
        EXPECT_NEAR(Depth("parallax_occlusion", field)(draw, camera), expected, 1e-6);
        EXPECT_NEAR(Depth("parallax_occlusion", field, {{"depth_range", "1"}})(draw, camera),
                    0.5 * expected + 0.5, 1e-6);
        // 1 / (z + ray distance), the ray's length in the relief added to its length outside.
        const double outside = std::hypot(eye.x - draw.uv.x, eye.y - draw.uv.y, eye.z);
        EXPECT_NEAR(Depth("parallax_occlusion", field, {{"page_depth", "1"}})(draw, camera),
                    1 / (outside + outside * along), 1e-6);
    }
    EXPECT_GT(asked, rounds(50));
}

TEST(Depth, OfBumpMappingIsThePolygons) {
    const HeightField bricks = made_field("bricks", 16, 16);
    Random random(reference::witness::seed());
    for (int i = 0; i < 50; ++i) {
        Draw draw{bricks, {random.real(0, 1), random.real(0, 1)}};
        const Camera camera = random_camera(random);
        const Vector here = camera.clip({draw.uv.x, draw.uv.y, 0, 1});
        const double expected = std::clamp(here[2] / std::max(here[3], 1e-18), 0.0, 1.0);
        EXPECT_NEAR(Depth("search=none", bricks)(draw, camera), expected, 1e-6);
    }
}

TEST(Depth, ThePagesOrdersAsAReversedBufferDoes) {
    // Of two points in one pixel's ray the nearer has the greater 1 / (z + distance) and the lesser
    // depth.
    Random random(reference::witness::seed());
    for (int i = 0; i < 50; ++i) {
        const HeightField high = field_of(4, 4, [](double, double) { return 0.9; });
        const HeightField low = field_of(4, 4, [](double, double) { return 0.2; });
        Draw near{high}, far{low};
        const Camera camera = camera_at({random.real(0, 1), random.real(-3, -1), 1}, 0, 1, 0.1, 20);
        EXPECT_LT(Depth("parallax_occlusion", high)(near, camera),
                  Depth("parallax_occlusion", low)(far, camera));
        const Knobs page = {{"page_depth", "1"}};
        EXPECT_GT(Depth("parallax_occlusion", high, page)(near, camera),
                  Depth("parallax_occlusion", low, page)(far, camera));
    }
}

TEST(Depth, IsFiniteFromBelowAndAlongThePolygon) {
    const HeightField spikes = made_field("spikes", 8, 8);
    for (const char* page : {"0", "1"}) {
        const Depth depth("parallax_occlusion", spikes, {{"page_depth", page}});
        for (const Vec3 eye :
             {Vec3{2, 2, 0}, Vec3{2, 2, -1}, Vec3{0.5, 0.5, 0}, Vec3{1e6, 0, 1e-6}}) {
            const double d = depth(Draw{spikes}, Camera{camera_at(eye, 1, 0, 0.1, 20).rows, eye});
            EXPECT_TRUE(std::isfinite(d)) << eye.x << " " << eye.z;
        }
    }
}

TEST(Depth, IsRefusedWhereTheVertexWorkHandsNothingOn) {
    class Plain : public dsl::VertexWork {
        dsl::Vertex transform(int) const override {
            const dsl::float3 position = dsl::input<3>("position");
            return {dsl::float4(position, 1.0f), dsl::input<2>("uv"), position, {position}};
        }
    };
    dsl::Surface surface = surface_named("search=none,output=depth");
    surface.vertex = std::make_unique<Plain>();
    const Result<ir::Program> program = dsl::record_surface(surface, {"glsl_450", {}, false});
    ASSERT_FALSE(program.ok());
    EXPECT_EQ(program.error().code, "vertex-depth");
    surface.output = std::move(surface_named("search=none").output);
    EXPECT_TRUE(dsl::record_surface(surface, {"glsl_450", {}, false}).ok());
}

TEST(Knobs, OfEveryPartWorkAtBothEndsOnTargetsWithLoops) {
    // One part at a time beside plain ones; compositions are the variant tests' business.
    const dsl::Catalogue catalogue = all_techniques();
    std::vector<std::string> surfaces;
    for (const auto& row : catalogue.shadows) surfaces.push_back("search=none,shadow=" + row.name);
    for (const auto& row : catalogue.normals) surfaces.push_back("search=none,normal=" + row.name);
    for (const auto& row : catalogue.shadings)
        surfaces.push_back("search=none,shading=" + row.name);
    for (const auto& row : catalogue.outputs) surfaces.push_back("search=none,output=" + row.name);
    int at = 0;
    for (const std::string& text : surfaces)
        for (std::size_t i = 0; i < surface_named(text).knobs().size(); ++i)
            for (bool most : {false, true}) {
                if (at++ % stride != 0) continue;
                const dsl::Surface surface = surface_named(text);
                dsl::KnobBase* knob = surface.knobs()[i];
                ASSERT_TRUE(knob->set(most ? knob->most() : knob->least()).ok());
                const Result<ir::Program> program =
                    dsl::record_surface(surface, {"glsl_450", {}, false});
                if (!program) {
                    EXPECT_EQ(program.error().code, "knob-relation") << text << " " << knob->name();
                    continue;
                }
                for (const char* target : {"glsl_450", "essl_100", "hlsl_5_0"}) {
                    const Result<Emitted> emitted = emit(*program, *find_target(target));
                    EXPECT_TRUE(emitted.ok()) << text << " " << knob->setting() << " on " << target
                                              << ": " << to_string(emitted.error());
                }
            }
}

TEST(ClipTile, DropsWhatLeavesTheTile) {
    const HeightField bricks = made_field("bricks", 32, 32);
    const dsl::Surface surface =
        surface_named("parallax_occlusion,output=displaced", {{"clip_tile", "1"}});
    Result<ir::Program> program = dsl::record_surface(surface, {"glsl_450", {}, false});
    ASSERT_TRUE(program.ok());
    const Judge judge(program->pixel, bricks);
    Random random(reference::witness::seed());
    int dropped = 0;
    for (int i = 0; i < 400; ++i) {
        Draw draw{bricks, {random.real(0, 1), random.real(0, 1)}};
        draw.tile = {0, 0, 1, i % 2 ? 1.0 : 0.6};
        const Vec3 eye = direction(random.real(5, 60), random.real(0, 360));
        const ir::Evaluation pixel = judge(draw, {{"uv", {draw.uv.x, draw.uv.y}},
                                                  {"to_eye", {eye.x, eye.y, eye.z}},
                                                  {"to_light", {0, 0, 1}}});
        const double u = pixel.outputs[0][0], v = pixel.outputs[0][1];
        const bool inside = u >= 0 && v >= 0 && u <= draw.tile[2] && v <= draw.tile[3];
        EXPECT_EQ(pixel.outputs[1][0] >= 0, inside) << u << " " << v;
        dropped += !inside;
    }
    EXPECT_GT(dropped, 50);
    EXPECT_LT(dropped, 350);
}

TEST(DepthAndClip, AreSaidByEveryTargetThatCan) {
    const dsl::Surface surface =
        surface_named("parallax_occlusion,output=depth", {{"clip_tile", "1"}});
    const Result<ir::Program> program = dsl::record_surface(surface, {"glsl_450", {}, false});
    ASSERT_TRUE(program.ok());
    const Result<ir::Module> back = ir::parse(ir::print(program->pixel), "pixel");
    ASSERT_TRUE(back.ok()) << to_string(back.error());
    EXPECT_TRUE(*back == program->pixel);
    int said = 0;
    for (const Target* target : all_targets()) {
        if (!target->derived_from.empty() || target->name == "none") continue;
        if (!all_rounds && target->name.starts_with("ps_2_")) continue;  // ps_3_0 has all of it
        const Result<Emitted> emitted = emit(*program, *target);
        if (!target->pixel_stage) {
            EXPECT_TRUE(emitted.ok()) << target->name << " has no pixels to drop";
            continue;
        }
        if (target->name == "ps_2_0") {  // where it is too much for the slots
            ASSERT_FALSE(emitted.ok());
            EXPECT_EQ(emitted.error().code, "d3d9-limit");
            continue;
        }
        ASSERT_TRUE(emitted.ok()) << target->name << ": " << to_string(emitted.error());
        const bool hlsl = target->name.starts_with("hlsl"), d3d9 = target->name.starts_with("ps_");
        EXPECT_THAT(emitted->pixel.text, ::testing::HasSubstr(hlsl   ? "clip(inside)"
                                                              : d3d9 ? "\ntexkill r"
                                                                     : "discard;"));
        EXPECT_THAT(emitted->pixel.text, ::testing::HasSubstr(hlsl   ? "SV_Depth"
                                                              : d3d9 ? " oDepth, r"
                                                                     : "gl_FragDepth"));
        ++said;
    }
    EXPECT_GE(said, all_rounds ? 12 : 10);
}

TEST(DepthAndClip, AreVerified) {
    ir::Module module;
    module.name = "m";
    module.stage = ir::Stage::Pixel;
    dsl::Recorder recorder(module);
    const dsl::float1 one = dsl::let("one", dsl::input<1>("x"));
    const dsl::float2 two = dsl::let("two", dsl::input<2>("y"));
    module.outputs = {{"d", ir::float1, ir::Semantic::Depth},
                      {"c", ir::float1, ir::Semantic::Clip}};
    ASSERT_TRUE(recorder.finish({one.id(), one.id()}).ok());
    EXPECT_TRUE(ir::verify(module).ok());
    ir::Module twice = module;
    twice.outputs[0].semantic = ir::Semantic::Clip;
    EXPECT_FALSE(ir::verify(twice).ok()) << "two outputs clip";
    ir::Module wide = module;
    wide.outputs[0].type = ir::float2;
    wide.body.body.back().operands[0] = two.id();
    EXPECT_THAT(ir::verify(wide).error().message, ::testing::HasSubstr("depth is one float"));
    ir::Module vertex = module;
    vertex.stage = ir::Stage::Vertex;
    EXPECT_FALSE(ir::verify(vertex).ok());
}

}  // namespace
}  // namespace intaglio::templates::testing

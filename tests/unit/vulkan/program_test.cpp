// Draws whose pixels are known: constants, varyings, uniforms, targets, depth; and timing and
// repetition.
#include "src/vulkan/program.h"

#include <algorithm>
#include <cmath>

#include "src/vulkan/camera.h"
#include "tests/unit/vulkan/harness.h"

namespace intaglio::vulkan {
namespace {

using Pixel = std::array<float, 4>;

class ProgramTest : public OnDevice {};

Stage uv_fragment() {
    return glsl_fragment(R"(
        layout(location = 0) in vec2 uv;
        layout(location = 0) out vec4 color;
        void main() { color = vec4(uv, 0.0, 1.0); })");
}

TEST_F(ProgramTest, ConstantColourFillsThePicture) {
    const Stage fragment = glsl_fragment(R"(
        layout(location = 0) out vec4 color;
        void main() { color = vec4(0.1, -2.0, 1e6, 0.5); })");
    Draw draw = quad_draw(fragment, 8);
    draw.width = 16;
    const auto pictures = drawn(device(), draw);
    ASSERT_EQ(pictures.size(), 1u);
    EXPECT_EQ(pictures[0].width, 16);
    EXPECT_EQ(pictures[0].height, 8);
    EXPECT_THAT(pictures[0].pixels,
                testing::AllOf(testing::SizeIs(128), testing::Each(Pixel{0.1f, -2, 1e6f, 0.5f})));
}

TEST_F(ProgramTest, VaryingsOfTheQuadAreExactAtPowersOfTwo) {
    for (const int size : {1, 4, 64, 512}) {
        const auto pictures = drawn(device(), quad_draw(uv_fragment(), size));
        ASSERT_EQ(pictures.size(), 1u);
        int wrong = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const float scale = static_cast<float>(size);
                const Pixel expected{(static_cast<float>(x) + 0.5f) / scale,
                                     (static_cast<float>(y) + 0.5f) / scale, 0, 1};
                wrong += pictures[0].at(x, y) != expected;
            }
        }
        EXPECT_EQ(wrong, 0) << "of " << size * size << " pixels";
    }
}

// What a target of few bits holds is within one step of what was written; a device may truncate to
// half precision, and rounds unorm to the nearest.
TEST_F(ProgramTest, TargetsStoreWhatTheirFormatHolds) {
    const Stage fragment = glsl_fragment(R"(
        layout(location = 0) in vec2 uv;
        layout(location = 0) out vec4 color;
        void main() { color = vec4(uv.x * 0.9 + 0.03, uv.y * uv.y, uv.x - uv.y, uv.x * 2.0); })");
    constexpr int size = 64;
    const auto exact = drawn(device(), quad_draw(fragment, size));
    for (const Texture::Format format :
         {Texture::Format::Rgba8Unorm, Texture::Format::Rgba16Unorm, Texture::Format::Rgba16Float,
          Texture::Format::Rgba32Float}) {
        Draw draw = quad_draw(fragment, size);
        draw.target_format = format;
        const auto stored = drawn(device(), draw);
        ASSERT_EQ(stored.size(), 1u);
        double worst = 0;
        for (std::size_t pixel = 0; pixel < size * size; ++pixel)
            for (std::size_t k = 0; k < 4; ++k) {
                const double written = exact[0].pixels[pixel][k], held = stored[0].pixels[pixel][k];
                const bool unorm =
                    format == Texture::Format::Rgba8Unorm || format == Texture::Format::Rgba16Unorm;
                const double wanted = unorm ? std::clamp(written, 0.0, 1.0) : written;
                const double step = format == Texture::Format::Rgba8Unorm    ? 0.5001 / 255
                                    : format == Texture::Format::Rgba16Unorm ? 0.5001 / 65535
                                    : format == Texture::Format::Rgba16Float
                                        ? std::max(std::ldexp(std::fabs(wanted), -10), 6e-8)
                                        : 0;
                worst = std::max(worst, std::fabs(held - wanted) - step);
            }
        EXPECT_LE(worst, 1e-7) << name_of(format);
    }
}

TEST_F(ProgramTest, MapQuadCameraIsThePlainQuad) {
    Draw draw = quad_draw(uv_fragment(), 64);
    const auto plain = drawn(device(), draw);
    draw.vertex = glsl_vertex(R"(
        layout(location = 3) in vec3 in_position;
        layout(location = 5) in vec2 a_uv;
        layout(binding = 0) uniform View { vec4 view_projection[4]; };
        layout(location = 0) out vec2 uv;
        void main() {
            vec4 p = vec4(in_position, 1.0);
            gl_Position = vec4(dot(view_projection[0], p), dot(view_projection[1], p),
                               dot(view_projection[2], p), dot(view_projection[3], p));
            uv = a_uv;
        })");
    const auto table = map_quad().view_projection;
    draw.uniforms["view_projection"] = {table.begin(), table.end()};
    const auto through_camera = drawn(device(), draw);
    ASSERT_EQ(through_camera.size(), 1u);
    EXPECT_TRUE(same_bits(plain[0], through_camera[0]));
}

TEST_F(ProgramTest, UniformsReachBothStagesAtTheirOffsets) {
    Draw draw = quad_draw(glsl_fragment(R"(
        layout(set = 1, binding = 3) uniform Numbers {
            float a; vec3 b; vec2 c[3]; int steps; uint bits;
        };
        layout(location = 0) in vec2 shift;
        layout(location = 0) out vec4 first;
        layout(location = 1) out vec4 second;
        void main() {
            first = vec4(a, b);
            second = vec4(c[2], float(steps) + shift.x, float(bits) + shift.y);
        })"),
                          4);
    draw.vertex = glsl_vertex(R"(
        layout(location = 0) in vec3 position;
        layout(set = 0, binding = 0) uniform Place { vec2 offset; };
        layout(location = 0) out vec2 shift;
        void main() { gl_Position = vec4(position.xy * 2.0 - 1.0, 0.0, 1.0); shift = offset; })");
    draw.uniforms = {{"a", {1}},           {"b", {2, 3, 4}},  {"c", {5, 6, 7, 8, 9, 10}},
                     {"steps", {-4}},      {"bits", {65536}}, {"offset", {100, 200}},
                     {"unused", {1, 2, 3}}};
    auto program = Program::prepare(device(), draw);
    ASSERT_TRUE(program.ok()) << to_string(program.error());
    auto pictures = program->draw();
    ASSERT_TRUE(pictures.ok());
    ASSERT_EQ(pictures->size(), 2u);
    EXPECT_THAT((*pictures)[0].pixels, testing::Each(Pixel{1, 2, 3, 4}));
    EXPECT_THAT((*pictures)[1].pixels, testing::Each(Pixel{9, 10, 96, 65736}));

    ASSERT_TRUE(program->set_uniform("b", {-2, -3, -4}).ok());
    ASSERT_TRUE(program->set_uniform("offset", {0, 0}).ok());
    ASSERT_TRUE(program->set_uniform("unknown", {0}).ok());
    EXPECT_EQ(program->set_uniform("b", {1}).error().code, "bad-uniform");
    pictures = program->draw();
    ASSERT_TRUE(pictures.ok());
    EXPECT_THAT((*pictures)[0].pixels, testing::Each(Pixel{1, -2, -3, -4}));
    EXPECT_THAT((*pictures)[1].pixels, testing::Each(Pixel{9, 10, -4, 65536}));
}

TEST_F(ProgramTest, WhatTheShaderDoesNotWriteKeepsTheClearColour) {
    Draw draw = quad_draw(glsl_fragment(R"(
        layout(location = 1) out vec2 color;
        void main() { color = vec2(1.0, 2.0); })"),
                          2);
    draw.clear = {0.25f, 0.5f, 0.75f, 8};
    draw.colour_targets = 3;
    const auto pictures = drawn(device(), draw);
    ASSERT_EQ(pictures.size(), 3u);
    EXPECT_THAT(pictures[0].pixels, testing::Each(Pixel{0.25f, 0.5f, 0.75f, 8}));
    EXPECT_THAT(pictures[1].pixels, testing::Each(Pixel{1, 2, 0.75f, 8}));
    EXPECT_THAT(pictures[2].pixels, testing::Each(Pixel{0.25f, 0.5f, 0.75f, 8}));
}

// Two triangles over the whole target: the first at depth 0.25 with uv 1, the second at 0.75 with
// uv 2.
Mesh near_then_far() {
    Mesh mesh;
    for (const float depth : {0.25f, 0.75f}) {
        for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {3.0f, -1.0f}, {-1.0f, 3.0f}}) {
            mesh.vertices.push_back(
                {{x, y, depth}, {0, 0, 1}, {1, 0, 0, 1}, {depth < 0.5f ? 1.0f : 2.0f, 0}});
        }
    }
    mesh.indices = {0, 1, 2, 3, 4, 5};
    return mesh;
}

TEST_F(ProgramTest, DepthTestLetsTheNearerWin) {
    const Mesh mesh = near_then_far();
    Draw draw = quad_draw(uv_fragment(), 8);
    draw.mesh = &mesh;
    draw.vertex = glsl_vertex(R"(
        layout(location = 0) in vec3 position;
        layout(location = 1) in vec2 texcoord0;
        layout(location = 0) out vec2 uv;
        void main() { gl_Position = vec4(position, 1.0); uv = texcoord0; })");
    EXPECT_THAT(drawn(device(), draw).at(0).pixels,
                testing::Each(testing::ElementsAre(2, 0, 0, 1)));
    draw.depth_test = true;
    EXPECT_THAT(drawn(device(), draw).at(0).pixels,
                testing::Each(testing::ElementsAre(1, 0, 0, 1)));
}

// The frame, read through the device: uv must grow along the tangent and the bitangent in the
// picture as well.
TEST_F(ProgramTest, SphereShowsTheMapUpright) {
    const Mesh mesh = sphere(64);
    Draw draw = quad_draw(glsl_fragment(R"(
        layout(location = 0) in vec2 uv;
        layout(location = 0) out vec4 color;
        void main() { color = vec4(uv, 0.0, 1.0); })"),
                          64);
    draw.mesh = &mesh;
    draw.depth_test = true;
    draw.vertex = glsl_vertex(R"(
        layout(location = 0) in vec3 position;
        layout(location = 1) in vec2 uv;
        layout(binding = 0) uniform View { vec4 view_projection[4]; };
        layout(location = 0) out vec2 out_uv;
        void main() {
            vec4 p = vec4(position, 1.0);
            gl_Position = vec4(dot(view_projection[0], p), dot(view_projection[1], p),
                               dot(view_projection[2], p), dot(view_projection[3], p));
            out_uv = uv;
        })");
    const auto camera = look_at({-3, 0, 0}, {0, 0, 0}, {0, 0, 1}, {.vertical_degrees = 45});
    ASSERT_TRUE(camera.ok());
    draw.uniforms["view_projection"] = {camera->view_projection.begin(),
                                        camera->view_projection.end()};
    const Picture picture = drawn(device(), draw).at(0);
    EXPECT_EQ(picture.at(0, 0), (Pixel{0, 0, 0, 0})) << "the corner sees no sphere";
    for (int i = 16; i < 47; ++i) {
        EXPECT_LT(picture.at(i, 32)[0], picture.at(i + 1, 32)[0]) << "u grows to the right";
        EXPECT_LT(picture.at(32, i)[1], picture.at(32, i + 1)[1]) << "v grows downwards";
    }
    // Seen from -x the middle is half a turn from u = 0, halfway between the poles.
    EXPECT_NEAR(picture.at(32, 32)[0], 0.5f, 0.02f);
    EXPECT_NEAR(picture.at(32, 32)[1], 0.5f, 0.02f);
}

TEST_F(ProgramTest, TimesArePositiveAndFollowTheWork) {
    Draw draw = quad_draw(glsl_fragment(R"(
        layout(location = 0) in vec2 uv;
        layout(binding = 0) uniform Work { int steps; };
        layout(location = 0) out vec4 color;
        void main() {
            float x = uv.x;
            for (int i = 0; i < steps; ++i) x = x * 0.75 + uv.y;
            color = vec4(x);
        })"),
                          256);
    draw.uniforms["steps"] = {1};
    auto program = Program::prepare(device(), draw);
    ASSERT_TRUE(program.ok()) << to_string(program.error());
    double few = 1e300, many = 1e300;
    for (int i = 0; i < 3; ++i) {
        for (double* fastest : {&few, &many}) {
            ASSERT_TRUE(program->set_uniform("steps", {fastest == &few ? 1.0f : 1000.0f}).ok());
            const auto time = program->time_draw();
            ASSERT_TRUE(time.ok());
            ASSERT_GT(*time, 0);
            *fastest = std::min(*fastest, *time);
        }
    }
    // 1000 steps are several hundred times the work of one; a busy machine does not hide a factor
    // of 3 in minima.
    EXPECT_GT(many, 3 * few);
}

TEST_F(ProgramTest, AlternateDrawsGiveTheSameBitsAsAlone) {
    Draw first = quad_draw(uv_fragment(), 64);
    Draw second = quad_draw(glsl_fragment(R"(
        layout(location = 0) in vec2 uv;
        layout(binding = 0) uniform Scale { vec2 scale; };
        layout(location = 0) out vec4 color;
        void main() { color = vec4(sin(uv * scale), pow(uv, scale)); })"),
                            32);
    second.uniforms["scale"] = {7, 0.3f};
    const auto first_alone = drawn(device(), first), second_alone = drawn(device(), second);
    auto a = Program::prepare(device(), first), b = Program::prepare(device(), second);
    ASSERT_TRUE(a.ok() && b.ok());
    for (int i = 0; i < 3; ++i) {
        const auto from_a = a->draw();
        const auto from_b = b->draw();
        ASSERT_TRUE(from_a.ok() && from_b.ok());
        ASSERT_TRUE(a->time_draw().ok());
        EXPECT_TRUE(same_bits((*from_a)[0], first_alone[0]));
        EXPECT_TRUE(same_bits((*from_b)[0], second_alone[0]));
    }
}

TEST_F(ProgramTest, MovedProgramStillDraws) {
    auto program = Program::prepare(device(), quad_draw(uv_fragment(), 4));
    ASSERT_TRUE(program.ok());
    std::vector<Program> programs;
    programs.push_back(std::move(*program));
    EXPECT_TRUE(programs[0].draw().ok());
}

}  // namespace
}  // namespace intaglio::vulkan

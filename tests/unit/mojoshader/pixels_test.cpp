// The same bytes twice: through MojoShader, glslang and lavapipe, and through our decoder and
// interpreter.  Both must give the same pixels, and a single wrong swizzle must not.
#include <algorithm>
#include <cmath>
#include <random>

#include "generator/target/d3d9/interpret.h"
#include "src/check/mojoshader.h"
#include "tests/unit/mojoshader/shaders.h"
#include "tests/unit/vulkan/harness.h"

namespace intaglio::d3d9 {
namespace {

using vulkan::Picture;
using Values = std::map<std::string, std::vector<float>>;
using Set = Constant::Set;

constexpr int size = 32;  // a power of two: varyings of the quad are exact

// Noise with mip levels, the same for the device and for the interpreter.
struct Map {
    vulkan::Texture device;
    ir::Texture host;
    Map(std::uint32_t seed, bool linear) {
        std::mt19937 random(seed);
        std::uniform_int_distribution<int> step(0, 255);
        for (int level = 0; level < 3; ++level) {
            std::vector<float> texels(static_cast<std::size_t>(16 >> level) * (16u >> level) * 4);
            for (float& value : texels) value = static_cast<float>(step(random)) / 255.0f;
            device.levels.push_back(texels);
        }
        device.width = device.height = host.width = host.height = 16;
        // lavapipe filters 8-bit textures with 8-bit weights, and these with binary32.
        device.format = vulkan::Texture::Format::Rgba32Float;
        host.levels = device.levels;
        device.filter = linear ? vulkan::Texture::Filter::Linear : vulkan::Texture::Filter::Nearest;
        host.filter = linear ? ir::Texture::Filter::Linear : ir::Texture::Filter::Nearest;
    }
};

struct Scene {
    Shader vertex, pixel;
    Values values;
    std::map<std::string, const Map*> maps;
};

class Pixels : public vulkan::OnDevice {
  protected:
    static Picture by_mojoshader(const Scene& scene) {
        const auto program = check::link_d3d9(encode(scene.vertex), encode(scene.pixel));
        if (!program) {
            ADD_FAILURE() << to_string(program.error());
            return {};
        }
        vulkan::Draw draw = vulkan::quad_draw({.spirv = program->spirv.pixel}, size);
        draw.vertex = {.spirv = program->spirv.vertex};
        const auto uniforms = check::uniforms_of(*program, scene.values);
        if (!uniforms) {
            ADD_FAILURE() << to_string(uniforms.error());
            return {};
        }
        draw.uniforms = *uniforms;
        for (const auto& [name, in_program] : program->stages[1].textures)
            draw.textures[in_program] = &scene.maps.at(name)->device;
        const auto pictures = vulkan::drawn(device(), draw);
        return pictures.empty() ? Picture{} : pictures[0];
    }

    static Interpreter interpreter_of(const Shader& shader) {
        const auto decoded = decode(encode(shader));
        if (!decoded) throw std::runtime_error(to_string(decoded.error()));
        auto interpreter = Interpreter::prepare(*decoded);
        if (!interpreter) throw std::runtime_error(to_string(interpreter.error()));
        return *interpreter;
    }

    // The pixel's place goes through the vertex shader, which is affine in it.
    static Inputs inputs_at(const Scene& scene, const Interpreter& vertex,
                            const Environment& environment, int x, int y) {
        Inputs corner, inputs;
        const Vector uv = {(static_cast<float>(x) + 0.5f) / size,
                           (static_cast<float>(y) + 0.5f) / size, 0, 1};
        set_input(scene.vertex, corner, Usage::Position, 0, uv);
        set_input(scene.vertex, corner, Usage::Texcoord, 0, uv);
        const Execution at = vertex.run(environment, corner, Arithmetic::Fp32);
        for (int i = 0; i < 2; ++i)
            set_input(scene.pixel, inputs, Usage::Texcoord, i,
                      output_of(scene.vertex, at, Usage::Texcoord, i));
        return inputs;
    }

    static Picture by_interpreter(const Scene& scene) {
        std::map<std::string, const ir::Texture*> textures;
        for (const auto& [name, map] : scene.maps) textures[name] = &map->host;
        const auto vertex_environment = environment_of(scene.vertex, scene.values, {});
        const auto pixel_environment = environment_of(scene.pixel, scene.values, textures);
        const Interpreter vertex = interpreter_of(scene.vertex),
                          pixel = interpreter_of(scene.pixel);
        Picture picture{size, size, std::vector<Vector>(std::size_t{size} * size)};
        for (int y = 0; y < size; y += 2) {
            for (int x = 0; x < size; x += 2) {
                std::array<Inputs, 4> inputs;
                for (int i = 0; i < 4; ++i)
                    inputs[static_cast<std::size_t>(i)] =
                        inputs_at(scene, vertex, *vertex_environment, x + i % 2, y + i / 2);
                const auto quad = pixel.run_quad(*pixel_environment, inputs, Arithmetic::Fp32);
                for (int i = 0; i < 4; ++i)
                    picture.pixels[static_cast<std::size_t>((y + i / 2) * size + x + i % 2)] =
                        quad[static_cast<std::size_t>(i)].colours[0];
            }
        }
        return picture;
    }

    // The greatest difference; infinite if any is NaN.
    static float worst(const Picture& a, const Picture& b) {
        if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return INFINITY;
        float result = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i) {
            for (std::size_t lane = 0; lane < 4; ++lane) {
                const float difference = std::fabs(a.pixels[i][lane] - b.pixels[i][lane]);
                result = std::max(result, std::isnan(difference) ? INFINITY : difference);
            }
        }
        return result;
    }

    // How much the picture varies: a test of constant pixels would say little.
    static float spread(const Picture& picture) {
        float low = INFINITY, high = -INFINITY;
        for (const auto& pixel : picture.pixels) {
            low = std::min(low, pixel[0]);
            high = std::max(high, pixel[0]);
        }
        return high - low;
    }
};

// oT0 is uv, oT1 turned and scaled.
Shader model_2_vertex() {
    return assembled(
        "vs_2_0\ndcl_position v0\ndcl_texcoord0 v1\nmad oPos, v0, c0, c1\nmov oT0, v1\nmul r0, "
        "v1.yxzw, c2\nadd oT1, r0, c3\n",
        {{"scale", Set::Float4, 0, 1, 4, 1},
         {"shift", Set::Float4, 1, 1, 4, 1},
         {"turn", Set::Float4, 2, 2, 4, 2}});
}

Shader model_3_vertex() {
    return assembled(
        "vs_3_0\ndcl_position v0\ndcl_texcoord0 v1\ndcl_position o0\ndcl_texcoord0 "
        "o1\ndcl_texcoord1 o2\nmad o0, v0, c0, c1\nmov o1, v1\nmul r0, v1.yxzw, c2\nadd o2, r0, "
        "c3\n",
        {{"scale", Set::Float4, 0, 1, 4, 1},
         {"shift", Set::Float4, 1, 1, 4, 1},
         {"turn", Set::Float4, 2, 2, 4, 2}});
}

const Values vertex_values = {{"scale", {2, 2, 0, 1}},
                              {"shift", {-1, -1, 0, 0}},
                              {"turn", {0.5f, -0.75f, 1, 1, 0.25f, 0.125f, 0.5f, 0}}};

Scene lit_scene() {
    static const Map normals(1, true), colours(2, true);
    Scene scene;
    scene.vertex = model_2_vertex();
    scene.pixel = assembled(
        "ps_2_0\ndef c8, 2, -1, 0.5, 0.1\ndcl t0.xy\ndcl t1.xyz\ndcl_2d s0\ndcl_2d s3\nnrm r0.xyz, "
        "t1\nmad r1.xy, r0, c0.x, t0\nmov r1.zw, c8.w\ntexld r2, r1, s0\ntexld r3, t0, s3\nmad "
        "r2.xyz, r2, c8.x, c8.y\nnrm r4.xyz, r2\ndp3_sat r5.w, r4, c1\nadd r6.xyz, r0, c1\nnrm "
        "r7.xyz, r6\ndp3_sat r6.w, r7, r4\npow r7.w, r6.w, c0.y\nmax r5.w, r5.w, c8.w\nlrp r8.xyz, "
        "r5.w, r3, r4.yzxw\ncmp r9.xyz, r4, r8, r3.zxyw\nmad r9.xyz, r7.w, c8.z, r9\ncrs r10.xyz, "
        "r4, "
        "r0\nadd r9.xyz, r9, -r10\nabs r9.w, r10.x\nfrc r11.xyz, r9\ndp2add r9.w, r9, r3, "
        "r9.w\nmin "
        "r9.xyz, r9, r11\nmov oC0, r9\n",
        {{"amounts", Set::Float4, 0, 1, 2, 1},
         {"light", Set::Float4, 1, 1, 3, 1},
         {"normal_map", Set::Sampler, 0, 1, 0, 1},
         {"colour_map", Set::Sampler, 3, 1, 0, 1}});
    scene.values = vertex_values;
    scene.values["amounts"] = {0.05f, 3};
    scene.values["light"] = {0.36f, 0.48f, 0.8f};
    scene.maps = {{"normal_map", &normals}, {"colour_map", &colours}};
    return scene;
}

Scene march_scene() {
    static const Map heights(3, false), colours(4, true);
    Scene scene;
    scene.vertex = model_3_vertex();
    scene.pixel = assembled(
        "ps_3_0\ndef c8, 1, 0, 0.0625, 0\ndefi i0, 16, 0, 0, 0\ndcl_texcoord0 v0.xy\ndcl_texcoord1 "
        "v1.xyz\ndcl_2d s1\ndcl_2d s2\nmov r0, c8.y\nmov r0.xy, v0\nmov r1.x, c8.x\nmov r3, "
        "c8.y\nrep i0\ntexldl r2, r0, s1\nbreak_gt r2.x, r1.x\nadd r1.x, r1.x, -c0.z\nmad r0.xy, "
        "v1, "
        "c0, r0\nadd r3.x, r3.x, c8.z\nif_lt r2.y, r1.x\nadd r3.y, r3.y, c8.z\nelse\nif_gt r2.z, "
        "r2.w\nbreak\nendif\nendif\nendrep\nmov r4.xy, r0\nmov r4.zw, c0.w\ntexldl r4, r4, "
        "s2.yxzw\nadd r3.zw, r4.xyxy, r1.x\nmov oC0, r3\n",
        {{"step", Set::Float4, 0, 1, 4, 1},
         {"height_map", Set::Sampler, 1, 1, 0, 1},
         {"colour_map", Set::Sampler, 2, 1, 0, 1}});
    scene.values = vertex_values;
    // Steps of height by 1/32 - 1/1000 from 1: never near one of the map's 255 steps.
    scene.values["step"] = {0.03125f, 0.0625f, 0.0303f, 1.5f};
    scene.maps = {{"height_map", &heights}, {"colour_map", &colours}};
    return scene;
}

// What the other two have not: derivatives, projection, functions, a matrix.
Scene functions_scene() {
    static const Map colours(5, true);
    Scene scene;
    scene.vertex = model_3_vertex();
    scene.pixel = assembled(
        "ps_3_0\ndef c8, 2, 1, 0.5, 0.25\ndcl_texcoord0 v0.xy\ndcl_texcoord1 v1.xyz\ndcl_2d "
        "s0\nmov r0, v1.xyzx\nmul r1, r0, r0.yzwx\ndsx r2, r1\ndsy r3, r1\nadd r2, r2, r3\nadd "
        "r4.x, v0.x, c8.y\nexp r5.x, r4.x\nlog r5.y, r4.x\nrcp r5.z, r4.x\nrsq r5.w, "
        "r4.x\nsincos r6.xy, r4.x\nadd r6.zw, r5.xyxy, c8.x\nmov r7.xy, v0\nmov r7.zw, "
        "r4.x\ntexldp r7, r7, s0\nm3x3 r8.xyz, r5, c9\nmov r8.w, r7_abs.x\ndp4 r9, r6, r5\nmad "
        "r9, r2, c8.x, r9\nadd r9, r9, r7\nadd oC0, r9, r8\n",
        {{"matrix", Set::Float4, 9, 3, 3, 3}, {"colour_map", Set::Sampler, 0, 1, 0, 1}});
    scene.values = vertex_values;
    scene.values["matrix"] = {0.5f, -1, 0.25f, 0.125f, 0.5f, 1, -0.75f, 0.5f, 2};
    scene.maps = {{"colour_map", &colours}};
    return scene;
}

// Some twenty roundings of numbers below 4, and nrm and pow by other formulas: 20 * 4 * 2^-24 is
// 5e-6; lavapipe's pow adds 4e-6 of its result, and its filter 1e-7.
constexpr float bound = 1e-5f;

TEST_F(Pixels, Model2AgreesWithTheInterpreter) {
    const Scene scene = lit_scene();
    const Picture expected = by_interpreter(scene);
    EXPECT_GT(spread(expected), 0.5f);
    const float difference = worst(by_mojoshader(scene), expected);
    RecordProperty("worst", std::to_string(difference * 1e6) + "e-6");
    EXPECT_LT(difference, bound);
}

TEST_F(Pixels, FunctionsAndDerivativesAgreeWithTheInterpreter) {
    const Scene scene = functions_scene();
    const Picture expected = by_interpreter(scene);
    EXPECT_GT(spread(expected), 0.5f);
    const float difference = worst(by_mojoshader(scene), expected);
    RecordProperty("worst", std::to_string(difference * 1e6) + "e-6");
    EXPECT_LT(difference, bound);
}

TEST_F(Pixels, Model3LoopAgreesWithTheInterpreter) {
    const Scene scene = march_scene();
    const Picture expected = by_interpreter(scene);
    EXPECT_GT(spread(expected), 0.2f) << "pixels must leave the loop at different turns";
    const float difference = worst(by_mojoshader(scene), expected);
    RecordProperty("worst", std::to_string(difference * 1e6) + "e-6");
    EXPECT_LT(difference, bound);
}

// One token of the bytecode changed: the swizzle of the source at hand reads another component.
void break_swizzle(Shader& shader, std::size_t instruction, std::size_t source) {
    const auto before = encode(shader);
    Swizzle& swizzle = shader.instructions[instruction].sources[source].swizzle;
    for (std::uint8_t& component : swizzle) component = static_cast<std::uint8_t>(component ^ 1u);
    const auto after = encode(shader);
    int changed = 0;
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i)
        changed += before[i] != after[i];
    EXPECT_EQ(changed, 1);
}

TEST_F(Pixels, AWrongSwizzleIsCaught) {
    const Scene lit = lit_scene(), march = march_scene();
    const Picture lit_expected = by_interpreter(lit), march_expected = by_interpreter(march);
    for (const std::size_t instruction : {1u, 5u, 13u, 14u}) {  // mad, mad, lrp, cmp
        Scene broken = lit;
        break_swizzle(broken.pixel, instruction, 0);
        EXPECT_GT(worst(by_mojoshader(broken), lit_expected), 100 * bound)
            << text_of(broken.pixel.instructions[instruction]);
    }
    for (const std::size_t instruction : {6u, 8u, 10u}) {  // break_gt, mad, if_lt
        Scene broken = march;
        break_swizzle(broken.pixel, instruction, 0);
        EXPECT_GT(worst(by_mojoshader(broken), march_expected), 100 * bound)
            << text_of(broken.pixel.instructions[instruction]);
    }
}

TEST_F(Pixels, AVertexStageInGlslFeedsThePixelStage) {
    check::Source vertex;
    vertex.language = check::Language::Glsl330;
    vertex.stage = check::Stage::Vertex;
    vertex.text =
        "#version 330\nin vec3 position; in vec2 uv; out vec4 mojo_texcoord0;\nvoid main() { "
        "gl_Position = vec4(position.xy * 2.0 - 1.0, 0.0, 1.0); mojo_texcoord0 = vec4(uv, 0, 1); "
        "}\n";
    const auto bytecode =
        encode(assembled("ps_2_0\ndcl t0.xy\nmov r0, c0\nmov r0.xy, t0\nmov oC0, r0\n"));
    const auto program = check::link_d3d9(vertex, bytecode);
    ASSERT_TRUE(program.ok()) << to_string(program.error());
    vulkan::Draw draw = vulkan::quad_draw({.spirv = program->spirv.pixel}, 4);
    draw.vertex = {.spirv = program->spirv.vertex};
    const auto uniforms = check::uniforms_of(*program, {{"c0", {0, 0, 0.25f, 4}}});
    ASSERT_TRUE(uniforms.ok());
    draw.uniforms = *uniforms;
    const auto pictures = vulkan::drawn(device(), draw);
    ASSERT_EQ(pictures.size(), 1u);
    EXPECT_THAT(pictures[0].at(1, 2), testing::ElementsAre(0.375f, 0.625f, 0.25f, 4));

    const auto unfed = encode(assembled("ps_2_0\ndcl t3\nmov r0, t3\nmov oC0, r0\n"));
    EXPECT_FALSE(check::link_d3d9(vertex, unfed).ok());
}

}  // namespace
}  // namespace intaglio::d3d9

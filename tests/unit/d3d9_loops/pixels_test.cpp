// The bytes of generated loops through MojoShader, glslang and lavapipe, and through our decoder
// and interpreter: the same pixels.
#include <algorithm>
#include <cmath>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/interpret.h"
#include "src/check/mojoshader.h"
#include "tests/unit/d3d9_generate/surfaces.h"
#include "tests/unit/vulkan/harness.h"

namespace intaglio::d3d9 {
namespace {

using vulkan::Picture;

constexpr int size = 32;  // a power of two: varyings of the quad are exact

// The surface's interpolants are affine over the quad: uv, and the eye and the light aslant.
constexpr const char* vertex_text =
    "#version 330\nin vec3 position; in vec2 uv; out vec4 mojo_texcoord0; out vec4 "
    "mojo_texcoord1; out vec4 mojo_texcoord2;\nvoid main() { gl_Position = vec4(position.xy * 2.0 "
    "- 1.0, 0.0, 1.0); mojo_texcoord0 = vec4(uv, 0, 1); mojo_texcoord1 = vec4(uv * 2.0 - 0.75, "
    "0.5, 1); mojo_texcoord2 = vec4(0.5 - uv.yx, 0.75, 1); }\n";

// The texcoords at the middle of a pixel.
Inputs inputs_at(const Shader& shader, int x, int y) {
    const float u = (static_cast<float>(x) + 0.5f) / size,
                v = (static_cast<float>(y) + 0.5f) / size;
    Inputs inputs;
    set_input(shader, inputs, Usage::Texcoord, 0, {u, v, 0, 1});
    set_input(shader, inputs, Usage::Texcoord, 1, {u * 2 - 0.75f, v * 2 - 0.75f, 0.5f, 1});
    set_input(shader, inputs, Usage::Texcoord, 2, {0.5f - v, 0.5f - u, 0.75f, 1});
    return inputs;
}

struct Map {
    vulkan::Texture device;
    ir::Texture host;
    // Hills: smooth, so that a rounding of the coordinate moves little.
    Map() {
        std::vector<float> texels;
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x)
                for (int c = 0; c < 4; ++c)
                    texels.push_back(
                        0.5f +
                        0.24f * std::sin(static_cast<float>(x) * 0.19635f + static_cast<float>(c)) +
                        0.24f * std::cos(static_cast<float>(y) * 0.3927f));
        device.levels = host.levels = {texels};
        device.width = device.height = host.width = host.height = 32;
        device.format = vulkan::Texture::Format::Rgba32Float;
        device.filter = vulkan::Texture::Filter::Linear;
        host.filter = ir::Texture::Filter::Linear;
    }
};

class LoopPixels : public vulkan::OnDevice {
  protected:
    using Values = std::map<std::string, std::vector<float>>;

    static Values values_of(const Shader& shader) {
        Values values;
        float next = 0.07f;
        for (const Constant& constant : shader.constants) {
            if (constant.set != Constant::Set::Float4) continue;
            for (int k = 0; k < constant.columns * constant.count; ++k, next += 0.03f)
                values[constant.name].push_back(next);
        }
        return values;
    }

    static Picture by_mojoshader(const Shader& shader, const Map& map) {
        check::Source vertex;
        vertex.language = check::Language::Glsl330;
        vertex.stage = check::Stage::Vertex;
        vertex.text = vertex_text;
        const auto program = check::link_d3d9(vertex, encode(shader));
        if (!program) {
            ADD_FAILURE() << to_string(program.error());
            return {};
        }
        vulkan::Draw draw = vulkan::quad_draw({.spirv = program->spirv.pixel}, size);
        draw.vertex = {.spirv = program->spirv.vertex};
        const auto uniforms = check::uniforms_of(*program, values_of(shader));
        if (!uniforms) {
            ADD_FAILURE() << to_string(uniforms.error());
            return {};
        }
        draw.uniforms = *uniforms;
        for (const check::D3d9Stage& stage : program->stages)
            for (const auto& [name, in_program] : stage.textures)
                draw.textures[in_program] = &map.device;
        const auto pictures = vulkan::drawn(device(), draw);
        return pictures.empty() ? Picture{} : pictures[0];
    }

    static Picture by_interpreter(const Shader& shader, const Map& map) {
        const auto decoded = decode(encode(shader));
        const auto interpreter = Interpreter::prepare(*decoded);
        std::map<std::string, const ir::Texture*> textures;
        for (const Constant& constant : shader.constants)
            if (constant.set == Constant::Set::Sampler) textures[constant.name] = &map.host;
        const auto environment = environment_of(shader, values_of(shader), textures);
        Picture picture{size, size, std::vector<Vector>(std::size_t{size} * size)};
        if (!interpreter || !environment) {
            ADD_FAILURE();
            return picture;
        }
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
                picture.pixels[static_cast<std::size_t>(y * size + x)] =
                    interpreter->run(*environment, inputs_at(shader, x, y), Arithmetic::Fp32)
                        .colours[0];
        return picture;
    }
};

// Two quads over each other, the second with u the other way round: what is dropped shows what is
// behind, and of two that stay the nearer by oDepth is seen.
class OutputPixels : public LoopPixels, public ::testing::WithParamInterface<Profile> {};
INSTANTIATE_TEST_SUITE_P(Profiles, OutputPixels, ::testing::ValuesIn(pixel_profiles()),
                         [](const auto& test) { return std::string(name_of(test.param)); });

constexpr std::string_view depth_and_clip = R"(pixel "depth_and_clip"
input uv float2 interpolant
output colour float4 target
output depth float1 depth
output inside float1 clip
{
%0 float2 = input uv
%1 float1 = swizzle %0.x
%2 float1 = swizzle %0.y
%3 float1 = mul %1, %1
%4 float1 = const 0.25
%5 float1 = mul %3, %4
%6 float1 = sub %3, %5
%7 float1 = add %1, %2
%8 float1 = const 0.9
%9 float1 = sub %7, %8
%10 float4 = compose %0, %3, %7
return (%10, %6, %9)
}
)";

TEST_P(OutputPixels, AreDroppedAndTestedByDepth) {
    const auto shader = generate_pixel(program_of_pixel(depth_and_clip), GetParam());
    ASSERT_TRUE(shader) << shader.error().message;
    check::Source vertex;
    vertex.language = check::Language::Glsl330;
    vertex.stage = check::Stage::Vertex;
    vertex.text = vertex_text;
    const auto program = check::link_d3d9(vertex, encode(*shader));
    ASSERT_TRUE(program) << to_string(program.error());
    vulkan::Mesh mesh = vulkan::unit_quad();
    const std::size_t corners = mesh.vertices.size();
    for (std::size_t i = 0; i < corners; ++i) {
        mesh.vertices.push_back(mesh.vertices[i]);
        mesh.vertices.back().uv[0] = 1 - mesh.vertices.back().uv[0];
    }
    const std::size_t indices = mesh.indices.size();
    for (std::size_t i = 0; i < indices; ++i)
        mesh.indices.push_back(mesh.indices[i] + static_cast<std::uint32_t>(corners));
    vulkan::Draw draw = vulkan::quad_draw({.spirv = program->spirv.pixel}, size);
    draw.vertex = {.spirv = program->spirv.vertex};
    draw.mesh = &mesh;
    draw.depth_test = true;
    draw.clear = {-1, -1, -1, -1};
    const auto pictures = vulkan::drawn(device(), draw);
    ASSERT_FALSE(pictures.empty());
    const auto interpreter = Interpreter::prepare(*shader);
    const auto environment = environment_of(*shader, {}, {});
    ASSERT_TRUE(interpreter && environment);
    int none = 0, first = 0, second = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            Vector expected{-1, -1, -1, -1};
            float nearest = 2;
            int seen = 0;
            for (const int quad : {1, 2}) {
                const Inputs inputs = inputs_at(*shader, quad == 1 ? x : size - 1 - x, y);
                const Execution got = interpreter->run(*environment, inputs, Arithmetic::Fp32);
                if (got.killed || got.depth >= nearest) continue;
                nearest = got.depth;
                expected = got.colours[0];
                seen = quad;
            }
            (seen == 0 ? none : seen == 1 ? first : second) += 1;
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_NEAR(pictures[0].at(x, y)[k], expected[k], 1e-5f) << x << " " << y;
        }
    // All three kinds are there.
    EXPECT_GT(std::min({none, first, second}), 20);
}

// A pixel whose ray just touches the relief may leave the loop a turn earlier on one side: at most
// one in fifty.  The others differ by roundings of some hundred operations.
TEST_F(LoopPixels, AgreeWithTheInterpreter) {
    const Map map;
    const std::vector<Case> cases = {
        {"search=steep_parallax,output=displaced", {}},
        {"search=steep_parallax,shadow=march,output=displaced", {{"max_steps", "300"}}},
        {"parallax_occlusion,output=displaced", {{"taps", "12"}}},
    };
    for (const Case& a_case : cases) {
        SCOPED_TRACE(a_case.name());
        const auto program = record(a_case, Profile::ps_3_0);
        ASSERT_TRUE(program) << program.error().message;
        const auto shader = generate_pixel(*program, Profile::ps_3_0);
        ASSERT_TRUE(shader) << shader.error().message;
        const Picture expected = by_interpreter(*shader, map), drawn = by_mojoshader(*shader, map);
        ASSERT_EQ(drawn.pixels.size(), expected.pixels.size());
        int differing = 0;
        float low = INFINITY, high = -INFINITY;
        for (std::size_t i = 0; i < drawn.pixels.size(); ++i) {
            bool same = true;
            for (std::size_t lane = 0; lane < 4; ++lane)
                same = same && std::fabs(drawn.pixels[i][lane] - expected.pixels[i][lane]) <= 1e-4f;
            differing += !same;
            low = std::min(low, expected.pixels[i][2]);
            high = std::max(high, expected.pixels[i][2]);
        }
        EXPECT_LE(differing, size * size / 50) << print(*shader);
        EXPECT_GT(high - low, 0.2f) << "rays must end at different heights";
    }
}

}  // namespace
}  // namespace intaglio::d3d9

// What a draw lacks or gets wrong is a sentence that names it.
#include "tests/unit/vulkan/harness.h"

namespace intaglio::vulkan {
namespace {

using testing::HasSubstr;

class MissingNames : public OnDevice {
  protected:
    Draw complete() {
        Draw draw = quad_draw(glsl_fragment(R"(
            layout(location = 0) in vec2 uv;
            layout(binding = 0) uniform sampler2D height_map;
            layout(binding = 1) uniform Relief { float depth_scale; vec3 light; };
            layout(location = 0) out vec4 color;
            void main() { color = texture(height_map, uv) * depth_scale + vec4(light, 0.0); })"),
                              4);
        texture_.width = texture_.height = 1;
        texture_.levels = {{0.5f, 0.5f, 0.5f, 0.5f}};
        draw.textures["height_map"] = &texture_;
        draw.uniforms = {{"depth_scale", {2}}, {"light", {0, 0, 1}}};
        return draw;
    }
    Texture texture_;
};

TEST_F(MissingNames, NothingIsWrongWithTheCompleteDraw) {
    EXPECT_EQ(drawn(device(), complete()).size(), 1u);
}

TEST_F(MissingNames, Uniform) {
    Draw draw = complete();
    draw.uniforms.erase("light");
    draw.uniforms["lamp"] = {0, 0, 1};
    EXPECT_EQ(refusal(device(), draw),
              "error: the fragment shader needs the uniform 'light', which was not given; "
              "uniforms given: depth_scale, lamp [missing-uniform]");
}

TEST_F(MissingNames, UniformOfTheWrongSize) {
    Draw draw = complete();
    draw.uniforms["light"] = {0, 1};
    EXPECT_EQ(refusal(device(), draw),
              "error: the uniform 'light' takes 3 values and was given 2 [bad-uniform]");
}

TEST_F(MissingNames, Texture) {
    Draw draw = complete();
    draw.textures.clear();
    EXPECT_EQ(refusal(device(), draw),
              "error: the fragment shader needs the texture 'height_map', which was not given; "
              "textures given: none [missing-texture]");
    draw.textures["height_map"] = nullptr;
    EXPECT_THAT(refusal(device(), draw), HasSubstr("[missing-texture]"));
}

TEST_F(MissingNames, Sampler) {
    Draw draw = complete();
    draw.fragment = compile(check::Language::Hlsl5, check::Stage::Pixel, R"(
        Texture2D height_map : register(t0);
        SamplerState linear_repeat : register(s0);
        float4 main(float2 uv : TEXCOORD0) : SV_Target {
            return height_map.Sample(linear_repeat, uv);
        })");
    EXPECT_EQ(refusal(device(), draw),
              "error: the fragment shader needs the sampler 'linear_repeat', and no given "
              "texture's name begins so; textures given: height_map [missing-texture]");
}

TEST_F(MissingNames, Attribute) {
    Draw draw = complete();
    draw.vertex = glsl_vertex(R"(
        layout(location = 0) in vec3 position;
        layout(location = 1) in vec4 bone_weights;
        layout(location = 0) out vec2 uv;
        void main() { gl_Position = vec4(position, 1.0); uv = bone_weights.xy; })");
    EXPECT_EQ(refusal(device(), draw),
              "error: the vertex shader needs the input 'bone_weights', which a mesh does not "
              "have; a mesh has: position, normal, tangent, uv [missing-attribute]");
}

TEST_F(MissingNames, Varying) {
    Draw draw = complete();
    draw.vertex = glsl_vertex(R"(
        layout(location = 0) in vec3 position;
        void main() { gl_Position = vec4(position, 1.0); })");
    EXPECT_EQ(refusal(device(), draw),
              "error: the fragment shader reads 'uv' (2 components) at location 0, which the "
              "vertex shader does not write [unmatched-varying]");
}

TEST_F(MissingNames, Target) {
    Draw draw = complete();
    draw.fragment =
        glsl_fragment("layout(location = 2) out vec4 hit; void main() { hit = vec4(1.0); }");
    draw.colour_targets = 2;
    EXPECT_EQ(refusal(device(), draw),
              "error: the fragment shader writes 'hit' to target 2 and the draw has 2 targets "
              "[bad-target]");
}

TEST_F(MissingNames, PlaceOfTwoThings) {
    Draw draw = complete();
    draw.vertex = glsl_vertex(R"(
        layout(location = 0) in vec3 position;
        layout(binding = 0) uniform Place { vec2 light; };
        layout(location = 0) out vec2 uv;
        void main() { gl_Position = vec4(position, 1.0); uv = light; })");
    EXPECT_EQ(refusal(device(), draw),
              "error: 'Place' and 'height_map' are both at set 0, binding 0 [binding-conflict]");
}

TEST_F(MissingNames, SizeOfThePicture) {
    Draw draw = complete();
    draw.width = 0;
    EXPECT_EQ(refusal(device(), draw),
              "error: a picture of 0 by 4 pixels has no pixel [bad-target]");
    draw.width = 1 << 20;
    EXPECT_THAT(refusal(device(), draw), HasSubstr("[too-large]"));
    draw = complete();
    draw.colour_targets = 1000;
    EXPECT_THAT(refusal(device(), draw), HasSubstr("1000 colour targets are too many"));
}

TEST_F(MissingNames, Mesh) {
    Draw draw = complete();
    draw.mesh = nullptr;
    EXPECT_EQ(refusal(device(), draw),
              "error: a draw needs a mesh of whole triangles, and was given none [bad-mesh]");
    Mesh mesh = quad();
    mesh.indices.back() = 4;
    draw.mesh = &mesh;
    EXPECT_EQ(refusal(device(), draw), "error: the mesh has 4 vertices and an index 4 [bad-mesh]");
}

TEST_F(MissingNames, WordsThatAreNoSpirv) {
    Draw draw = complete();
    draw.fragment.spirv.clear();
    EXPECT_THAT(refusal(device(), draw), HasSubstr("[spirv-"));
    draw.fragment.spirv = {0x07230203, 1, 2, 3, 4, 5};
    EXPECT_THAT(refusal(device(), draw), HasSubstr("[spirv-"));
}

}  // namespace
}  // namespace intaglio::vulkan

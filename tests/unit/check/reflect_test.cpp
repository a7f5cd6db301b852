// Reflection against what the texts say.
#include "src/check/reflect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/check/frontend.h"
#include "tests/unit/check/shaders.h"

namespace intaglio::check {

void PrintTo(const Reflection::Member& member, std::ostream* out) {
    *out << member.name << " at " << member.offset << " size " << member.size << " components "
         << member.components << " columns " << member.columns << " count " << member.array_count
         << " stride " << member.array_stride;
}
void PrintTo(const Reflection::Image& image, std::ostream* out) {
    *out << image.name << " at " << image.set << "," << image.binding << " kind "
         << static_cast<int>(image.kind) << " count " << image.array_count;
}
void PrintTo(const Reflection::Interface& value, std::ostream* out) {
    *out << value.name << " at " << value.location << " components " << value.components
         << " count " << value.array_count << " built-in '" << value.built_in << "'";
}

namespace {

using ::testing::ElementsAre;
using Image = Reflection::Image;
using ImageKind = Reflection::ImageKind;
using Interface = Reflection::Interface;
using Member = Reflection::Member;

Result<Reflection> reflect_text(Language language, Stage stage, const std::string& text) {
    const Result<SpirvWords> words = to_spirv({.language = language, .stage = stage, .text = text});
    if (!words) return words.error();
    return reflect(*words);
}

Interface varying(std::string name, int location, int components) {
    return {
        .name = std::move(name), .location = location, .components = components, .built_in = {}};
}

TEST(Reflect, Glsl450BlockFollowsStd140) {
    const Result<Reflection> view = reflect_text(Language::Glsl450, Stage::Pixel, R"(#version 450
layout(set = 0, binding = 3, std140) uniform Globals {
    float depth_scale;
    vec3 light;
    vec2 size;
    float taps[3];
    mat4 world;
    mat3 frame;
    int steps;
};
layout(push_constant) uniform Push { vec4 tint; };
layout(set = 0, binding = 16) uniform sampler2D height_map;
layout(set = 0, binding = 18) uniform texture2D normals[2];
layout(set = 0, binding = 33) uniform sampler linear_sampler;
layout(location = 2) in vec2 uv;
layout(location = 0) in vec3 view;
layout(location = 0) out vec4 color;
layout(location = 1) out vec2 displaced;
void main() {
    color = texture(height_map, uv) * tint + texture(sampler2D(normals[1], linear_sampler), view.xy)
          + world[0] + gl_FragCoord;
    displaced = uv;
}
)");
    ASSERT_TRUE(view.ok()) << to_string(view.error());
    ASSERT_EQ(view->blocks.size(), 1u);
    const Reflection::Block& block = view->blocks[0];
    EXPECT_EQ(block.name, "Globals");
    EXPECT_EQ(block.set, 0);
    EXPECT_EQ(block.binding, 3);
    EXPECT_EQ(block.size, 212);
    EXPECT_THAT(
        block.members,
        ElementsAre(Member{"depth_scale", 0, 4, 1, 1, 1, 0}, Member{"light", 16, 12, 3, 1, 1, 0},
                    Member{"size", 32, 8, 2, 1, 1, 0}, Member{"taps", 48, 48, 1, 1, 3, 16},
                    Member{"world", 96, 64, 4, 4, 1, 0}, Member{"frame", 160, 48, 3, 3, 1, 0},
                    Member{"steps", 208, 4, 1, 1, 1, 0}));
    ASSERT_TRUE(view->push_constants.has_value());
    EXPECT_EQ(view->push_constants->name, "Push");
    EXPECT_THAT(view->push_constants->members, ElementsAre(Member{"tint", 0, 16, 4, 1, 1, 0}));
    EXPECT_THAT(view->images, ElementsAre(Image{"height_map", 0, 16, ImageKind::Combined, 1},
                                          Image{"normals", 0, 18, ImageKind::Texture, 2},
                                          Image{"linear_sampler", 0, 33, ImageKind::Sampler, 1}));
    EXPECT_THAT(view->inputs, ElementsAre(varying("view", 0, 3), varying("uv", 2, 2),
                                          Interface{"gl_FragCoord", -1, 4, 1, "FragCoord"}));
    EXPECT_THAT(view->outputs, ElementsAre(varying("color", 0, 4), varying("displaced", 1, 2)));

    const std::optional<FoundMember> found = find_member(*view, "size");
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->block, &block);
    EXPECT_EQ(found->member->offset, 32);
    EXPECT_FALSE(find_member(*view, "no_such_member").has_value());
}

TEST(Reflect, Hlsl5RegistersAreShiftedAndNamesAreThoseOfTheStructs) {
    const Result<SpirvWords> words = to_spirv(parallax_pixel(Language::Hlsl5));
    ASSERT_TRUE(words.ok());
    const Result<Reflection> view = reflect(*words);
    ASSERT_TRUE(view.ok()) << to_string(view.error());
    ASSERT_EQ(view->blocks.size(), 1u);
    EXPECT_EQ(view->blocks[0].name, "Globals");
    EXPECT_EQ(view->blocks[0].binding, uniform_binding);
    // HLSL packs the float3 behind the float.
    EXPECT_THAT(view->blocks[0].members, ElementsAre(Member{"depth_scale", 0, 4, 1, 1, 1, 0},
                                                     Member{"light", 4, 12, 3, 1, 1, 0}));
    EXPECT_THAT(view->images,
                ElementsAre(Image{"height_map", 0, texture_binding, ImageKind::Texture, 1},
                            Image{"height_sampler", 0, sampler_binding, ImageKind::Sampler, 1}));
    ASSERT_GE(view->inputs.size(), 2u);
    EXPECT_EQ(view->inputs[0], varying("uv", 0, 2));
    EXPECT_EQ(view->inputs[1], varying("view", 1, 3));
    EXPECT_THAT(view->outputs, ElementsAre(varying("@entryPointOutput", 0, 4)));
}

TEST(Reflect, RegistersOfEachKindKeepTheirNumbers) {
    const Result<Reflection> view = reflect_text(Language::Hlsl5, Stage::Pixel, R"(
cbuffer Scene : register(b2) { float4 light; };
Texture2D color_map : register(t3);
Texture2D height_map : register(t1);
SamplerState wrap : register(s4);
struct Result { float4 displaced : SV_Target1; float4 color : SV_Target0; };
Result main(float2 uv : TEXCOORD3) {
    Result result;
    result.color = color_map.Sample(wrap, uv) * light;
    result.displaced = height_map.Sample(wrap, uv);
    return result;
}
)");
    ASSERT_TRUE(view.ok()) << to_string(view.error());
    ASSERT_EQ(view->blocks.size(), 1u);
    EXPECT_EQ(view->blocks[0].binding, uniform_binding + 2);
    EXPECT_THAT(view->images,
                ElementsAre(Image{"height_map", 0, texture_binding + 1, ImageKind::Texture, 1},
                            Image{"color_map", 0, texture_binding + 3, ImageKind::Texture, 1},
                            Image{"wrap", 0, sampler_binding + 4, ImageKind::Sampler, 1}));
    EXPECT_THAT(view->inputs, ElementsAre(varying("uv", 0, 2)));
    EXPECT_THAT(view->outputs, ElementsAre(varying("color", 0, 4), varying("displaced", 1, 4)));
}

TEST(Reflect, Direct3D9SamplersKeepTheirRegisters) {
    const Result<Reflection> view = reflect_text(Language::Hlsl3, Stage::Pixel, R"(
float4 light : register(c4);
sampler2D color_map : register(s3);
sampler2D height_map : register(s1);
float4 main(float2 uv : TEXCOORD0) : COLOR0 { return tex2D(color_map, uv) * light + tex2D(height_map, uv); }
)");
    ASSERT_TRUE(view.ok()) << to_string(view.error());
    EXPECT_THAT(view->images,
                ElementsAre(Image{"height_map", 0, texture_binding + 1, ImageKind::Combined, 1},
                            Image{"color_map", 0, texture_binding + 3, ImageKind::Combined, 1}));
    EXPECT_TRUE(find_member(*view, "light").has_value());
}

TEST(Reflect, LooseUniformsKeepTheirNames) {
    for (const Language language : {Language::Glsl330, Language::Essl300, Language::Hlsl3}) {
        const Result<SpirvWords> words = to_spirv(parallax_pixel(language));
        ASSERT_TRUE(words.ok());
        const Result<Reflection> view = reflect(*words);
        ASSERT_TRUE(view.ok()) << to_string(view.error());
        ASSERT_EQ(view->blocks.size(), 1u) << name_of(language);
        EXPECT_EQ(view->blocks[0].name,
                  language == Language::Hlsl3 ? "$Global" : "gl_DefaultUniformBlock");
        EXPECT_EQ(view->blocks[0].binding, uniform_binding);
        ASSERT_EQ(view->blocks[0].members.size(), 2u);
        EXPECT_EQ(view->blocks[0].members[0].name, "depth_scale");
        EXPECT_EQ(view->blocks[0].members[1].name, "light");
        EXPECT_THAT(view->images,
                    ElementsAre(Image{"height_map", 0, texture_binding, ImageKind::Combined, 1}))
            << name_of(language);
    }
}

TEST(Reflect, VertexStageInEveryLanguage) {
    for (const Language language : spirv_languages) {
        const Result<SpirvWords> words = to_spirv(parallax_vertex(language));
        ASSERT_TRUE(words.ok());
        const Result<Reflection> view = reflect(*words);
        ASSERT_TRUE(view.ok()) << to_string(view.error());
        EXPECT_THAT(view->inputs, ElementsAre(varying("position", 0, 3), varying("texcoord", 1, 2),
                                              varying("tangent_view", 2, 3)))
            << name_of(language);
        ASSERT_EQ(view->outputs.size(), 3u) << name_of(language);
        EXPECT_EQ(view->outputs.back().built_in, "Position") << name_of(language);
        EXPECT_EQ(view->outputs.back().components, 4) << name_of(language);
    }
}

}  // namespace
}  // namespace intaglio::check

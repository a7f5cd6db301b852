// Two stages in one program: what agrees is made to agree, what cannot is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/check/frontend.h"
#include "src/check/reflect.h"
#include "tests/unit/check/shaders.h"

namespace intaglio::check {
namespace {

using ::testing::HasSubstr;

int location_of(const std::vector<Reflection::Interface>& values, const std::string& name) {
    for (const Reflection::Interface& value : values) {
        if (value.name == name) return value.location;
    }
    return -2;
}

class LinkEachLanguage : public ::testing::TestWithParam<Language> {};

// In the GLSL 3.30 and ES 3.00 texts the stages declare the varyings in opposite orders.
TEST_P(LinkEachLanguage, VaryingsMeetByName) {
    const Result<Program> program =
        link_to_spirv(parallax_vertex(GetParam()), parallax_pixel(GetParam()));
    ASSERT_TRUE(program.ok()) << to_string(program.error());
    const Result<Reflection> vertex = reflect(program->vertex);
    const Result<Reflection> pixel = reflect(program->pixel);
    ASSERT_TRUE(vertex.ok() && pixel.ok());
    for (const char* name : {"uv", "view"}) {
        EXPECT_GE(location_of(pixel->inputs, name), 0) << name;
        EXPECT_EQ(location_of(vertex->outputs, name), location_of(pixel->inputs, name)) << name;
    }
    EXPECT_NE(location_of(pixel->inputs, "uv"), location_of(pixel->inputs, "view"));
    // Each uniform is found by name in its stage.
    EXPECT_TRUE(find_member(*vertex, "zoom").has_value());
    EXPECT_TRUE(find_member(*pixel, "depth_scale").has_value());
    ASSERT_EQ(pixel->blocks.size(), 1u);
    EXPECT_EQ(pixel->blocks[0].binding, uniform_binding);
    ASSERT_GE(pixel->images.size(), 1u);
    EXPECT_EQ(pixel->images[0].name, "height_map");
    EXPECT_EQ(pixel->images[0].binding, texture_binding);
}

TEST_P(LinkEachLanguage, ASharedPlaceHasOneLayout) {
    const Result<Program> program =
        link_to_spirv(parallax_vertex(GetParam()), parallax_pixel(GetParam()));
    ASSERT_TRUE(program.ok()) << to_string(program.error());
    const Result<Reflection> vertex = reflect(program->vertex);
    const Result<Reflection> pixel = reflect(program->pixel);
    ASSERT_TRUE(vertex.ok() && pixel.ok());
    for (const Reflection::Block& ours : pixel->blocks) {
        for (const Reflection::Block& theirs : vertex->blocks) {
            if (ours.binding == theirs.binding) {
                EXPECT_EQ(ours, theirs);
            }
        }
    }
}

TEST_P(LinkEachLanguage, HandsOnWhatTheBinariesSay) {
    const Result<Linked> linked =
        link_and_reflect(parallax_vertex(GetParam()), parallax_pixel(GetParam()));
    ASSERT_TRUE(linked.ok()) << to_string(linked.error());
    const auto expect_same = [](const Reflection& handed, const SpirvWords& words) {
        const Result<Reflection> read = reflect(words);
        ASSERT_TRUE(read.ok());
        EXPECT_EQ(handed.blocks, read->blocks);
        EXPECT_EQ(handed.images, read->images);
        EXPECT_EQ(handed.inputs, read->inputs);
        EXPECT_EQ(handed.outputs, read->outputs);
        EXPECT_FALSE(handed.outputs.empty());
    };
    expect_same(linked->vertex, linked->program.vertex);
    expect_same(linked->pixel, linked->program.pixel);
}

TEST_P(LinkEachLanguage, RefusesAnInputThatNobodyFeeds) {
    Source pixel = parallax_pixel(GetParam());
    for (std::size_t at = pixel.text.find("view"); at != std::string::npos;
         at = pixel.text.find("view", at + 6)) {
        pixel.text.replace(at, 4, "gaze");
    }
    if (GetParam() == Language::Glsl450)
        pixel.text = replaced(pixel.text, "location = 1", "location = 5");
    const Result<Program> program = link_to_spirv(parallax_vertex(GetParam()), pixel);
    ASSERT_FALSE(program.ok());
    EXPECT_THAT(to_string(program.error()), HasSubstr("gaze"));
}

TEST_P(LinkEachLanguage, RefusesAVaryingOfAnotherWidth) {
    Source pixel = parallax_pixel(GetParam());
    const bool hlsl = GetParam() == Language::Hlsl5 || GetParam() == Language::Hlsl3;
    const std::string vec = hlsl ? "float" : "vec";
    pixel.text = replaced(pixel.text, vec + "3 view", vec + "4 view");
    pixel.text = replaced(pixel.text, hlsl ? "dot(light, input.view)" : "dot(light, view)",
                          hlsl ? "dot(light, input.view.xyz)" : "dot(light, view.xyz)");
    ASSERT_TRUE(parse(pixel).ok());
    const Result<Program> program = link_to_spirv(parallax_vertex(GetParam()), pixel);
    ASSERT_FALSE(program.ok());
    EXPECT_THAT(to_string(program.error()), HasSubstr("view"));
}

INSTANTIATE_TEST_SUITE_P(Languages, LinkEachLanguage, ::testing::ValuesIn(spirv_languages),
                         [](const auto& instance) { return std::string(name_of(instance.param)); });

TEST(Link, RefusesHlslStructsInDifferentOrder) {
    // glslang numbers HLSL varyings by order of declaration, so the semantics alone would be
    // silently wrong.
    Source pixel = parallax_pixel(Language::Hlsl5);
    pixel.text = replaced(pixel.text, "    float2 uv : TEXCOORD0;\n    float3 view : TEXCOORD1;\n",
                          "    float3 view : TEXCOORD1;\n    float2 uv : TEXCOORD0;\n");
    const Result<Program> program = link_to_spirv(parallax_vertex(Language::Hlsl5), pixel);
    ASSERT_FALSE(program.ok());
    EXPECT_EQ(program.error().code, "stages-disagree");
    EXPECT_EQ(program.error().message,
              "the pixel input `view` (3 components) would be fed by the vertex output `uv` (2 "
              "components) "
              "at location 0");
}

TEST(Link, RefusesTwoLayoutsAtOneBinding) {
    for (const Language language : {Language::Glsl450, Language::Hlsl5}) {
        Source vertex = parallax_vertex(language);
        vertex.text = language == Language::Hlsl5
                          ? replaced(vertex.text, "register(b1)", "register(b0)")
                          : replaced(vertex.text, "binding = 1", "binding = 0");
        const Result<Program> program = link_to_spirv(vertex, parallax_pixel(language));
        ASSERT_FALSE(program.ok());
        EXPECT_EQ(program.error().code, "stages-disagree");
        EXPECT_THAT(program.error().message, HasSubstr("from member `depth_scale` on"));
    }
}

TEST(Link, RefusesMixedLanguagesAndSwappedStages) {
    const Result<Program> mixed =
        link_to_spirv(parallax_vertex(Language::Glsl450), parallax_pixel(Language::Hlsl5));
    ASSERT_FALSE(mixed.ok());
    EXPECT_EQ(mixed.error().code, "language-mismatch");
    const Result<Program> swapped =
        link_to_spirv(parallax_pixel(Language::Glsl450), parallax_vertex(Language::Glsl450));
    ASSERT_FALSE(swapped.ok());
    EXPECT_EQ(swapped.error().code, "stages-disagree");
    const Result<Program> old =
        link_to_spirv(parallax_vertex(Language::Essl100), parallax_pixel(Language::Essl100));
    ASSERT_FALSE(old.ok());
    EXPECT_EQ(old.error().code, "no-spirv");
}

TEST(Link, PointsIntoTheStageThatIsWrong) {
    Source vertex = parallax_vertex(Language::Glsl330);
    vertex.text = replaced(vertex.text, "uv = texcoord;", "uv = textcoord;");
    const Result<Program> program = link_to_spirv(vertex, parallax_pixel(Language::Glsl330));
    ASSERT_FALSE(program.ok());
    EXPECT_EQ(program.error().file, "parallax.vertex");
    EXPECT_THAT(program.error().notes, ::testing::ElementsAre(HasSubstr("uv = textcoord;")));
}

}  // namespace
}  // namespace intaglio::check

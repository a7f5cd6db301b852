// What MojoShader says about bytecode, and what it refuses.
#include "src/check/mojoshader.h"
#include "tests/unit/mojoshader/shaders.h"

namespace intaglio::check {
namespace {

using Words = std::vector<std::uint32_t>;

Words bytes_of(const std::string& text, std::vector<d3d9::Constant> constants = {}) {
    return d3d9::encode(d3d9::assembled(text, std::move(constants)));
}

const Words& steep() {
    using Set = d3d9::Constant::Set;
    static const Words words = bytes_of(
        "ps_3_0\ndef c4, 1, 0, 0, 0\ndcl_texcoord0 v0.xy\ndcl_2d s1\ndcl_2d s2\nmov r0, c4.y\nrep "
        "i0\nif b0\ntexldl r1, r0, s1\nadd r0, r1, c9\nelse\nbreak\nendif\nendrep\nadd r0, r0, "
        "c2\nadd r0, r0, v0.x\ntexld r2, v0, s2\nadd oC0, r0, r2\n",
        {{"steps", Set::Int4, 0, 1, 1, 1},
         {"light", Set::Float4, 8, 2, 3, 2},
         {"height_map", Set::Sampler, 1, 1, 0, 1}});
    return words;
}

TEST(Translate, NamesRegistersTexturesAndConstants) {
    const auto stage = translate_d3d9(steep(), Stage::Pixel);
    ASSERT_TRUE(stage.ok()) << to_string(stage.error());
    EXPECT_THAT(stage->float_registers, testing::ElementsAre(2, 9));
    EXPECT_THAT(stage->int_registers, testing::ElementsAre(0));
    EXPECT_THAT(stage->bool_registers, testing::ElementsAre(0));
    EXPECT_THAT(stage->textures, testing::ElementsAre(testing::Pair("height_map", "ps_s1"),
                                                      testing::Pair("s2", "ps_s2")));
    EXPECT_GT(stage->slots, 10);
    const Status accepted = parse(stage->source);
    EXPECT_TRUE(accepted.ok()) << to_string(accepted.error()) << stage->source.text;
}

TEST(Translate, UniformsComeFromTheConstantTable) {
    const auto stage = translate_d3d9(steep(), Stage::Pixel);
    ASSERT_TRUE(stage.ok()) << to_string(stage.error());
    const D3d9Program program{{}, {*stage}};
    std::map<std::string, std::vector<float>> values = {
        {"steps", {7}}, {"light", {1, 2, 3, 4, 5, 6}}, {"c2", {9, 8, 7, 6}}, {"b0", {1}}};
    const auto uniforms = uniforms_of(program, values);
    ASSERT_TRUE(uniforms.ok()) << to_string(uniforms.error());
    EXPECT_THAT(uniforms->at("ps_uniforms_vec4"), testing::ElementsAre(9, 8, 7, 6, 4, 5, 6, 0));
    EXPECT_THAT(uniforms->at("ps_uniforms_ivec4"), testing::ElementsAre(7, 0, 0, 0));
    EXPECT_THAT(uniforms->at("ps_uniforms_bool"), testing::ElementsAre(1));
    values["light"].pop_back();
    EXPECT_EQ(uniforms_of(program, values).error().code, "bad-uniform");
    values.erase("light");
    EXPECT_THAT(
        to_string(uniforms_of(program, values).error()),
        testing::AllOf(testing::HasSubstr("'light'"), testing::HasSubstr("[missing-uniform]")));
}

TEST(Translate, RefusesTheOtherStage) {
    EXPECT_EQ(translate_d3d9(steep(), Stage::Vertex).error().code, "stages-disagree");
}

TEST(Translate, RefusesMalformedBytecodeWithASentence) {
    const auto refusal = [](const Words& words) {
        const auto stage = translate_d3d9(words, Stage::Pixel);
        return stage ? "accepted" : to_string(stage.error());
    };
    EXPECT_THAT(refusal({}), testing::HasSubstr("it is empty [d3d9-malformed]"));
    EXPECT_THAT(refusal({0xFFFF0300}), testing::HasSubstr("no end token"));
    EXPECT_THAT(refusal({0x12345678, 0x0000FFFF}), testing::HasSubstr("does not begin with"));
    EXPECT_THAT(refusal({0xFFFF0300, 0x0000FFFF, 0}), testing::HasSubstr("follow the end token"));
    // No such opcode; and a move from a move's worth of nothing.
    for (const Words& words :
         {Words{0xFFFF0300, 0x00001234, 0x0000FFFF}, Words{0xFFFF0300, 0x00000001, 0x0000FFFF}}) {
        EXPECT_THAT(refusal(words),
                    testing::AllOf(testing::HasSubstr("MojoShader refuses the bytecode"),
                                   testing::HasSubstr("[d3d9-refused]")));
    }
    // Cut anywhere: the end token is missing.
    for (std::size_t length = 0; length < steep().size(); ++length) {
        const Words cut(steep().begin(), steep().begin() + static_cast<std::ptrdiff_t>(length));
        EXPECT_THAT(refusal(cut), testing::HasSubstr("[d3d9-malformed]")) << length;
    }
}

}  // namespace
}  // namespace intaglio::check

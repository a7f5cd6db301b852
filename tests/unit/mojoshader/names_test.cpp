// MojoShader's registers under the names of the constant table.
#include "src/check/reflect.h"
#include "tests/unit/mojoshader/shaders.h"

#include "src/check/mojoshader.h"

namespace intaglio::check {
namespace {

using testing::HasSubstr;
using testing::Not;
using Set = d3d9::Constant::Set;

std::vector<std::uint32_t> vertex() {
    return d3d9::encode(d3d9::assembled(
        "vs_2_0\ndcl_position v0\ndcl_texcoord v1\ndp4 r0.x, v0, c0\ndp4 r0.y, v0, c1\n"
        "dp4 r0.z, v0, c2\nmov r0.w, c3.x\nmov oPos, r0\nmov oT0, v1\n",
        {{"world", Set::Float4, 0, 3, 4, 3}, {"scale", Set::Float4, 3, 1, 1, 1}}));
}

std::vector<std::uint32_t> pixel(const std::string& more = "") {
    return d3d9::encode(
        d3d9::assembled("ps_2_0\ndef c4, 1, 2, 3, 4\ndcl t0.xy\ndcl_2d s0\ntexld r0, t0, s0\n"
                        "mad r0, r0, c0.x, c1\nadd r0, r0, c2\nadd r0, r0, c4\n" +
                            more + "mov oC0, r0\n",
                        {{"scale", Set::Float4, 0, 1, 1, 1},
                         {"ambient", Set::Float4, 1, 1, 3, 1},
                         {"offset", Set::Float4, 2, 1, 2, 1},
                         {"height_map", Set::Sampler, 0, 1, 0, 1}}));
}

TEST(Names, AreUniformsOfTheirOwnWidth) {
    const auto program = link_d3d9_by_name(vertex(), pixel());
    ASSERT_TRUE(program.ok()) << to_string(program.error());
    const auto both = {reflect(program->vertex), reflect(program->pixel)};
    for (const auto& reflection : both) {
        ASSERT_TRUE(reflection.ok()) << to_string(reflection.error());
        const auto scale = find_member(*reflection, "scale");
        ASSERT_TRUE(scale) << "one uniform of both stages";
        EXPECT_EQ(scale->member->components, 1);
    }
    const Reflection& in_pixel = **(both.begin() + 1);
    EXPECT_EQ(find_member(in_pixel, "ambient")->member->components, 3);
    EXPECT_EQ(find_member(in_pixel, "offset")->member->components, 2);
    EXPECT_EQ(find_member(**both.begin(), "world")->member->array_count, 3);
    ASSERT_EQ(in_pixel.images.size(), 1u);
    EXPECT_EQ(in_pixel.images[0].name, "height_map");
}

TEST(Names, LanesThatAUniformHasNotAreZero) {
    const auto stage = translate_d3d9(pixel(), Stage::Pixel);
    ASSERT_TRUE(stage.ok()) << to_string(stage.error());
    const std::string text = with_names(*stage).source.text;
    EXPECT_THAT(text, HasSubstr("#define ps_c0 vec4(scale, 0.0, 0.0, 0.0)\n"));
    EXPECT_THAT(text, HasSubstr("#define ps_c1 vec4(ambient, 0.0)\n"));
    EXPECT_THAT(text, HasSubstr("#define ps_c2 vec4(offset, 0.0, 0.0)\n"));
    EXPECT_THAT(text, Not(HasSubstr("ps_uniforms_vec4")));
}

TEST(Names, RegistersWithoutOneStayInTheirArray) {
    const auto stage = translate_d3d9(pixel("add r0, r0, c7\n"), Stage::Pixel);
    ASSERT_TRUE(stage.ok()) << to_string(stage.error());
    const Source source = with_names(*stage).source;
    EXPECT_THAT(source.text, HasSubstr("uniform vec4 ps_uniforms_vec4[4];"));
    EXPECT_THAT(source.text, HasSubstr("#define ps_c7 ps_uniforms_vec4[3]"));
    EXPECT_THAT(source.text, HasSubstr("uniform vec3 ambient;"));
    const Status accepted = parse(source);
    EXPECT_TRUE(accepted.ok()) << to_string(accepted.error()) << source.text;
}

}  // namespace
}  // namespace intaglio::check

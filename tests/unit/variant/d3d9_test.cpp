// Surfaces on the Direct3D 9 profiles: judged, linked by name, explained, refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/check/reflect.h"
#include "src/variant/explain.h"
#include "tests/unit/variant/requests.h"

namespace intaglio {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(Direct3D9Variant, IsJudgedAndLinkedByName) {
    for (const char* surface : {"search=none", "parallax_occlusion,output=displaced"})
        for (const char* target : {"ps_2_0", "ps_2_a", "ps_2_b", "ps_3_0"}) {
            const Result<Variant> variant = make_variant(catalogue(), request_of(surface, target));
            ASSERT_TRUE(variant.ok()) << to_string(variant.error());
            const Result<Judged> judged = judge_variant(*variant);
            ASSERT_TRUE(judged.ok()) << to_string(judged.error());
            EXPECT_THAT(judged->steps, Contains("pixel: every rule of " + std::string(target)));
            EXPECT_THAT(judged->steps, Contains("vertex: MojoShader"));
            EXPECT_EQ(judged->steps.back(), "both: stages fit each other");
            ASSERT_EQ(judged->shaders.size(), 2u);
            EXPECT_EQ(name_of(judged->shaders[1].profile), target);

            const Result<check::Program> program = link_variant(*variant);
            ASSERT_TRUE(program.ok()) << to_string(program.error());
            const Result<check::Reflection> vertex = check::reflect(program->vertex);
            ASSERT_TRUE(vertex.ok());
            for (const char* name : {"world", "view_projection", "eye"})
                EXPECT_TRUE(check::find_member(*vertex, name)) << name << " on " << target;
            // Where the hardware chooses levels, the map that is read at level 0 has but one.
            const bool read = surface != std::string("search=none");
            EXPECT_EQ(program->one_level.count("height_map"),
                      read && target != std::string("ps_3_0") ? 1u : 0u)
                << surface << target;
        }
}

TEST(Direct3D9Variant, AVertexProfileIsJudgedAlone) {
    const Result<Variant> variant =
        make_variant(catalogue(), request_of("parallax_occlusion", "vs_3_0"));
    ASSERT_TRUE(variant.ok()) << to_string(variant.error());
    const Result<Judged> judged = judge_variant(*variant);
    ASSERT_TRUE(judged.ok()) << to_string(judged.error());
    EXPECT_EQ(judged->shaders.size(), 1u);
    EXPECT_EQ(link_variant(*variant).error().code, "not-runnable");
    EXPECT_EQ(to_string(product_of(*variant, ir::Stage::Pixel).error()),
              "error: vs_3_0 is a profile of vertex shaders; the pixel stage is that of ps_3_0 "
              "[no-stage]");
    EXPECT_TRUE(product_of(*variant, ir::Stage::Vertex).ok());
}

TEST(Direct3D9Variant, ItsProductsAreTextAndBytes) {
    const Result<Variant> variant = make_variant(catalogue(), request_of("search=none", "ps_2_0"));
    ASSERT_TRUE(variant.ok()) << to_string(variant.error());
    const Result<Product> text = product_of(*variant, ir::Stage::Pixel);
    const Result<Product> bytes = product_of(*variant, ir::Stage::Pixel, Form::Bytecode);
    ASSERT_TRUE(text.ok() && bytes.ok());
    EXPECT_EQ(text->extension, ".psh");
    EXPECT_FALSE(text->binary);
    EXPECT_EQ(bytes->extension, ".pso");
    EXPECT_TRUE(bytes->binary);
    EXPECT_EQ(bytes->bytes.substr(0, 4), std::string("\x00\x02\xff\xff", 4));
    EXPECT_THAT(bytes->bytes, HasSubstr("CTAB"));
    const Result<Variant> other = make_variant(catalogue(), request_of("search=none", "glsl_450"));
    ASSERT_TRUE(other.ok());
    EXPECT_EQ(product_of(*other, ir::Stage::Pixel, Form::Bytecode).error().code, "no-bytecode");
}

TEST(Direct3D9Variant, ARefusedOneIsExplainedAllTheSame) {
    const VariantRequest wanted = request_of("parallax_occlusion", "ps_2_0", {{"taps", "16"}});
    const Result<Variant> variant = make_variant(catalogue(), wanted);
    ASSERT_FALSE(variant.ok());
    EXPECT_TRUE(is_refusal(variant.error()));
    const Result<ExplainedVariant> explained = explain_variant(catalogue(), wanted);
    ASSERT_TRUE(explained.ok()) << to_string(explained.error());
    ASSERT_TRUE(explained->refusal);
    EXPECT_EQ(explained->refusal->message, variant.error().message);
    ASSERT_EQ(explained->stages.size(), 1u);
    const d3d9::Slots slots = explained->stages[0].explanation.slots;
    EXPECT_GT(slots.arithmetic, 64);
    EXPECT_THAT(variant.error().message,
                HasSubstr("needs " + std::to_string(slots.arithmetic) + " arithmetic slots"));
}

TEST(Direct3D9Variant, OneThatFitsIsExplainedAsItIsEmitted) {
    const VariantRequest wanted = request_of("parallax_occlusion,output=displaced", "ps_2_0");
    const Result<Variant> variant = make_variant(catalogue(), wanted);
    ASSERT_TRUE(variant.ok()) << to_string(variant.error());
    const Result<Judged> judged = judge_variant(*variant);
    ASSERT_TRUE(judged.ok()) << to_string(judged.error());
    const Result<ExplainedVariant> explained = explain_variant(catalogue(), wanted);
    ASSERT_TRUE(explained.ok()) << to_string(explained.error());
    EXPECT_FALSE(explained->refusal);
    ASSERT_EQ(explained->stages.size(), 2u);
    for (const std::size_t stage : {0u, 1u}) {
        const d3d9::Resources used = d3d9::count(judged->shaders[1 - stage]);
        EXPECT_EQ(explained->stages[stage].explanation.slots,
                  (d3d9::Slots{used.arithmetic, used.texture}));
    }
}

TEST(ExplainedVariant, ALanguageCountsTheOperationsOfItsTextByStepAndLine) {
    for (const char* target : {"glsl_450", "essl_100", "hlsl_2_b", "spirv"}) {
        const auto count = [&](const char* taps) {
            const auto explained = explain_variant(
                catalogue(),
                request_of("parallax_occlusion,output=displaced", target, {{"taps", taps}}));
            EXPECT_TRUE(explained.ok()) << to_string(explained.error());
            const d3d9::Explanation& pixel = explained->stages.front().explanation;
            EXPECT_EQ(explained->stages.front().stage, ir::Stage::Pixel);
            // Steps and lines add up to the whole.
            d3d9::Slots steps, lines;
            for (const d3d9::Spent& step : pixel.steps) {
                steps.arithmetic += step.slots.arithmetic;
                steps.texture += step.slots.texture;
            }
            for (const d3d9::Spent& line : pixel.lines) {
                lines.arithmetic += line.slots.arithmetic;
                lines.texture += line.slots.texture;
            }
            EXPECT_EQ(steps, pixel.slots);
            EXPECT_EQ(lines, pixel.slots);
            EXPECT_EQ(pixel.reads.size(), static_cast<std::size_t>(pixel.slots.texture));
            return pixel.slots;
        };
        // Rolled, a loop's body counts once; unrolled, each tap reads once more.
        const bool rolled = std::string(target) != "hlsl_2_b" && std::string(target) != "essl_100";
        if (rolled)
            EXPECT_EQ(count("4"), count("8")) << target;
        else
            EXPECT_GE(count("8").texture, count("4").texture) << target;
    }
}

}  // namespace
}  // namespace intaglio

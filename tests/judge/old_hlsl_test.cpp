// The texts of hlsl_2_0 and hlsl_2_b through the compiler that they are written for: whatever it
// refuses, it refuses for a count of slots, never for what the text says.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include "src/variant/variant.h"
#include "templates/all_techniques.h"
#include "tests/judge/judge.h"

namespace intaglio::judge {
namespace {

// Too many arithmetic, texture or all slots, too many temporary registers, reads that depend on
// each other too deeply.
const std::vector<std::string> counts = {"X5608", "X5607", "X5609", "X5426", "X4505", "X4018"};

struct Case {
    std::string surface;
    std::string target;
    bool must_fit;
};

TEST(OldHlsl, IsRefusedForSlotsOnly) {
    const std::vector<Case> cases = {
        {"search=none,output=displaced", "hlsl_2_0", true},
        {"search=none", "hlsl_2_0", true},
        {"parallax_occlusion,output=displaced", "hlsl_2_0", true},
        {"parallax_occlusion", "hlsl_2_0", false},
        {"parallax_occlusion", "hlsl_2_b", true},
        {"steep_parallax,output=displaced", "hlsl_2_0", true},
        {"steep_parallax", "hlsl_2_b", true},
        {"parallax_occlusion,shadow=march", "hlsl_2_b", true},
    };
    Batch batch;
    for (const Case& one : cases) {
        VariantRequest request;
        request.surface = one.surface;
        request.target = one.target;
        if (one.surface.starts_with("steep"))
            request.knobs = {{"min_steps", "8"}, {"max_steps", "8"}};
        if (one.surface.ends_with("shadow=march"))
            request.knobs = {{"shadow_min_steps", "8"}, {"shadow_max_steps", "8"}};
        const Result<Variant> variant = make_variant(templates::all_techniques(), request);
        ASSERT_TRUE(variant.ok()) << to_string(variant.error());
        const std::string profile = one.target == "hlsl_2_0" ? "ps_2_0" : "ps_2_b";
        batch.compile(variant->vertex.text, "vertex_main", "vs_2_0");
        batch.compile(variant->pixel.text, "pixel_main", profile);
    }
    const auto answers = batch.run(*find());
    ASSERT_TRUE(answers.ok()) << to_string(answers.error());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE(cases[i].surface + " on " + cases[i].target);
        const Answer& vertex = answers->at(2 * i);
        const Answer& pixel = answers->at(2 * i + 1);
        EXPECT_TRUE(vertex.accepted) << vertex.text;
        if (pixel.accepted) continue;
        EXPECT_FALSE(cases[i].must_fit) << pixel.text;
        EXPECT_THAT(counts, testing::Contains(error_code(pixel))) << pixel.text;
    }
}

}  // namespace
}  // namespace intaglio::judge

// What is refused before packing: only what cannot fit, and with a number that no shader undercuts.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "generator/passes/lower_first_hit.h"
#include "generator/passes/pipeline.h"
#include "generator/target/d3d9/generate/fold_divisions.h"
#include "generator/target/d3d9/generate/generate.h"
#include "generator/target/d3d9/generate/least.h"
#include "generator/target/d3d9/generate/lower.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

using ::testing::HasSubstr;

// The graph of a program whose searches have this form, as the generator lowers it.
Graph graph_of(const ir::Program& program, Profile profile, passes::FirstHitForm form) {
    ir::Program straight = program;
    fold_divisions(straight.pixel);
    passes::PipelineOptions options;
    EXPECT_TRUE(passes::optimize(straight.pixel, options));
    passes::lower_first_hit(
        straight.pixel,
        [&](const passes::FirstHit& hit) {
            return form != passes::FirstHitForm::Chain && hit.only_whether
                       ? passes::FirstHitForm::AnyHit
                       : form;
        },
        passes::Rounding::Free);
    options.unroll_all = options.flatten_all = true;
    EXPECT_TRUE(passes::optimize_program(straight, options));
    std::vector<std::string> notes;
    auto graph = lower(straight.pixel, profile, notes);
    EXPECT_TRUE(graph) << (graph ? "" : graph.error().message);
    return graph ? std::move(*graph) : Graph{};
}

// One of the forms is what the generator chose.
TEST(Least, IsNeverMoreThanAShaderThatFits) {
    int compared = 0;
    for (const bool tidied : {false, true})
        for (const std::string surface :
             {"bump", "parallax_occlusion,output=displaced", "parallax_occlusion",
              "steep_parallax,output=displaced", "search=none,shadow=march"})
            for (const std::string steps : {"1", "3", "8"}) {
                const Case a_case{
                    surface,
                    surface.starts_with("steep")
                        ? std::vector<std::pair<std::string, std::string>>{{"min_steps", steps},
                                                                           {"max_steps", steps}}
                    : surface.starts_with("parallax")
                        ? std::vector<std::pair<std::string, std::string>>{{"taps", steps}}
                    : surface.ends_with("march")
                        ? std::vector<std::pair<std::string, std::string>>{{"shadow_min_steps",
                                                                            steps},
                                                                           {"shadow_max_steps",
                                                                            steps}}
                        : std::vector<std::pair<std::string, std::string>>{}};
                SCOPED_TRACE(a_case.name() + (tidied ? ", tidied" : ""));
                auto program = record(a_case, Profile::ps_2_a);
                ASSERT_TRUE(program) << program.error().message;
                const auto shader = generate_pixel(*program, Profile::ps_2_a);
                ASSERT_TRUE(shader) << shader.error().message;
                const Slots found = slots_of(*shader);
                Slots least{1 << 20, 1 << 20};
                for (const auto form :
                     {passes::FirstHitForm::Chain, passes::FirstHitForm::PackedRefetch}) {
                    const Slots one =
                        least_slots({graph_of(*program, Profile::ps_2_a, form)}, tidied);
                    EXPECT_GT(one.total(), 0);
                    least.arithmetic = std::min(least.arithmetic, one.arithmetic);
                    least.texture = std::min(least.texture, one.texture);
                }
                EXPECT_LE(least.arithmetic, found.arithmetic);
                EXPECT_LE(least.texture, found.texture);
                ++compared;
            }
    EXPECT_EQ(compared, 30);
}

TEST(Least, RefusesWhatIsFarTooLongAndStillSaysWhere) {
    struct Row {
        Profile profile;
        Case a_case;
        const char* step;
        const char* file;
    };
    const Row rows[] = {
        {Profile::ps_2_0,
         {"parallax_occlusion", {{"taps", "256"}}},
         "'march'",
         "templates/search/parallax_occlusion.cpp:"},
        {Profile::ps_2_b,
         {"search=none,shadow=exact", {{"shadow_cells", "4096"}, {"shadow_leaps", "0"}}},
         "'shadow'",
         "templates/shadow/exact.cpp:"},
    };
    for (const Row& row : rows) {
        const auto program = record(row.a_case, row.profile);
        ASSERT_TRUE(program) << program.error().message;
        const auto attempt = attempt_program(*program, row.profile);
        ASSERT_TRUE(attempt) << attempt.error().message;
        ASSERT_TRUE(attempt->refusal);
        EXPECT_EQ(attempt->refusal->code, "d3d9-limit");
        EXPECT_THAT(attempt->refusal->message, HasSubstr("needs at least"));
        EXPECT_THAT(attempt->refusal->message, HasSubstr(row.step));
        EXPECT_THAT(attempt->refusal->message, HasSubstr(row.file));
        EXPECT_TRUE(attempt->only_slots);
        EXPECT_THAT(attempt->notes, ::testing::Contains(HasSubstr("before packing")));
        EXPECT_GT(slots_of(attempt->pixel).total(), 96);
    }
}

// What is only a little too long gets its exact number.
TEST(Least, LeavesWhatIsNearTheLimitToPacking) {
    const auto program = record({"parallax_occlusion", {{"taps", "12"}}}, Profile::ps_2_0);
    ASSERT_TRUE(program);
    const auto shader = generate_pixel(*program, Profile::ps_2_0);
    ASSERT_FALSE(shader);
    EXPECT_THAT(shader.error().message, ::testing::Not(HasSubstr("at least")));
}

}  // namespace
}  // namespace intaglio::d3d9

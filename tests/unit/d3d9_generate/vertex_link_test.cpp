// A runtime that is not ours takes both stages and links them.
#include <gtest/gtest.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"
#include "src/check/mojoshader.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

TEST(VertexLink, MojoShaderLinksBothStages) {
    const std::vector<Case> cases = {
        {"bump", {}},
        {"search=none,shadow=march", {{"shadow_min_steps", "3"}, {"shadow_max_steps", "3"}}},
        {"parallax_occlusion", {{"taps", "3"}, {"ray_per_vertex", "1"}}}};
    for (const Profile profile : {Profile::ps_2_0, Profile::ps_2_b, Profile::ps_3_0})
        for (const Case& a_case : cases) {
            SCOPED_TRACE(std::string(name_of(profile)) + ": " + a_case.name());
            const auto program = record(a_case, profile);
            ASSERT_TRUE(program) << to_string(program.error());
            const auto stages = generate_program(*program, profile);
            ASSERT_TRUE(stages) << to_string(stages.error());
            const auto linked = check::link_d3d9(encode(stages->vertex), encode(stages->pixel));
            EXPECT_TRUE(linked) << (linked ? "" : to_string(linked.error()))
                                << print(stages->vertex) << print(stages->pixel);
        }
}

}  // namespace
}  // namespace intaglio::d3d9

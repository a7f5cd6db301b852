// How many slots Microsoft's compiler needs for the same functions, in the best HLSL that we could
// write: a loop as the paper has it, a select for each step, and the generator's own lowering
// transcribed by hand, which no compiler finds for the first two.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "generator/dsl/catalogue.h"
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/generate/generate.h"
#include "generator/target/d3d9/ops.h"
#include "templates/all_techniques.h"
#include "tests/judge/judge.h"

namespace intaglio::d3d9 {
namespace {

// The point that a first pass found, so that a march towards the light stands alone.
class Given : public dsl::Search {
  public:
    dsl::Hit find(const dsl::Relief&, const dsl::Ray& ray) const override {
        using namespace dsl;
        const sampler2D pass("first_pass", "displaced coordinate and height");
        const float4 texel = pass.sample_level(ray.uv, float1(0.0f));
        return {texel.xy(), texel.z()};
    }
};

using Knobs = std::vector<std::pair<std::string, std::string>>;

int arithmetic_of(const std::string& surface, const Knobs& knobs, bool per_vertex) {
    dsl::Catalogue catalogue = templates::all_techniques();
    catalogue.searches.push_back(dsl::entry<dsl::Search, Given>("given", "", ""));
    auto made = dsl::make_surface(catalogue, surface);
    EXPECT_TRUE(made);
    for (const auto& [knob, value] : knobs) EXPECT_TRUE(made->set_knob(knob, value));
    dsl::RecordOptions options;
    options.target = "ps_2_0";
    options.per_vertex = per_vertex;
    const auto program = dsl::record_surface(*made, options);
    EXPECT_TRUE(program);
    const auto shader = generate_pixel(*program, Profile::ps_2_0);
    EXPECT_TRUE(shader) << (shader ? "" : shader.error().message);
    return shader ? slots_of(*shader).arithmetic : 1000;
}

// "file" or "file DEFINE", by ps_2_b, which has room for the loops; the code is that of ps_2_0
// where it fits that.
std::map<std::string, int> compiled(const std::vector<std::string>& names) {
    judge::Batch batch;
    for (const std::string& name : names) {
        const std::size_t blank = name.find(' ');
        std::ifstream file(std::string(INTAGLIO_SOURCE_DIR) + "/tests/unit/d3d9_generate/hlsl/" +
                           name.substr(0, blank) + ".hlsl");
        std::stringstream text;
        text << file.rdbuf();
        EXPECT_FALSE(text.str().empty()) << name;
        judge::Batch::Defines defines;
        if (blank != std::string::npos) defines = {{name.substr(blank + 1), "1"}};
        batch.compile(text.str(), "main", "ps_2_b", defines);
    }
    std::map<std::string, int> slots;
    const auto answers = batch.run(*judge::find());
    EXPECT_TRUE(answers);
    for (std::size_t i = 0; answers && i < names.size(); ++i) {
        EXPECT_TRUE(answers->at(i).accepted) << answers->at(i).text;
        const auto shader = decode(answers->at(i).words);
        EXPECT_TRUE(shader) << names[i];
        if (shader) slots[names[i]] = slots_of(*shader).arithmetic;
        fmt::print("{:>4} arithmetic slots: {}\n", slots[names[i]], names[i]);
    }
    return slots;
}

void expect_15_percent_below(int ours, int theirs) {
    fmt::print("{:>4} ours, {} theirs: {:.0f} %\n", ours, theirs, 100.0 * ours / theirs);
    EXPECT_LE(ours, 0.85 * theirs);
}

TEST(AgainstFxc, FurOf12Steps) {
    auto theirs = compiled({"fur_loop", "fur_selects", "fur_packed"});
    const Knobs knobs = {{"min_steps", "12"}, {"max_steps", "12"}, {"ray_per_vertex", "1"}};
    const int ours = arithmetic_of("fur,output=displaced", knobs, false);
    expect_15_percent_below(ours, std::min(theirs["fur_loop"], theirs["fur_selects"]));
    // Written for it by hand, the lowering costs it as much as us, but for one slot; that it cannot
    // move work to the vertex stage remains.
    EXPECT_LT(ours, theirs["fur_packed"]);
    expect_15_percent_below(arithmetic_of("fur,output=displaced", knobs, true),
                            theirs["fur_packed"]);
}

TEST(AgainstFxc, ShadowMarchOf8Steps) {
    auto theirs =
        compiled({"shadow_loop", "shadow_selects", "shadow_packed STOPS", "shadow_packed"});
    const int ours = arithmetic_of("search=given,shadow=march,output=displaced",
                                   {{"shadow_min_steps", "8"}, {"shadow_max_steps", "8"}}, false);
    expect_15_percent_below(ours, std::min(theirs["shadow_loop"], theirs["shadow_selects"]));
    expect_15_percent_below(ours, theirs["shadow_packed STOPS"]);
    EXPECT_LT(ours, theirs["shadow_packed"]);
}

}  // namespace
}  // namespace intaglio::d3d9

// Costs of shaders whose instructions can be counted by eye.
#include "src/check/cost.h"

#include <gtest/gtest.h>

#include "src/check/frontend.h"
#include "src/check/spirv.h"
#include "tests/unit/check/shaders.h"

namespace intaglio::check {
namespace {

Result<SpirvCost> cost_of(const std::string& body, int bound) {
    const Source source{.language = Language::Glsl450,
                        .stage = Stage::Pixel,
                        .text =
                            "#version 450\n"
                            "layout(location = 0) in vec4 a;\n"
                            "layout(location = 1) flat in int steps;\n"
                            "layout(location = 0) out vec4 color;\n"
                            "layout(set = 0, binding = 16) uniform sampler2D map;\n" +
                            body};
    const Result<SpirvWords> words = to_spirv(source);
    if (!words) return words.error();
    const Result<SpirvWords> optimized = optimize_spirv(*words);
    if (!optimized) return optimized.error();
    return count_spirv(*optimized, bound);
}

TEST(Cost, OfStraightCode) {
    // Load a; fetch; multiply by it; store.  The load of `map` and the swizzle are free, and
    // spirv-opt makes one fma of the product and the sum, as nothing says `precise`.
    const Result<SpirvCost> cost = cost_of(
        "void main() {\n"
        "    vec4 b = a * a + a;\n"
        "    color = b * textureLod(map, b.xy, 0.0);\n"
        "}\n",
        1);
    ASSERT_TRUE(cost.ok()) << to_string(cost.error());
    EXPECT_EQ(cost->alu, 2);
    EXPECT_EQ(cost->texture, 1);
    EXPECT_EQ(cost->memory, 2);
    EXPECT_EQ(cost->branch, 0);
    EXPECT_EQ(cost->total, 5);
    EXPECT_EQ(cost->shortest_path, 5);
    EXPECT_EQ(cost->longest_path, 5);
}

TEST(Cost, PreciseKeepsProductAndSumApart) {
    const std::string body = "void main() {\n    PRECISE vec4 b = a * a + a;\n    color = b;\n}\n";
    const Result<SpirvCost> loose = cost_of(replaced(body, "PRECISE ", ""), 1);
    const Result<SpirvCost> strict = cost_of(replaced(body, "PRECISE ", "precise "), 1);
    ASSERT_TRUE(loose.ok() && strict.ok());
    EXPECT_EQ(loose->alu, 1);
    EXPECT_EQ(strict->alu, 2);
}

TEST(Cost, OfABranch) {
    // Load of a.x through a chain, compare, branch, store on both ways; and on one way two fetches,
    // each with its sum.
    const Result<SpirvCost> cost = cost_of(
        "void main() {\n"
        "    if (a.x < 0.5) { color = vec4(0.0); return; }\n"
        "    vec4 b = textureLod(map, a.xy, 0.0);\n"
        "    color = b + textureLod(map, b.xy, 0.0);\n"
        "}\n",
        1);
    ASSERT_TRUE(cost.ok()) << to_string(cost.error());
    EXPECT_EQ(cost->texture, 2);
    EXPECT_EQ(cost->alu, 2);  // the comparison and the sum
    EXPECT_EQ(cost->longest_path - cost->shortest_path, 2 + 1 + (cost->memory - 3))
        << "the dear way has two fetches, a sum and its own loads more";
    EXPECT_LT(cost->longest_path, cost->total) << "nobody takes both ways";
}

TEST(Cost, GrowsLinearlyWithTheLoopBound) {
    for (const Language language : spirv_languages) {
        const Result<SpirvWords> words = to_spirv(parallax_pixel(language));
        ASSERT_TRUE(words.ok());
        const Result<SpirvWords> optimized = optimize_spirv(*words);
        ASSERT_TRUE(optimized.ok());
        std::vector<SpirvCost> costs;
        for (const int bound : {8, 16, 24, 48}) {
            const Result<SpirvCost> cost = count_spirv(*optimized, bound);
            ASSERT_TRUE(cost.ok()) << to_string(cost.error());
            costs.push_back(*cost);
        }
        const std::int64_t step = costs[1].longest_path - costs[0].longest_path;
        EXPECT_GT(step, 8 * 5) << "a pass has a fetch, a comparison and its arithmetic";
        EXPECT_EQ(costs[2].longest_path - costs[1].longest_path, step) << name_of(language);
        EXPECT_EQ(costs[3].longest_path - costs[2].longest_path, 3 * step) << name_of(language);
        EXPECT_EQ(costs[0].shortest_path, costs[3].shortest_path);
        EXPECT_EQ(costs[0].total, costs[3].total);
        EXPECT_EQ(costs[0].texture, 2) << "one before the loop, one in it";
    }
}

TEST(Cost, CountsACalledFunctionOnceButItsPathEachTime) {
    // Unoptimised, so that the call stays.
    const Source source{.language = Language::Glsl450,
                        .stage = Stage::Pixel,
                        .text =
                            "#version 450\n"
                            "layout(location = 0) out vec4 color;\n"
                            "layout(set = 0, binding = 16) uniform sampler2D map;\n"
                            "vec4 fetch(vec2 at) { return textureLod(map, at, 0.0); }\n"
                            "void main() { color = fetch(vec2(0.1)) + fetch(vec2(0.2)); }\n"};
    const Result<SpirvWords> words = to_spirv(source);
    ASSERT_TRUE(words.ok()) << to_string(words.error());
    const Result<SpirvCost> cost = count_spirv(*words, 1);
    ASSERT_TRUE(cost.ok()) << to_string(cost.error());
    EXPECT_EQ(cost->texture, 1);
    EXPECT_EQ(cost->alu, 1);
    // fetch: load `at`, fetch.  main: two stores of the parameter, a sum, a store.
    EXPECT_EQ(cost->total, 2 + 4);
    EXPECT_EQ(cost->shortest_path, 2 * 2 + 4);
    EXPECT_EQ(cost->longest_path, 2 * 2 + 4);
}

TEST(Cost, RefusesANegativeBound) {
    const Result<SpirvCost> negative = cost_of("void main() { color = a; }\n", -1);
    ASSERT_FALSE(negative.ok());
    EXPECT_EQ(negative.error().code, "bad-bound");
}

}  // namespace
}  // namespace intaglio::check

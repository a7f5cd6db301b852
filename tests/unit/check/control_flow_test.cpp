// Path costs on graphs small enough to count by hand, and against walking them.
#include "src/check/control_flow.h"

#include <gtest/gtest.h>

#include <random>

namespace intaglio::check {
namespace {

FlowBlock block(std::int64_t cost, std::vector<int> successors, int loop_merge = -1) {
    FlowBlock result;
    result.cost = {cost, cost};
    result.ends = successors.empty();
    result.successors = std::move(successors);
    result.loop_merge = loop_merge;
    return result;
}

TEST(PathCost, BranchTakesTheCheapAndTheDearSide) {
    //      0 (2) -> 1 (3) or 2 (10) -> 3 (1)
    const std::vector<FlowBlock> blocks{block(2, {1, 2}), block(3, {3}), block(10, {3}),
                                        block(1, {})};
    EXPECT_EQ(path_cost(blocks, 7), (PathCost{6, 13}));
}

// for (...; test; ++i) { body }: the head tests, so N passes visit it N + 1 times.
std::vector<FlowBlock> for_loop(std::int64_t test, std::int64_t body) {
    return {block(1, {1}), block(0, {2}, 4), block(test, {3, 4}), block(body, {1}), block(5, {})};
}

TEST(PathCost, ForLoopIsLinearInItsBound) {
    const std::vector<FlowBlock> blocks = for_loop(2, 30);
    for (int bound : {0, 1, 2, 10, 65535}) {
        EXPECT_EQ(path_cost(blocks, bound), (PathCost{1 + 2 + 5, 1 + bound * 32ll + 2 + 5}))
            << bound;
    }
}

TEST(PathCost, EarlyExitCountsOnTheLastPass) {
    // 1 tests; 2 may break by way of 5, which costs 100; 3 ends the pass.
    const std::vector<FlowBlock> blocks{block(1, {1}), block(2, {2, 4}, 4), block(3, {5, 3}),
                                        block(4, {1}), block(7, {}),        block(100, {4})};
    EXPECT_EQ(path_cost(blocks, 0)->shortest, 1 + 2 + 7);
    // (N - 1) whole passes of 9, then out by 5: 105; dearer than N passes and the test: 9 + 2.
    EXPECT_EQ(path_cost(blocks, 10)->longest, 1 + 9 * 9 + 105 + 7);
    // The cheap way out wins when the early exit is cheap.
    std::vector<FlowBlock> cheap = blocks;
    cheap[5].cost = {0, 0};
    EXPECT_EQ(path_cost(cheap, 10)->longest, 1 + 10 * 9 + 2 + 7);
}

TEST(PathCost, NestedLoopsMultiply) {
    // outer: 1 tests, inner: 2 tests, 3 body, 4 after the inner loop, 5 the end.
    const std::vector<FlowBlock> blocks{block(0, {1}),  block(1, {2, 5}, 5), block(1, {3, 4}, 4),
                                        block(10, {2}), block(2, {1}),       block(0, {})};
    const std::int64_t inner = 3 * (1 + 10) + 1;
    EXPECT_EQ(path_cost(blocks, 3)->longest, 3 * (1 + inner + 2) + 1);
    EXPECT_EQ(path_cost(blocks, 3)->shortest, 1);
}

TEST(PathCost, ReturnInsideALoopEndsThePath) {
    // 1 tests or leaves to 3; 2 returns or goes round.
    std::vector<FlowBlock> blocks{block(1, {1}), block(1, {2, 3}, 3), block(4, {4, 1}),
                                  block(50, {}), block(0, {})};
    EXPECT_EQ(path_cost(blocks, 4), (PathCost{1 + 1 + 4, 1 + 4 * 5 + 1 + 50}));
}

TEST(PathCost, ALoopThatNeverRepeatsIsPassedOnce) {
    // do { ... } while (false), as spirv-opt writes it: the way back is not reachable.
    const std::vector<FlowBlock> blocks{block(1, {1}), block(3, {2}, 2), block(1, {}),
                                        block(100, {1})};
    EXPECT_EQ(path_cost(blocks, 1000), (PathCost{5, 5}));
    EXPECT_EQ(reachable_blocks(blocks), (std::vector<bool>{true, true, true, false}));
}

TEST(PathCost, NothingEndsIsSaid) {
    EXPECT_FALSE(path_cost({block(1, {1}), block(1, {1}, 2), block(1, {})}, 3).has_value());
    EXPECT_FALSE(path_cost({}, 3).has_value());
}

TEST(PathCost, SaturatesInsteadOfOverflowing) {
    std::vector<FlowBlock> blocks{block(1, {1})};
    constexpr int depth = 6;  // 2^31 to the sixth power does not fit
    for (int level = 0; level < depth; ++level) {
        // Head at 1 + level; it enters the next head, or leaves to its merge.
        const int merge = 2 * depth + 1 - level;
        blocks.push_back(block(1, {2 + level, merge}, merge));
    }
    blocks.push_back(block(1, {depth}));  // innermost body
    for (int level = depth - 1; level > 0; --level) blocks.push_back(block(1, {level}));
    blocks.push_back(block(1, {}));
    const std::optional<PathCost> cost = path_cost(blocks, 2147483647);
    ASSERT_TRUE(cost.has_value());
    EXPECT_GT(cost->longest, std::int64_t{1} << 60);
    EXPECT_GE(cost->longest, cost->shortest);
}

// Acyclic graphs: every path found by walking lies between the two, and both are reached.
TEST(PathCost, AgreesWithWalkingRandomGraphs) {
    constexpr std::uint32_t seed = 7411;
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    for (int round = 0; round < 200; ++round) {
        const int size = 2 + static_cast<int>(random() % 9);
        std::vector<FlowBlock> blocks;
        for (int i = 0; i < size; ++i) {
            std::vector<int> next;
            for (int k = 0; k < 2 && i + 1 < size; ++k) {
                next.push_back(i + 1 +
                               static_cast<int>(random() % static_cast<unsigned>(size - i - 1)));
            }
            blocks.push_back(block(random() % 20, std::move(next)));
        }
        PathCost walked{1 << 30, 0};
        const auto walk = [&](auto&& self, int at, std::int64_t sum) -> void {
            const FlowBlock& here = blocks[static_cast<std::size_t>(at)];
            sum += here.cost.shortest;
            if (here.ends) {
                walked.shortest = std::min(walked.shortest, sum);
                walked.longest = std::max(walked.longest, sum);
            }
            for (const int next : here.successors) self(self, next, sum);
        };
        walk(walk, 0, 0);
        EXPECT_EQ(path_cost(blocks, 5), walked) << "round " << round;
    }
}

TEST(PathCost, ThousandsOfBlocksInARow) {
    constexpr int count = 20000;
    std::vector<FlowBlock> blocks;
    for (int i = 0; i < count; ++i) {
        blocks.push_back(block(1, i + 1 < count ? std::vector<int>{i + 1} : std::vector<int>{}));
    }
    EXPECT_EQ(path_cost(blocks, 1), (PathCost{count, count}));
}

}  // namespace
}  // namespace intaglio::check

// The loop this compiler is about: a march through a height map that stops at the first hit, in all
// its forms.  Rolled, unrolled into branches, unrolled into selects and flattened agree to the bit,
// with as many reads as each must have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "generator/ir/builder.h"
#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/close_inductions.h"
#include "generator/passes/flatten_branches.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/rewrite.h"
#include "generator/passes/unroll_loops.h"
#include "tests/unit/passes/environment.h"

namespace intaglio::passes {
namespace {

using namespace testing;
using namespace ir;

enum class Position { FromIndex, Accumulated };

// Steps down in equal steps; breaks with the height at the hit; the position comes from the index
// or from the step before.
Module march(int taps, Position position = Position::FromIndex, bool closed_form = false) {
    Module module;
    module.name = "march";
    module.inputs = {{"uv", float2, Semantic::Interpolant},
                     {"slope", float2, Semantic::Interpolant}};
    module.outputs = {{"hit", float2, Semantic::Target}};
    module.samplers = {{"height", 2, ""}};
    Builder builder(module);
    const ValueId uv = builder.input(0), slope = builder.input(1);
    const ValueId zero = builder.constant(0.0f), one = builder.constant(1.0f);
    const ValueId size = builder.constant(1.0f / static_cast<float>(taps));
    const Builder::LoopScope loop = builder.begin_loop(
        {"march", taps, LoopForm::Unspecified, closed_form}, std::array{zero, zero});
    const ValueId t = loop.carried[0];
    const ValueId offset = builder.emit(Op::Mul, {slope, builder.swizzle(t, "xx")});
    const ValueId texel =
        builder.sample(Op::SampleLevel, 0, {builder.emit(Op::Sub, {uv, offset}), zero});
    const ValueId height = builder.swizzle(texel, "w");
    const ValueId ray = builder.emit(Op::Sub, {one, t});
    builder.break_if(builder.emit(Op::GreaterEqual, {height, ray}), std::array{t, height});
    const ValueId next_index = builder.emit(Op::Add, {loop.index, builder.constant(1)});
    const ValueId next =
        position == Position::FromIndex
            ? builder.emit(Op::Mul, {builder.emit(Op::ToFloat, {next_index}), size})
            : builder.emit(Op::Add, {t, size});
    const std::vector<ValueId> found = builder.end_loop(std::array{next, height});
    const ValueId hit = builder.compose(found);
    builder.finish({&hit, 1});
    return module;
}

long executed_reads(const Module& module, const Environment& environment) {
    return Evaluator(module).run(environment, Precision::Single).texture_reads;
}

struct Form {
    const char* name;
    bool reads_everything;
    void (*make)(Module&);
};

constexpr Form forms[] = {
    {"branches", false, [](Module& module) { unroll_loops(module, Loops::All); }},
    {"selects", true, [](Module& module) { unroll_loops(module, Loops::All, EarlyExit::Select); }},
    {"branches, flattened", true,
     [](Module& module) {
         unroll_loops(module, Loops::All);
         flatten_branches(module);
     }},
    {"optimized", false,
     [](Module& module) { EXPECT_TRUE(optimize(module, {.verify_each = true}).ok()); }},
    {"optimized, unrolled", true,
     [](Module& module) {
         EXPECT_TRUE(optimize(module, {.unroll_all = true, .verify_each = true}).ok());
     }},
    {"optimized, flat", true,
     [](Module& module) {
         EXPECT_TRUE(
             optimize(module, {.unroll_all = true, .flatten_all = true, .verify_each = true}).ok());
     }},
};

void expect_same_march(const Module& rolled, const Module& other, const Form& form, int taps,
                       std::uint64_t seed) {
    const Textures textures(seed);
    const Evaluator before(rolled), after(other);
    Random random(seed);
    long least = taps, most = 0;
    for (int i = 0; i < 100; ++i) {
        Environment environment;
        const auto any = [&] { return static_cast<double>(random.unit()); };
        environment.inputs = {{any(), any()}, {any(), any()}};
        environment.samplers = {textures.of_dimension(2)};
        const Evaluation a = before.run(environment, Precision::Single),
                         b = after.run(environment, Precision::Single);
        ASSERT_EQ(difference(a, b, Precision::Single), "")
            << form.name << ", " << taps << " taps, seed " << seed;
        ASSERT_EQ(b.texture_reads, form.reads_everything ? taps : a.texture_reads) << form.name;
        least = std::min(least, a.texture_reads);
        most = std::max(most, a.texture_reads);
    }
    EXPECT_TRUE(taps <= 8 || least < most) << "no ray left the march early: the test shows nothing";
}

TEST(March, AllFormsAgreeToTheBit) {
    for (int taps : {1, 2, 7, 32, 60})
        for (Position position : {Position::FromIndex, Position::Accumulated})
            for (const Form& form : forms) {
                const Module rolled = march(taps, position);
                Module other = rolled;
                form.make(other);
                const Status status = verify(other);
                ASSERT_TRUE(status.ok()) << to_string(status.error());
                expect_same_march(rolled, other, form, taps, 11);
            }
}

TEST(March, TwoHundredFiftySixIterationsUnrollFlat) {
    const Module rolled = march(256);
    for (const Form& form : {forms[1], forms[2], forms[5]}) {
        Module other = rolled;
        form.make(other);
        int instructions = 0;
        for_each_instruction(other.body, [&](const Instruction&) { ++instructions; });
        EXPECT_LT(instructions, 256 * 16)
            << form.name << ": more than the body, an index and selects for each iteration";
        expect_same_march(rolled, other, form, 256, 12);
    }
}

TEST(March, UnrollsWithoutNestingWhateverItsLength) {
    Module module = march(256);
    ASSERT_TRUE(optimize(module, {.unroll_all = true, .verify_each = true}).ok());
    for_each_instruction(module.body, [](const Instruction& i) { EXPECT_TRUE(i.regions.empty()); });
}

TEST(March, FloatInductionClosesOnlyByConsent) {
    Module strict = march(16, Position::Accumulated, false);
    EXPECT_TRUE(close_inductions(strict).empty());
    Module consenting = march(16, Position::Accumulated, true);
    const Module before = consenting;
    EXPECT_EQ(close_inductions(consenting).size(), 1u);
    const Status status = verify(consenting);
    ASSERT_TRUE(status.ok()) << to_string(status.error());
    // 1/16 is a power of two: every sum is exact, and the closed form has the same bits.
    const Form form{"closed form", false, nullptr};
    expect_same_march(before, consenting, form, 16, 13);
    // What was accumulated and what comes from the index are one computation now.
    const Module from_index = march(16, Position::FromIndex);
    expect_same_march(from_index, consenting, form, 16, 14);
}

TEST(March, UnrolledOnlyWhereScheduled) {
    Module module = march(8);
    unroll_loops(module);
    EXPECT_EQ(print(module), print(march(8))) << "an unspecified loop is the target's choice";
    for_each_instruction(module.body, [](Instruction& i) {
        if (i.op == Op::Loop) i.loop.form = LoopForm::Unrolled;
    });
    unroll_loops(module);
    int loops = 0;
    for_each_instruction(module.body,
                         [&](const Instruction& i) { loops += i.op == Op::Loop ? 1 : 0; });
    EXPECT_EQ(loops, 0);
    EXPECT_EQ(executed_reads(module, {}), executed_reads(march(8), {}));
}

TEST(Pipeline, RunsItsListAloudAndIsDeterministic) {
    std::vector<std::string> names;
    PipelineOptions options;
    options.flatten_all = options.unroll_all = true;
    options.after_each = [&](std::string_view name, const Module& module) {
        names.emplace_back(name);
        EXPECT_TRUE(verify(module).ok()) << name;
    };
    Module first = march(4), second = march(4);
    ASSERT_TRUE(optimize(first, options).ok());
    const std::vector<std::string> round = {"fold_constants",
                                            "eliminate_common_subexpressions",
                                            "hoist_loop_invariants",
                                            "close_inductions",
                                            "unroll_loops",
                                            "fold_constants",
                                            "flatten_branches",
                                            "fold_constants",
                                            "eliminate_common_subexpressions",
                                            "remove_dead_code"};
    // In this order, round after round, without those that would find nothing.
    std::size_t rounds = 0, place = round.size();
    for (const std::string& name : names) {
        const auto later =
            std::find(round.begin() + static_cast<std::ptrdiff_t>(place), round.end(), name);
        const auto found =
            later != round.end() ? later : std::find(round.begin(), round.end(), name);
        ASSERT_NE(found, round.end()) << name;
        if (later == round.end()) ++rounds;
        place = static_cast<std::size_t>(found - round.begin()) + 1;
    }
    EXPECT_GE(rounds, 2u) << "one must find that nothing changes any more";
    EXPECT_LE(rounds, 4u);
    for (const std::string& name : round) EXPECT_THAT(names, ::testing::Contains(name));
    EXPECT_LT(names.size(), rounds * round.size()) << "something is left out";
    ASSERT_TRUE(optimize(second, {.unroll_all = true, .flatten_all = true}).ok());
    EXPECT_TRUE(first == second);
}

}  // namespace
}  // namespace intaglio::passes

// What holds of every pass on every module: the result verifies, computes the same bits, reads no
// more textures than its page says, and a second run of the pass changes nothing.
#include <gtest/gtest.h>

#include <functional>

#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/close_inductions.h"
#include "generator/passes/count_texture_reads.h"
#include "generator/passes/eliminate_common_subexpressions.h"
#include "generator/passes/flatten_branches.h"
#include "generator/passes/fold_constants.h"
#include "generator/passes/hoist_loop_invariants.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/remove_dead_code.h"
#include "generator/passes/rewrite.h"
#include "generator/passes/unroll_loops.h"
#include "tests/unit/ir/random_module.h"
#include "tests/unit/passes/environment.h"

namespace intaglio::passes {
namespace {

using namespace testing;
using ir::Module;
using ir::Precision;

struct Property {
    std::string name;
    std::function<void(Module&)> run;
    bool same_in_double =
        true;  // constants are folded in binary32, so that folding changes binary64
    bool may_add_reads = false;  // both sides of a branch run
    bool idempotent = true;
};

void optimize_or_fail(Module& module, PipelineOptions options) {
    options.verify_each = true;
    const auto notes = optimize(module, options);
    ASSERT_TRUE(notes.ok()) << to_string(notes.error());
}

std::vector<Property> properties() {
    return {
        {"compact_values", compact_values},
        {"fold_constants", fold_constants, false},
        {"eliminate_common_subexpressions", eliminate_common_subexpressions},
        {"remove_dead_code", remove_dead_code},
        {"hoist_loop_invariants", hoist_loop_invariants},
        {"close_inductions", [](Module& module) { close_inductions(module); }},
        {"unroll_loops", [](Module& module) { unroll_loops(module); }},
        {"unroll_loops all", [](Module& module) { unroll_loops(module, Loops::All); }},
        {"unroll_loops all select",
         [](Module& module) { unroll_loops(module, Loops::All, EarlyExit::Select); }, true, true},
        {"flatten_branches", [](Module& module) { flatten_branches(module); }, true, true},
        {"flatten_branches outside loops",
         [](Module& module) { flatten_branches(module, Branches::OutsideLoops); }, true, true},
        {"count_texture_reads", count_texture_reads, true, false, false},
        {"optimize", [](Module& module) { optimize_or_fail(module, {}); }, false},
        {"optimize flat",
         [](Module& module) {
             optimize_or_fail(module, {.unroll_all = true, .flatten_all = true});
         },
         false, true},
        {"optimize unrolled",
         [](Module& module) { optimize_or_fail(module, {.unroll_all = true}); }, false},
    };
}

// Floats that grow in a loop are rewritten only by consent, and then round differently: not here.
void withdraw_consent(ir::Region& region) {
    for_each_instruction(
        region, [](ir::Instruction& instruction) { instruction.loop.closed_form = false; });
}

// Every value of the top level becomes a result of a function, so that no mistake hides in dead
// code.
void return_everything(Module& module) {
    module.stage = ir::Stage::Function;
    for (ir::Declaration& input : module.inputs) input.semantic = ir::Semantic::Parameter;
    module.outputs.clear();
    std::vector<ir::ValueId>& returned = module.body.body.back().operands;
    returned.clear();
    for (const ir::Instruction& instruction : module.body.body)
        returned.insert(returned.end(), instruction.results.begin(), instruction.results.end());
    for (ir::ValueId value : returned)
        module.outputs.push_back({fmt::format("result{}", module.outputs.size()),
                                  module.type(value), ir::Semantic::Result});
}

Module random_case(std::uint64_t seed) {
    ir::testing::RandomModuleOptions options;
    options.instructions = 20 + static_cast<int>(seed % 60);
    options.odd_text = seed % 4 == 0;
    Module module = ir::testing::random_module(seed, options);
    withdraw_consent(module.body);
    if (seed % 2 == 0) return_everything(module);
    return module;
}

class EveryPass : public ::testing::TestWithParam<Property> {};

TEST_P(EveryPass, KeepsWhatRandomModulesCompute) {
    const Property& pass = GetParam();
    const Textures textures(1);
    // Other modules for each pass, 15 * 400 in all.
    const std::uint64_t first = 1000 * static_cast<std::uint64_t>(pass.name.size());
    for (std::uint64_t seed = first; seed < first + 400; ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        const Module before = random_case(seed);
        Module after = before;
        pass.run(after);
        const Status status = ir::verify(after);
        ASSERT_TRUE(status.ok()) << to_string(status.error()) << "\nbefore:\n"
                                 << ir::print(before) << "\nafter:\n"
                                 << ir::print(after);
        const auto read_back = ir::parse(ir::print(after), "after");
        ASSERT_TRUE(read_back.ok() && *read_back == after) << ir::print(after);

        const ir::Evaluator original(before), rewritten(after);
        Random random(seed);
        for (int i = 0; i < 3; ++i) {
            const ir::Environment environment = random_environment(random, before, textures);
            const ir::Environment adapted = adapt(environment, before, after);
            for (Precision precision : {Precision::Single, Precision::Double}) {
                if (precision == Precision::Double && !pass.same_in_double) continue;
                const ir::Evaluation a = original.run(environment, precision);
                const ir::Evaluation b = rewritten.run(adapted, precision);
                ASSERT_EQ(difference(a, b, precision), "")
                    << (precision == Precision::Single ? "in single\n" : "in double\n")
                    << "before:\n"
                    << ir::print(before) << "\nafter:\n"
                    << ir::print(after);
                if (!pass.may_add_reads) {
                    ASSERT_LE(b.texture_reads, a.texture_reads) << ir::print(before);
                }
            }
        }
        if (!pass.idempotent) continue;
        Module again = after;
        pass.run(again);
        ASSERT_EQ(ir::print(again), ir::print(after))
            << "a second run changed the module; before:\n"
            << ir::print(before);
        ASSERT_TRUE(again == after);
    }
}

INSTANTIATE_TEST_SUITE_P(Passes, EveryPass, ::testing::ValuesIn(properties()),
                         [](const auto& test) {
                             std::string name = test.param.name;
                             std::replace(name.begin(), name.end(), ' ', '_');
                             return name;
                         });

TEST(CountTextureReads, AgreesWithTheEvaluator) {
    const Textures textures(2);
    long most = 0;
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
        const Module before = random_case(seed);
        Module after = before;
        count_texture_reads(after);
        Random random(seed);
        for (int i = 0; i < 4; ++i) {
            const ir::Environment environment = random_environment(random, before, textures);
            const ir::Evaluation evaluation =
                ir::Evaluator(after).run(environment, Precision::Single);
            const ir::Environment::Vector expected = {static_cast<double>(evaluation.texture_reads),
                                                      0, 0, 0};
            ASSERT_EQ(evaluation.outputs.back(), expected) << "seed " << seed << "\n"
                                                           << ir::print(after);
            most = std::max(most, evaluation.texture_reads);
        }
    }
    EXPECT_GT(most, 5) << "the random modules hardly read textures";
}

TEST(CompactValues, NumbersInBuilderOrder) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        ir::testing::RandomModuleOptions options;
        options.unused_values = false;
        const Module built = ir::testing::random_module(seed, options);
        Module module = built;
        compact_values(module);
        ASSERT_TRUE(module == built)
            << "seed " << seed << ": a module from the builder is numbered already";
    }
}

}  // namespace
}  // namespace intaglio::passes

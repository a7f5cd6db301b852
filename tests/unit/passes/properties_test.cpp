// What holds of every pass on every module: the result verifies, computes the same bits, reads no
// more textures than its page says, and a second run of the pass changes nothing.
#include <gtest/gtest.h>

#include <functional>
#include <ostream>

#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/close_inductions.h"
#include "generator/passes/count_texture_reads.h"
#include "generator/passes/eliminate_common_subexpressions.h"
#include "generator/passes/flatten_branches.h"
#include "generator/passes/fold_constants.h"
#include "generator/passes/hoist_loop_invariants.h"
#include "generator/passes/lower_first_hit.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/remove_dead_code.h"
#include "generator/passes/rewrite.h"
#include "generator/passes/unroll_loops.h"
#include "tests/rounds.h"
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

void PrintTo(const Property& pass, std::ostream* out) { *out << pass.name; }

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
        {"lower_first_hit",
         [](Module& module) { lower_first_hit(module, FirstHitForm::PackedRefetch); }, false, true,
         false},
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
    // Mostly other modules for each pass: the names differ in length.
    const std::uint64_t first = 1000 * static_cast<std::uint64_t>(pass.name.size());
    for (std::uint64_t seed = first; seed < first + rounds(400u); ++seed) {
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
    for (std::uint64_t seed = 1; seed <= rounds(500u); ++seed) {
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
    EXPECT_GT(most, 4) << "the random modules hardly read textures";
}

// Every op with its operands in both orders: merging them must not change either.
TEST(EliminateCommonSubexpressions, KnowsWhichOpsCommute) {
    using namespace ir;
    int merged = 0;
    for (const OpInfo& row : all_ops()) {
        if (row.operand_count != 2 || !is_arithmetic(row.op)) continue;
        for (Scalar scalar : {Scalar::Float, Scalar::Int, Scalar::Bool}) {
            const bool takes_float = row.type_rule != TypeRule::Logic;
            const bool takes_int =
                row.type_rule == TypeRule::SameNumeric || row.type_rule == TypeRule::Compare;
            if (scalar == Scalar::Float ? !takes_float
                : scalar == Scalar::Int ? !takes_int
                                        : takes_float)
                continue;
            const Type type{scalar, row.type_rule == TypeRule::Cross ? 3 : 1};
            Module before;
            before.stage = Stage::Function;
            for (const char* name : {"a", "b"})
                before.inputs.push_back({name, type, Semantic::Parameter});
            Builder builder(before);
            const ValueId a = builder.input(0), b = builder.input(1);
            const std::array results = {builder.emit(row.op, {a, b}), builder.emit(row.op, {b, a})};
            builder.finish(results);
            for (const char* name : {"ab", "ba"})
                before.outputs.push_back({name, before.type(results[0]), Semantic::Result});
            Module after = before;
            eliminate_common_subexpressions(after);
            if (after.values.size() < before.values.size()) ++merged;
            Random random(5);
            for (int i = 0; i < rounds(500); ++i) {
                const Environment environment = random_environment(random, before, Textures(1));
                const Evaluation x = Evaluator(before).run(environment, Precision::Single);
                const Evaluation y = Evaluator(after).run(environment, Precision::Single);
                ASSERT_EQ(difference(x, y, Precision::Single), "") << row.name;
            }
        }
    }
    EXPECT_EQ(merged, 11) << "add, mul, equal and not_equal of floats and ints; dot; and, or";
}

// Loops whose carried ints grow by what stands outside, inside, or by themselves.
TEST(CloseInductions, KeepsWhatIntLoopsCompute) {
    using namespace ir;
    std::size_t closed = 0;
    for (std::uint64_t seed = 1; seed <= rounds(500u); ++seed) {
        Random random(seed);
        Module before;
        before.stage = Stage::Function;
        for (const char* name : {"a", "b", "c"}) {
            before.inputs.push_back({name, int1, Semantic::Parameter});
            before.outputs.push_back({name, int1, Semantic::Result});
        }
        Builder builder(before);
        const std::array outside = {builder.input(0), builder.input(1), builder.input(2)};
        const Builder::LoopScope loop = builder.begin_loop({"sum", random.between(1, 6)}, outside);
        std::vector<ValueId> visible(outside.begin(), outside.end());
        visible.insert(visible.end(), loop.carried.begin(), loop.carried.end());
        visible.push_back(loop.index);
        const auto pick = [&] {
            return visible[static_cast<std::size_t>(
                random.below(static_cast<int>(visible.size())))];
        };
        std::vector<ValueId> next;
        for (ValueId carried : loop.carried) {
            const Op op = random.chance(50) ? Op::Add : Op::Sub;
            const ValueId step = random.chance(60) ? outside[0] : pick();
            next.push_back(op == Op::Add && random.chance(50) ? builder.emit(op, {step, carried})
                                                              : builder.emit(op, {carried, step}));
            visible.push_back(next.back());
            if (random.chance(30))
                builder.break_if(builder.emit(Op::Greater, {next.back(), pick()}),
                                 std::array{pick(), carried, next.back()});
        }
        if (random.chance(20)) std::swap(next[0], next[1]);  // then neither grows by itself
        builder.finish(builder.end_loop(next));
        Module after = before;
        closed += close_inductions(after).size();
        const Status status = verify(after);
        ASSERT_TRUE(status.ok()) << "seed " << seed << ": " << to_string(status.error());
        for (int i = 0; i < 10; ++i) {
            const Environment environment = random_environment(random, before, Textures(1));
            const Evaluation x = Evaluator(before).run(environment, Precision::Single);
            const Evaluation y = Evaluator(after).run(environment, Precision::Single);
            ASSERT_EQ(difference(x, y, Precision::Single), "") << "seed " << seed << "\n"
                                                               << print(before) << print(after);
        }
    }
    EXPECT_GT(closed, rounds(500u)) << "hardly any loop had an induction: the test shows little";
}

struct Reporting {
    const char* name;
    std::function<bool(Module&)> run;
};

// The pipeline's list for targets that have neither loops nor branches.
const std::vector<Reporting>& flat_round() {
    static const std::vector<Reporting> round = {
        {"fold_constants", fold_constants},
        {"eliminate_common_subexpressions", eliminate_common_subexpressions},
        {"hoist_loop_invariants", hoist_loop_invariants},
        {"close_inductions", [](Module& module) { return !close_inductions(module).empty(); }},
        {"unroll_loops",
         [](Module& module) { return unroll_loops(module, Loops::All, EarlyExit::Select); }},
        {"fold_constants", fold_constants},
        {"flatten_branches", [](Module& module) { return flatten_branches(module); }},
        {"fold_constants", fold_constants},
        {"eliminate_common_subexpressions", eliminate_common_subexpressions},
        {"remove_dead_code", remove_dead_code}};
    return round;
}

// What a pass reports decides whether it is run again: a change that it does not report is lost,
// one that it reports without making it costs time.
TEST(Reports, SayWhetherAPassChangedTheModule) {
    int changed = 0, idle = 0;
    for (std::uint64_t seed = 1; seed <= rounds(150u); ++seed) {
        Module module = random_case(seed);
        compact_values(module);
        for (int round = 0; round < 3; ++round)
            for (const Reporting& pass : flat_round()) {
                const Module before = module;
                const bool reported = pass.run(module);
                ASSERT_EQ(reported, module != before)
                    << pass.name << ", seed " << seed << ", round " << round << "\n"
                    << ir::print(before) << ir::print(module);
                ++(reported ? changed : idle);
            }
    }
    EXPECT_GT(changed, rounds(500));
    EXPECT_GT(idle, rounds(500));
}

TEST(Pipeline, IsItsListRepeatedUntilNothingChanges) {
    for (std::uint64_t seed = 1; seed <= rounds(150u); ++seed) {
        const Module start = random_case(seed);
        Module optimized = start, plain = start;
        optimize_or_fail(optimized, {.unroll_all = true, .flatten_all = true});
        for (Module before; plain != before;) {
            before = plain;
            for (const Reporting& pass : flat_round()) pass.run(plain);
        }
        ASSERT_TRUE(optimized == plain) << "seed " << seed << "\n"
                                        << ir::print(optimized) << ir::print(plain);
    }
}

TEST(CompactValues, NumbersInBuilderOrder) {
    for (std::uint64_t seed = 1; seed <= rounds(200u); ++seed) {
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

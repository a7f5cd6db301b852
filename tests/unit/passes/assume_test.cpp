// What is known, folded in: the bounds hold for every value within theirs, a module computes the
// same bits wherever what is assumed holds, and errors are sentences.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/assume.h"
#include "generator/passes/range_analysis.h"
#include "generator/passes/rewrite.h"
#include "tests/rounds.h"
#include "tests/unit/ir/random_module.h"
#include "tests/unit/passes/environment.h"

namespace intaglio::passes {
namespace {

using namespace testing;
using namespace ir;

// --- bounds

// Ends that matter, and any.
float random_end(Random& random) {
    static const float ends[] = {0.0f, -0.0f, 1.0f, -1.0f, 0.25f, 2.0f, 1e-30f, 1e30f, 1e-18f};
    if (random.chance(40)) return ends[random.below(std::size(ends))];
    if (random.chance(30)) return random.any_float();
    return random.unit() * 4 - 2;
}

Interval random_interval(Random& random) {
    for (;;) {
        const float a = random_end(random), b = random.chance(20) ? a : random_end(random);
        if (a != a || b != b) continue;
        return is_below(static_cast<double>(b), static_cast<double>(a)) ? Interval{b, a}
                                                                        : Interval{a, b};
    }
}

// An end, a zero or something between.
double random_value(Random& random, const Interval& interval) {
    const auto least = static_cast<double>(interval.least),
               most = static_cast<double>(interval.most);
    const auto inside = [&](double x) { return !is_below(x, least) && !is_below(most, x); };
    if (random.chance(20)) return least;
    if (random.chance(20)) return most;
    for (double zero : {+0.0, -0.0})
        if (random.chance(20) && inside(zero)) return zero;
    const float share = random.unit();
    const auto mixed = static_cast<double>(interval.least * (1 - share) + interval.most * share);
    return inside(mixed) ? mixed : least;
}

// A denormal that was only moved counts as the zero of its sign (rewrite_rules.h).
bool holds(const Range& range, double x) {
    if (x != x) return range.nan;
    if (std::fabs(x) < static_cast<double>(std::numeric_limits<float>::min()) &&
        !is_below(std::copysign(0.0, x), range.least) &&
        !is_below(range.most, std::copysign(0.0, x)))
        return true;
    return !is_below(x, range.least) && !is_below(range.most, x);
}

// Every op over float, int and bool operands within random intervals.
TEST(RangeAnalysis, EveryOpStaysWithinItsBounds) {
    Random random(1);
    int decided = 0;
    for (int round = 0; round < rounds(6000); ++round) {
        const auto& rows = all_ops();
        const OpInfo& row =
            rows[static_cast<std::size_t>(random.below(static_cast<int>(rows.size())))];
        const bool pure = row.op >= Op::Add && row.op <= Op::ToFloat && row.operand_count > 0;
        if (!pure) continue;
        const bool logic = row.type_rule == TypeRule::Logic;
        const bool may_be_int =
            row.type_rule == TypeRule::SameNumeric || row.type_rule == TypeRule::Compare;
        const Scalar scalar = logic                             ? Scalar::Bool
                              : row.op == Op::ToFloat           ? Scalar::Int
                              : may_be_int && random.chance(20) ? Scalar::Int
                                                                : Scalar::Float;
        const int width = row.type_rule == TypeRule::Cross ? 3 : row.op == Op::Dot ? 2 : 1;
        Module module;
        module.stage = Stage::Function;
        Builder builder(module);
        std::vector<ValueId> operands;
        for (int i = 0; i < row.operand_count; ++i) {
            const bool condition = row.op == Op::Select && i == 0;
            module.inputs.push_back({fmt::format("i{}", i), condition ? bool1 : Type{scalar, width},
                                     Semantic::Parameter});
            operands.push_back(builder.input(i));
        }
        if (row.operand_count > 1 && row.op != Op::Select && random.chance(20))
            operands[1] = operands[0];
        const ValueId result = builder.emit(row.op, operands);
        builder.finish(std::array{result});
        module.outputs.push_back({"result", module.type(result), Semantic::Result});

        std::vector<std::array<Interval, 4>> intervals;
        Assumptions assumptions;
        assumptions.values.resize(module.values.size());
        for (int i = 0; i < row.operand_count; ++i) {
            auto& one = intervals.emplace_back();
            for (std::size_t k = 0; k < 4; ++k) {
                one[k] = random_interval(random);
                if (scalar != Scalar::Float ||
                    module.inputs[static_cast<std::size_t>(i)].type != Type{scalar, width})
                    continue;
                assumptions.values[static_cast<std::size_t>(i)][k] = Range::between(
                    static_cast<double>(one[k].least), static_cast<double>(one[k].most));
            }
        }
        const RangeFacts facts = analyze_ranges(module, assumptions);
        const Ranges& bounds = facts.values[index_of(result)];
        const Evaluator evaluator(module);
        for (int i = 0; i < 20; ++i) {
            Environment environment;
            for (std::size_t k = 0; k < module.inputs.size(); ++k) {
                auto& vector = environment.inputs.emplace_back();
                for (std::size_t c = 0; c < 4; ++c)
                    vector[c] = module.inputs[k].type.scalar == Scalar::Float
                                    ? random_value(random, intervals[k][c])
                                : module.inputs[k].type.scalar == Scalar::Int
                                    ? random.between(-10, 10)
                                    : random.below(2);
            }
            const Evaluation evaluation = evaluator.run(environment, Precision::Single);
            for (int c = 0; c < module.type(result).width; ++c)
                ASSERT_TRUE(holds(bounds[static_cast<std::size_t>(c)],
                                  evaluation.outputs[0][static_cast<std::size_t>(c)]))
                    << "round " << round << " component " << c << ": "
                    << evaluation.outputs[0][static_cast<std::size_t>(c)] << " not in "
                    << bounds[static_cast<std::size_t>(c)].least << " .. "
                    << bounds[static_cast<std::size_t>(c)].most << "\n"
                    << print(module);
        }
        if (bounds[0].single() || std::isfinite(bounds[0].least)) ++decided;
    }
    EXPECT_GT(decided, rounds(1000)) << "hardly anything is bounded: the test shows little";
}

// --- modules

Program random_program(std::uint64_t seed) {
    ir::testing::RandomModuleOptions options;
    options.instructions = 20 + static_cast<int>(seed % 60);
    options.special_constants = seed % 3 == 0;
    options.odd_text = false;
    options.derivatives = seed % 2 == 0;
    Program program;
    program.pixel = ir::testing::random_module(seed, options);
    Module& module = program.pixel;
    module.stage = Stage::Function;
    for (Declaration& input : module.inputs) input.semantic = Semantic::Parameter;
    // Every value of the top level is a result, so that no mistake hides in dead code, and none but
    // the inputs has a name.
    module.outputs.clear();
    std::vector<ValueId>& returned = module.body.body.back().operands;
    returned.clear();
    for (const Instruction& instruction : module.body.body)
        returned.insert(returned.end(), instruction.results.begin(), instruction.results.end());
    for (ValueId value : returned)
        module.outputs.push_back(
            {fmt::format("result{}", module.outputs.size()), module.type(value), Semantic::Result});
    for (Value& value : module.values) value.name.clear();
    return program;
}

struct Experiment {
    Known known;
    std::vector<Environment> environments;
};

// What some values inside turn out to be is assumed of them.
void assume_what_they_are(Random& random, Module& module, Experiment& experiment) {
    const Evaluator evaluator(module);
    std::vector<Evaluation> evaluations;
    for (const Environment& environment : experiment.environments)
        evaluations.push_back(evaluator.run(environment, Precision::Single));
    const std::vector<ValueId>& returned = module.body.body.back().operands;
    for (std::size_t k = 0; k < returned.size(); ++k) {
        const Type type = module.type(returned[k]);
        if (type.scalar != Scalar::Float || !random.chance(10)) continue;
        std::vector<Range> seen(static_cast<std::size_t>(type.width));
        for (const Evaluation& evaluation : evaluations)
            for (std::size_t c = 0; c < seen.size(); ++c) {
                const double x = evaluation.outputs[k][c];
                seen[c] =
                    join(seen[c], x == x ? Range::between(x, x) : Range{INFINITY, -INFINITY, true});
            }
        if (std::any_of(seen.begin(), seen.end(), [](const Range& range) { return range.nan; }))
            continue;
        const std::string name = fmt::format("named{}", k);
        module.values[index_of(returned[k])].name = name;
        for (std::size_t c = 0; c < seen.size(); ++c)
            experiment.known
                .ranges[seen.size() == 1 ? name : name + "." + std::string(1, "xyzw"[c])] = {
                static_cast<float>(seen[c].least), static_cast<float>(seen[c].most)};
    }
}

// Ranges of inputs and of some values inside, and surroundings in which they hold.  Values inside
// only where nothing looks at neighbouring pixels, of which the outputs say nothing.
Experiment random_experiment(Random& random, Program& program, const Textures& textures,
                             bool with_values) {
    Experiment experiment;
    Module& module = program.pixel;
    std::vector<std::vector<Interval>> intervals;
    for (const Declaration& input : module.inputs) {
        auto& ranges = intervals.emplace_back();
        const bool known = input.type.scalar == Scalar::Float && random.chance(80);
        for (int i = 0; i < input.type.width && known; ++i) {
            ranges.push_back(random_interval(random));
            const std::string letter(1, "xyzw"[i]);
            experiment.known
                .ranges[input.type.width == 1 ? input.name : input.name + "." + letter] =
                ranges.back();
        }
    }
    std::map<std::string, std::vector<Environment::Vector>> fixed;
    for (const Uniform& uniform : module.uniforms) {
        if (uniform.type.scalar != Scalar::Float || random.chance(50)) continue;
        for (int e = 0; e < uniform.count; ++e) {
            auto& vector = fixed[uniform.name].emplace_back();
            for (int i = 0; i < uniform.type.width; ++i) {
                const float value = random_end(random);
                experiment.known.uniforms[uniform.name].push_back(value);
                vector[static_cast<std::size_t>(i)] = static_cast<double>(value);
            }
        }
    }
    for (int n = 0; n < 4; ++n) {
        Environment environment = random_environment(random, module, textures);
        for (std::size_t i = 0; i < module.inputs.size(); ++i)
            for (std::size_t c = 0; c < intervals[i].size(); ++c)
                for (auto* inputs :
                     {&environment.inputs, &environment.right_inputs, &environment.lower_inputs})
                    (*inputs)[i][c] = random_value(random, intervals[i][c]);
        for (std::size_t i = 0; i < module.uniforms.size(); ++i)
            if (const auto one = fixed.find(module.uniforms[i].name); one != fixed.end())
                environment.uniforms[i] = one->second;
        experiment.environments.push_back(std::move(environment));
    }
    if (with_values) assume_what_they_are(random, module, experiment);
    return experiment;
}

TEST(Assume, KeepsWhatRandomModulesComputeWhereItHolds) {
    const Textures textures(1);
    std::size_t left_out = 0;
    int shortened = 0;
    for (std::uint64_t seed = 1; seed <= rounds(800u); ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        Program before = random_program(seed);
        Random random(seed);
        const Experiment experiment = random_experiment(random, before, textures, seed % 2 == 1);
        Program after = before;
        const auto notes = assume(after, experiment.known);
        ASSERT_TRUE(notes.ok()) << to_string(notes.error()) << print(before.pixel)
                                << fmt::format("{}", fmt::join(to_strings(experiment.known), "\n"));
        left_out += notes->size();
        for (const std::string& note : *notes)
            shortened += note.find("the loop") != std::string::npos ? 1 : 0;
        const Status status = verify(after.pixel);
        ASSERT_TRUE(status.ok()) << to_string(status.error()) << print(after.pixel);
        const Evaluator original(before.pixel), rewritten(after.pixel);
        for (const Environment& environment : experiment.environments) {
            const Environment adapted = adapt(environment, before.pixel, after.pixel);
            ASSERT_EQ(difference(original.run(environment, Precision::Single),
                                 rewritten.run(adapted, Precision::Single), Precision::Single),
                      "")
                << print(before.pixel) << "\nafter:\n"
                << print(after.pixel)
                << fmt::format("{}", fmt::join(to_strings(experiment.known), "\n"));
        }
    }
    EXPECT_GT(left_out, rounds(500u)) << "hardly anything was decided: the test shows little";
    EXPECT_GT(shortened, rounds(50)) << "hardly any loop was shortened";
}

// Loops run iteration by iteration, and entered once for all.
TEST(RangeAnalysis, EveryValueOfRandomModulesStaysWithinItsBounds) {
    const Textures textures(1);
    for (std::uint64_t seed = 1; seed <= rounds(600u); ++seed) {
        Program program = random_program(seed);
        Random random(seed);
        const Experiment experiment = random_experiment(random, program, textures, false);
        const Module& module = program.pixel;
        Assumptions assumptions;
        assumptions.values.resize(module.values.size());
        for_each_instruction(module.body, [&](const Instruction& instruction) {
            if (instruction.op != Op::Input) return;
            const std::string& name =
                module.inputs[static_cast<std::size_t>(instruction.slot)].name;
            const int width = module.type(instruction.result()).width;
            for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i) {
                const auto range = experiment.known.ranges.find(
                    width == 1 ? name : name + "." + std::string(1, "xyzw"[i]));
                if (range != experiment.known.ranges.end())
                    assumptions.values[index_of(instruction.result())][i] =
                        Range::between(static_cast<double>(range->second.least),
                                       static_cast<double>(range->second.most));
            }
        });
        const Evaluator evaluator(module);
        for (long affordable : {affordable_iterations, 0L}) {
            const RangeFacts facts = analyze_ranges(module, assumptions, affordable);
            for (const Environment& environment : experiment.environments) {
                const Evaluation evaluation = evaluator.run(environment, Precision::Single);
                const std::vector<ValueId>& returned = module.body.body.back().operands;
                for (std::size_t k = 0; k < returned.size(); ++k)
                    for (int c = 0; c < module.type(returned[k]).width; ++c) {
                        const auto component = static_cast<std::size_t>(c);
                        ASSERT_TRUE(holds(facts.values[index_of(returned[k])][component],
                                          evaluation.outputs[k][component]))
                            << "seed " << seed << " value " << index_of(returned[k]) << "\n"
                            << print(module);
                    }
            }
        }
    }
}

// --- what is left out, and errors

Program parsed(const std::string& text) {
    Program program;
    const auto module = parse(text, "test");
    EXPECT_TRUE(module.ok()) << to_string(module.error());
    if (module) program.pixel = *module;
    return program;
}

// A guarded unit vector, a guarded divisor of it, two uniforms, and a march whose length depends on
// the vector.
const char* const marching = R"(function "f"
input v float3 parameter
output r float1 result
uniform scale float1
uniform rows float4[2]
sampler map 2d
{
    %v float3 = input v
    %square float1 = dot %v, %v
    %tiny float1 = const 1e-18
    %guarded float1 = max %square, %tiny
    %root float1 = rsqrt %guarded
    %factor float3 = swizzle %root.xxx
    %view float3 = mul %v, %factor
    %z float1 = swizzle %view.z
    %least float1 = const 0.0009765625
    %high float1 = max %z, %least
    %scale float1 = uniform scale
    %row float4 = uniform rows[1]
    %w float1 = swizzle %row.w
    %sum float1 = add %high, %scale
    %all float1 = add %sum, %w
    %zero float1 = const 0.0
    %one float1 = const 1.0
    %t float1 = loop "march" 60 (%all) {
    (%i int1, %carried float1):
        %index float1 = to_float %i
        %sixtieth float1 = const 0.0625
        %depth float1 = mul %index, %sixtieth
        %below float1 = mul %depth, %high
        %done bool1 = greater_equal %below, %one
        break_if %done (%carried)
        %next float1 = add %carried, %depth
        yield (%next)
    }
    %uv float2 = swizzle %v.xy
    %texel float4 = sample_level map %uv, %zero
    %height float1 = swizzle %texel.x
    %clamped float1 = saturate %height
    %result float1 = add %t, %clamped
    return (%result)
}
)";

int count(const Program& program, Op op) {
    int found = 0;
    for_each_instruction(program.pixel.body, [&](const Instruction& instruction) {
        found += instruction.op == op ? 1 : 0;
    });
    return found;
}

std::vector<std::string> assumed(Program& program, const Known& known) {
    const auto notes = assume(program, known);
    EXPECT_TRUE(notes.ok()) << to_string(notes.error());
    return notes ? *notes : std::vector<std::string>{};
}

TEST(Assume, LeavesOutWhatARangeDecides) {
    Program program = parsed(marching);
    ASSERT_EQ(count(program, Op::Max), 2);
    assumed(program, {{}, {{"view.z", {0.5f, 1}}}});
    EXPECT_EQ(count(program, Op::Max), 1) << "the vector's own guard: v may be shorter than 1e-9";
    EXPECT_EQ(count(program, Op::Saturate), 1) << "nothing is known of the texture";
    for_each_instruction(program.pixel.body, [&](const Instruction& instruction) {
        if (instruction.op == Op::Loop) {
            EXPECT_EQ(instruction.loop.trip_count, 32)
                << "0.0625 * 0.5 a step; the 33rd iteration only finds that it is done";
        }
    });
    assumed(program, {{}, {{"v.z", {0.1f, 9}}, {"map.x", {0, 1}}}});
    EXPECT_EQ(count(program, Op::Max), 0) << "v is at least 0.1 long";
    EXPECT_EQ(count(program, Op::Saturate), 0);
}

TEST(Assume, AGuardOutsideItsRangeStays) {
    for (const Interval& range : {Interval{0, 1}, Interval{0x1p-11f, 1}, Interval{-1, 1}}) {
        Program program = parsed(marching);
        assumed(program, {{}, {{"view.z", range}}});
        EXPECT_EQ(count(program, Op::Max), 2) << range.least;
    }
    Program program = parsed(marching);
    assumed(program, {{}, {{"map.x", {-0.0f, 1}}}});
    EXPECT_EQ(count(program, Op::Saturate), 1) << "saturate(-0) may be +0";
}

TEST(Assume, FixedUniformsAreGone) {
    Program program = parsed(marching);
    assumed(program, {{{"scale", {0.5f}}, {"rows", {1, 2, 3, 4, 5, 6, 7, 8}}}, {}});
    EXPECT_TRUE(program.pixel.uniforms.empty());
    EXPECT_EQ(count(program, Op::Uniform), 0);
    EXPECT_EQ(program.settings,
              (std::vector<std::string>{"rows = 1,2,3,4,5,6,7,8", "scale = 0.5"}));
    Program one = parsed(marching);
    assumed(one, {{{"scale", {0.5f}}}, {}});
    ASSERT_EQ(one.pixel.uniforms.size(), 1u);
    EXPECT_EQ(one.pixel.uniforms[0].name, "rows");
    EXPECT_TRUE(verify(one.pixel).ok());
}

TEST(Assume, NothingKnownChangesNothing) {
    Program program = parsed(marching);
    const Module before = program.pixel;
    EXPECT_TRUE(assumed(program, {}).empty());
    EXPECT_TRUE(program.pixel == before);
    EXPECT_TRUE(program.settings.empty());
}

TEST(Assume, ErrorsAreSentences) {
    const auto error = [](const Known& known) {
        Program program = parsed(marching);
        const auto notes = assume(program, known);
        return notes.ok() ? std::string("accepted")
                          : notes.error().code + ": " + notes.error().message;
    };
    EXPECT_EQ(error({{{"scalle", {1}}}, {}}),
              "unknown-uniform: unknown uniform 'scalle'; did you mean 'scale'?");
    EXPECT_EQ(error({{{"scale", {1, 2}}}, {}}),
              "uniform-components: the uniform scale has 1 component; 2 are given");
    EXPECT_EQ(error({{{"rows", {1}}}, {}}),
              "uniform-components: the uniform rows has 8 components, 2 rows of 4; 1 is given");
    EXPECT_EQ(error({{}, {{"viev.z", {0, 1}}}}),
              "unknown-value: unknown value 'viev'; did you mean 'view'?");
    EXPECT_EQ(
        error({{}, {{"view", {0, 1}}}}),
        "value-component: view has 3 components; a range is of one of them, view.x to view.z");
    EXPECT_EQ(
        error({{}, {{"view.w", {0, 1}}}}),
        "value-component: view has 3 components; a range is of one of them, view.x to view.z");
    EXPECT_EQ(error({{}, {{"scale.y", {0, 1}}}}),
              "value-component: scale is one number; its range is that of scale");
    EXPECT_EQ(error({{}, {{"view.z", {1, 0}}}}), "range-empty: nothing lies in view.z = 1..0");
    EXPECT_EQ(error({{}, {{"view.z", {2, 3}}}}),
              "range-impossible: view cannot be what is assumed of it, whatever the inputs are");
    EXPECT_EQ(error({{}, {{"scale", {0, 1}}}}), "accepted");
}

TEST(Assume, APassTakesWhatItHasNamesFor) {
    const Known known = {{{"scale", {1}}, {"ambient", {1}}},
                         {{"view.z", {0, 1}}, {"light.z", {0, 1}}}};
    const Known part = part_of(known, parsed(marching));
    EXPECT_EQ(part, (Known{{{"scale", {1}}}, {{"view.z", {0, 1}}}}));
}

}  // namespace
}  // namespace intaglio::passes

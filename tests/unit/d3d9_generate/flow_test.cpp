// Shaders with loops: every search and shadow as ps_3_0 keeps it, random modules with loops within
// and after each other, and how few slots they take.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "generator/ir/builder.h"
#include "generator/ir/evaluate.h"
#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/pipeline.h"
#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/generate/flow.h"
#include "generator/target/d3d9/generate/loop_rewrites.h"
#include "generator/target/d3d9/interpret.h"
#include "generator/target/d3d9/legality.h"
#include "generator/target/d3d9/ops.h"
#include "tests/rounds.h"
#include "tests/unit/d3d9_generate/comparison.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

using ::testing::HasSubstr;
using Knobs = std::vector<std::pair<std::string, std::string>>;

int count_ops(const Shader& shader, Opcode op) {
    int count = 0;
    for (const Instruction& instruction : shader.instructions) count += instruction.op == op;
    return count;
}

Shader shader_of(const Case& a_case) {
    const auto program = record(a_case, Profile::ps_3_0);
    EXPECT_TRUE(program) << (program ? "" : program.error().message);
    if (!program) return {};
    auto shader = generate_pixel(*program, Profile::ps_3_0);
    EXPECT_TRUE(shader) << a_case.name() << ": " << (shader ? "" : shader.error().message);
    return shader ? *shader : Shader{};
}

TEST(Flow, ComputesEverySurfaceWithLoops) {
    std::vector<Case> cases;
    for (const std::string steps : {"1", "2", "60", "255"})
        cases.push_back(
            {"search=steep_parallax,output=displaced", {{"min_steps", "1"}, {"max_steps", steps}}});
    for (const std::string steps : {"256", "257", "510", "512"})
        cases.push_back({"search=steep_parallax,output=displaced",
                         {{"min_steps", "40"}, {"max_steps", steps}}});
    for (const Knobs& knobs : {Knobs{{"nyquist", "1"}}, Knobs{{"level", "2"}}})
        cases.push_back({"search=steep_parallax,output=displaced", knobs});
    cases.push_back({"search=steep_parallax,shadow=march,output=displaced", {}});
    cases.push_back({"steep_parallax,shadow=march", {{"shadow_max_steps", "300"}}});
    cases.push_back({"search=none,shadow=march,output=displaced", {}});
    for (const std::string taps : {"1", "8", "200"})
        cases.push_back({"parallax_occlusion", {{"taps", taps}}});
    cases.push_back({"parallax_occlusion,shadow=fur_depth,output=displaced", {}});
    cases.push_back({"parallax_occlusion,shadow=march", {{"packed", "1"}}});
    cases.push_back({"fur", {}});
    for (const std::string search : {"cone", "contact_refinement", "relief", "parallax_iterative"})
        cases.push_back({"search=" + search + ",shadow=soft,output=displaced", {}});
    for (const Case& a_case : cases) {
        SCOPED_TRACE(a_case.name());
        const auto program = record(a_case, Profile::ps_3_0);
        ASSERT_TRUE(program) << program.error().message;
        const auto shader = generate_pixel(*program, Profile::ps_3_0);
        ASSERT_TRUE(shader) << shader.error().message;
        EXPECT_TRUE(check(*shader).empty()) << check(*shader)[0].message;
        constexpr int pixels = 200;
        EXPECT_LE(count_differences(*program, *shader, pixels), pixels / 100) << print(*shader);
    }
}

TEST(Flow, KeepsTheLoopsThatTheScheduleKeeps) {
    const Shader shader = shader_of({"search=steep_parallax,shadow=march,output=displaced", {}});
    EXPECT_EQ(count_ops(shader, Opcode::Rep), 2);
    EXPECT_EQ(count_ops(shader, Opcode::EndRep), 2);
    EXPECT_GE(count_ops(shader, Opcode::BreakComp), 2);
    // One in each loop: the search's first read is rotated into it; the shadow starts at its
    // height.
    EXPECT_EQ(count_ops(shader, Opcode::Texldl), 2);
}

TEST(Flow, StaysSmall) {
    const auto slots = [](const Case& a_case) { return slots_of(shader_of(a_case)).total(); };
    // 34 for the steep march is what was asked for, 29 what was reached.
    EXPECT_LE(slots({"search=steep_parallax,output=displaced", {}}), 29);
    EXPECT_LE(slots({"search=steep_parallax,shadow=march,output=displaced", {}}), 68);
    EXPECT_LE(slots({"steep_parallax,shadow=march", {}}), 98);
}

// --- what the schedule says, and what it leaves open

// A sum of reads, `trips` of them, in a loop of this form.
ir::Program summing(int trips, ir::LoopForm form) {
    ir::Program program;
    ir::Module& module = program.pixel;
    program.name = module.name = "summing";
    module.inputs.push_back({"at", ir::float2, ir::Semantic::Interpolant});
    module.outputs.push_back({"colour", ir::float4, ir::Semantic::Target});
    module.samplers.push_back({"map", 2, ""});
    ir::Builder builder(module);
    const ir::ValueId at = builder.input(0), zero = builder.constant(0.0f);
    ir::LoopInfo info;
    info.name = "sum";
    info.trip_count = trips;
    info.form = form;
    const std::array initial = {builder.swizzle(zero, "xxxx")};
    const auto scope = builder.begin_loop(info, initial);
    const ir::ValueId step = builder.emit(ir::Op::ToFloat, {scope.index});
    const ir::ValueId place = builder.emit(ir::Op::Add, {at, builder.swizzle(step, "xx")});
    const ir::ValueId read = builder.sample(ir::Op::SampleLevel, 0, {place, zero});
    const std::array next = {builder.emit(ir::Op::Add, {scope.carried[0], read})};
    builder.finish(builder.end_loop(next));
    add_vertex(program);
    return program;
}

TEST(LoopPlans, DemandsAreObeyedAndTheRestIsChosenByCost) {
    const auto reps = [](int trips, ir::LoopForm form) {
        const ir::Program program = summing(trips, form);
        const auto shader = generate_pixel(program, Profile::ps_3_0);
        EXPECT_TRUE(shader) << (shader ? "" : shader.error().message);
        if (!shader) return -1;
        EXPECT_EQ(count_differences(program, *shader, 50), 0) << print(*shader);
        return count_ops(*shader, Opcode::Rep);
    };
    EXPECT_EQ(reps(2, ir::LoopForm::Rolled), 1);
    EXPECT_EQ(reps(20, ir::LoopForm::Unrolled), 0);
    EXPECT_EQ(reps(2, ir::LoopForm::Unspecified), 0);
    EXPECT_EQ(reps(20, ir::LoopForm::Unspecified), 1);
    EXPECT_EQ(reps(700, ir::LoopForm::Rolled), 2);  // a rep counts to 255
}

// Five loops, each around the next.
TEST(LoopPlans, RefusesLoopsNestedTooDeep) {
    ir::Program program = summing(3, ir::LoopForm::Rolled);
    ir::Module nested;
    nested.inputs = program.pixel.inputs;
    nested.outputs = {{"colour", ir::float1, ir::Semantic::Target}};
    ir::Builder builder(nested);
    ir::ValueId sum = builder.swizzle(builder.input(0), "x");
    std::vector<ir::Builder::LoopScope> scopes;
    for (int depth = 0; depth < 5; ++depth) {
        ir::LoopInfo info;
        info.name = "loop" + std::to_string(depth);
        info.trip_count = 3;
        info.form = ir::LoopForm::Rolled;
        scopes.push_back(builder.begin_loop(info, std::array{sum}));
        sum = builder.emit(ir::Op::Mul, {scopes.back().carried[0], scopes.back().carried[0]});
    }
    for (int depth = 0; depth < 5; ++depth) sum = builder.end_loop(std::array{sum})[0];
    builder.finish(std::array{sum});
    program.pixel = nested;
    const auto shader = generate_pixel(program, Profile::ps_3_0);
    ASSERT_FALSE(shader);
    EXPECT_EQ(shader.error().code, "d3d9-loop");
    EXPECT_THAT(shader.error().message, HasSubstr("nested 5 deep; ps_3_0 nests 4"));
}

// --- rewrites of loops

int trips_of(const ir::Module& module) {
    for (const ir::Instruction& instruction : module.body.body)
        if (instruction.op == ir::Op::Loop) return instruction.loop.trip_count;
    return 0;
}

TEST(LoopRewrites, ChangeNoBitOfFiniteSurfaces) {
    int rotated = 0;
    for (const std::string surface :
         {"search=steep_parallax,output=displaced", "steep_parallax,shadow=march",
          "search=none,shadow=march", "parallax_occlusion", "fur"}) {
        SCOPED_TRACE(surface);
        auto program = record({surface, {}}, Profile::ps_3_0);
        ASSERT_TRUE(program) << program.error().message;
        passes::PipelineOptions options;
        options.flatten_all = true;
        ASSERT_TRUE(passes::optimize_program(*program, options));
        ir::Module rewritten = program->pixel;
        form_saturations(rewritten);
        rotate_loops(rewritten);
        const Status status = ir::verify(rewritten);
        ASSERT_TRUE(status) << status.error().message;
        rotated += trips_of(rewritten) == trips_of(program->pixel) + 1;
        EXPECT_EQ(count_unequal(program->pixel, rewritten, 300), 0) << ir::print(rewritten);
    }
    EXPECT_GE(rotated, 2);
}

// What is carried starts as %first; in each iteration it becomes the number of the next.
ir::Module counting(const std::string& first) {
    const auto module = ir::parse(
        "pixel \"counting\"\ninput a float1 interpolant\n"
        "output colour float1 target\n{\n"
        "    %a float1 = input a\n    %first float1 = const " +
            first +
            R"(
    %one int1 = const 1
    %last float1 = loop "count" 5 rolled (%first) {
    (%i int1, %at float1):
        %exit bool1 = greater_equal %at, %a
        break_if %exit (%at)
        %next int1 = add %i, %one
        %number float1 = to_float %next
        yield (%number)
    }
    return (%last)
})",
        "counting.ir");
    EXPECT_TRUE(module) << (module ? "" : to_string(module.error()));
    return *module;
}

TEST(LoopRewrites, RotateWhereTheFirstValueFits) {
    ir::Module fits = counting("0.0"), differs = counting("1.0");
    rotate_loops(fits);
    rotate_loops(differs);
    EXPECT_EQ(trips_of(fits), 6);
    EXPECT_EQ(trips_of(differs), 5);
    EXPECT_EQ(count_unequal(counting("0.0"), fits, 100), 0);
}

// --- random modules, of numbers that every arithmetic has exactly

class RandomLoops {
  public:
    explicit RandomLoops(unsigned seed) : random_(seed), builder_(module_) {
        module_.name = "random";
        module_.inputs.push_back({"a", ir::float4, ir::Semantic::Interpolant});
        module_.inputs.push_back({"b", ir::float2, ir::Semantic::Interpolant});
        module_.uniforms.push_back({"u", ir::float3, 1, ""});
        module_.outputs.push_back({"colour", ir::float4, ir::Semantic::Target});
    }

    ir::Module make() {
        for (const char* lane : {"x", "y", "z", "w"})
            floats_.push_back(builder_.swizzle(builder_.input(0), lane));
        for (const char* lane : {"x", "y"})
            floats_.push_back(builder_.swizzle(builder_.input(1), lane));
        floats_.push_back(builder_.swizzle(builder_.uniform(0), "z"));
        fill(0, 4);
        std::vector<ir::ValueId> lanes;
        for (int k = 0; k < 4; ++k) lanes.push_back(pick());
        const std::array outputs = {builder_.compose(lanes)};
        builder_.finish(outputs);
        return std::move(module_);
    }

  private:
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
    ir::ValueId pick() {
        if (below(6) == 0) return builder_.constant(static_cast<float>(below(9) - 4));
        // Rather what was computed last: little is dead then.
        const int count = static_cast<int>(floats_.size());
        const int back = below(2) == 0 ? below(std::min(count, 3)) : below(count);
        return floats_[static_cast<std::size_t>(count - 1 - back)];
    }
    // Whole numbers, small enough to stay exact.
    ir::ValueId clamped(ir::ValueId value) {
        const ir::ValueId low = builder_.emit(ir::Op::Max, {value, builder_.constant(-64.0f)});
        return builder_.emit(ir::Op::Min, {low, builder_.constant(64.0f)});
    }
    ir::ValueId condition() {
        const ir::Op op =
            std::array{
                ir::Op::GreaterEqual, ir::Op::Greater, ir::Op::Less,
                ir::Op::LessEqual,    ir::Op::Equal,   ir::Op::NotEqual}[static_cast<std::size_t>(
                below(6))];
        const ir::ValueId first = builder_.emit(op, {pick(), pick()});
        switch (below(5)) {
            case 0: return builder_.emit(ir::Op::Or, {first, condition()});
            case 1: return builder_.emit(ir::Op::And, {first, condition()});
            case 2: return builder_.emit(ir::Op::Not, {first});
            default: return first;
        }
    }
    void arithmetic() {
        switch (below(7)) {
            case 0: floats_.push_back(clamped(builder_.emit(ir::Op::Mul, {pick(), pick()}))); break;
            case 1: floats_.push_back(builder_.emit(ir::Op::Min, {pick(), pick()})); break;
            case 2:
                floats_.push_back(builder_.emit(ir::Op::Select, {condition(), pick(), pick()}));
                break;
            case 3: floats_.push_back(builder_.emit(ir::Op::Abs, {pick()})); break;
            case 4: floats_.push_back(builder_.emit(ir::Op::Neg, {pick()})); break;
            case 5: floats_.push_back(clamped(builder_.emit(ir::Op::Sub, {pick(), pick()}))); break;
            default: floats_.push_back(clamped(builder_.emit(ir::Op::Add, {pick(), pick()})));
        }
    }
    void fill(int depth, int count) {
        for (int i = 0; i < count; ++i) {
            arithmetic();
            if (below(2) == 0 && depth < 3 && loops_ < 6) loop(depth + 1);
        }
    }
    void loop(int depth) {
        ++loops_;
        ir::LoopInfo info;
        info.name = "loop" + std::to_string(loops_);
        info.trip_count = depth == 1 && below(6) == 0 ? 250 + below(300) : 1 + below(6);
        info.form = ir::LoopForm::Rolled;
        std::vector<ir::ValueId> initial;
        const int carried = 1 + below(3);
        for (int k = 0; k < carried; ++k) initial.push_back(pick());
        const bool truth = below(3) == 0;
        if (truth) initial.push_back(condition());
        const auto scope = builder_.begin_loop(info, initial);
        const std::size_t outside = floats_.size();
        const auto enter = [&](const std::vector<ir::ValueId>& values) {
            for (std::size_t k = 0; k < values.size(); ++k)
                floats_.push_back(truth && k + 1 == values.size()
                                      ? builder_.emit(ir::Op::Select, {values[k], pick(), pick()})
                                      : values[k]);
        };
        enter(scope.carried);
        if (below(2) == 0) floats_.push_back(builder_.emit(ir::Op::ToFloat, {scope.index}));
        const auto some = [&] {
            std::vector<ir::ValueId> values;
            for (int k = 0; k < carried; ++k)
                values.push_back(below(2) == 0 ? scope.carried[static_cast<std::size_t>(k)]
                                               : clamped(pick()));
            if (truth) values.push_back(condition());
            return values;
        };
        const int parts = below(3);
        for (int part = 0; part < parts; ++part) {
            fill(depth, 1 + below(2));
            const ir::ValueId exit = condition();
            builder_.break_if(exit, some());
        }
        fill(depth, 1);
        const auto results = builder_.end_loop(some());
        floats_.resize(outside);
        enter(results);
    }

    std::mt19937 random_;
    ir::Module module_;
    ir::Builder builder_;
    std::vector<ir::ValueId> floats_;
    int loops_ = 0;
};

// The numbers are whole, so results agree to the bit.
TEST(Flow, ComputesRandomModules) {
    int loops = 0, compared = 0;
    for (unsigned seed = 1; seed <= rounds(50u); ++seed) {
        SCOPED_TRACE(seed);
        ir::Program program;
        program.pixel = RandomLoops(seed).make();
        const ir::Module recorded = program.pixel;
        passes::PipelineOptions options;
        options.flatten_all = true;
        options.verify_each = true;
        ASSERT_TRUE(passes::optimize(program.pixel, options));
        std::vector<std::string> notes;
        const auto candidate = generate_flow(program.pixel, Profile::ps_3_0, notes);
        if (!candidate && candidate.error().code == "d3d9-loop") continue;
        ASSERT_TRUE(candidate) << candidate.error().message;
        ASSERT_TRUE(candidate->fits())
            << (candidate->violations.empty() ? "registers" : candidate->violations[0].message);
        const Shader& shader = candidate->shader;
        loops += count_ops(shader, Opcode::Rep);
        const auto decoded = decode(encode(shader));
        ASSERT_TRUE(decoded);
        const auto interpreter = Interpreter::prepare(*decoded);
        ASSERT_TRUE(interpreter);
        const ir::Evaluator evaluator(recorded);
        std::mt19937 random(seed);
        const auto number = [&] { return static_cast<float>(static_cast<int>(random() % 9) - 4); };
        for (int i = 0; i < 20; ++i) {
            ir::Environment environment;
            Inputs inputs;
            for (std::size_t k = 0; k < 2; ++k) {
                ir::Environment::Vector value{};
                for (double& lane : value) lane = static_cast<double>(number());
                environment.inputs.push_back(value);
                // The shader knows those that it still reads.
                for (std::size_t at = 0; at < program.pixel.inputs.size(); ++at)
                    for (std::size_t lane = 0; lane < 4; ++lane)
                        if (program.pixel.inputs[at].name == recorded.inputs[k].name)
                            inputs.attributes[at][lane] = static_cast<float>(value[lane]);
            }
            environment.uniforms = {{{1, -2, 3, 0}}};
            const auto constants = environment_of(shader, {{"u", {1, -2, 3}}}, {});
            ASSERT_TRUE(constants);
            const auto expected = evaluator.run(environment, ir::Precision::Single);
            const Execution got = interpreter->run(*constants, inputs, Arithmetic::Fp32);
            ASSERT_TRUE(got.complete);
            for (std::size_t lane = 0; lane < 4; ++lane)
                ASSERT_EQ(static_cast<double>(got.colours[0][lane]), expected.outputs[0][lane])
                    << "component " << lane << ", draw " << i << "\n"
                    << print(shader) << ir::print(recorded) << ir::print(program.pixel);
            ++compared;
        }
    }
    EXPECT_GE(loops, rounds(60));
    EXPECT_GE(compared, rounds(900));
}

}  // namespace
}  // namespace intaglio::d3d9

// Searches that are only asked whether they hit: recognised in every shape that is one and in none
// that is not, with the loop's truth on maps of numbers.
#include "generator/passes/any_hit.h"

#include <gtest/gtest.h>

#include "generator/ir/builder.h"
#include "tests/rounds.h"
#include "tests/unit/passes/first_hit.h"

namespace intaglio::passes {
namespace {

using namespace testing;
using namespace ir;

TEST(LowerFirstHit, AShadowRayIsOnlyAskedWhetherItHits) {
    for (int steps : {1, 5, 8, 20})
        for (int least : {1, steps}) {
            const Module loop = technique("steep_parallax,shadow=march,output=displaced",
                                          {{"min_steps", "3"},
                                           {"max_steps", "3"},
                                           {"shadow_min_steps", std::to_string(least)},
                                           {"shadow_max_steps", std::to_string(steps)}});
            Module any = loop, packed = loop;
            const std::vector<FirstHit> hits = flatten(any, FirstHitForm::AnyHit);
            ASSERT_EQ(hits.size(), 2u);
            EXPECT_FALSE(hits[0].only_whether) << "where it hits matters";
            EXPECT_EQ(hits[0].form, FirstHitForm::PackedRefetch);
            EXPECT_TRUE(hits[1].only_whether);
            EXPECT_EQ(hits[1].form, FirstHitForm::AnyHit);
            flatten(packed, FirstHitForm::PackedRefetch);
            expect_same(loop, any, 400, 100, Maps::Sane);
            if (HasFatalFailure()) return;
            EXPECT_EQ(cost_of(any).reads, cost_of(packed).reads);
            if (steps > 1) {
                EXPECT_LT(cost_of(any).lanes, cost_of(packed).lanes);
            }
        }
}

// How the comparison after the loop is not the loop's.
enum class Differs { Nowhere, Start, Op, Operands, Strictness, InsideBranch, Escapes, Count };

// What else ends the loop: nothing, a ray that rises above the top and stays there, or one that
// need not stay: its step may be negative or beyond a lerp's ends, it sinks, it starts high, or the
// top moves.
enum class Stop { None, Stays, AnyStep, AnyLerp, Sinks, StartsHigh, Moves, Count };

// A ray of which one asks whether it hits: the comparison of hit and truth, with or without a stop.
struct Shadow {
    bool strict = false, of_hit = false, swapped = false, flipped = false;
    Stop stop = Stop::None;
    Differs differs = Differs::Nowhere;
};

Module shadow(const Shadow& shape) {
    Module module;
    module.stage = Stage::Function;
    module.inputs = {{"uv", float2, Semantic::Parameter},
                     {"slope", float2, Semantic::Parameter},
                     {"start", float1, Semantic::Parameter},
                     {"first", float1, Semantic::Parameter}};
    module.outputs = {{"seen", float1, Semantic::Result}};
    module.uniforms = {{"step", float1, 1, ""}};
    module.samplers = {{"height", 2, ""}};
    Builder builder(module);
    const ValueId uv = builder.input(0), slope = builder.input(1), start = builder.input(2);
    const ValueId zero = builder.constant(0.0f), one = builder.constant(1.0f);
    const ValueId any_step = builder.uniform(0);
    ValueId step = any_step;
    if (shape.stop == Stop::AnyLerp)
        step = builder.emit(Op::Lerp, {builder.constant(0.1f), builder.constant(0.2f),
                                       builder.emit(Op::Mul, {any_step, builder.constant(9.0f)})});
    else if (shape.stop != Stop::AnyStep)
        step = builder.emit(Op::Abs, {any_step});
    const bool sinks = shape.stop == Stop::Sinks;
    ValueId rise_first = builder.emit(Op::Mul, {sinks ? builder.constant(6.0f) : zero, step});
    if (shape.stop == Stop::StartsHigh) rise_first = one;
    const auto compare = [&](bool hit, bool strict, ValueId height, ValueId ray) {
        if (hit != shape.flipped) std::swap(height, ray);  // hit: ray < height, unless flipped
        if (shape.swapped)
            return builder.emit(strict ? Op::Greater : Op::GreaterEqual, {ray, height});
        return builder.emit(strict ? Op::Less : Op::LessEqual, {height, ray});
    };
    const Builder::LoopScope loop = builder.begin_loop({"ray", 6, LoopForm::Unspecified, false},
                                                       std::array{rise_first, builder.input(3)});
    const ValueId ray = builder.emit(Op::Add, {start, loop.carried[0]});
    ValueId condition = compare(true, shape.strict, loop.carried[1], ray);
    if (shape.stop != Stop::None) {
        const ValueId top =
            shape.stop == Stop::Moves ? builder.emit(Op::Add, {loop.carried[1], start}) : one;
        condition = builder.emit(Op::Or, {condition, builder.emit(Op::Greater, {ray, top})});
    }
    builder.break_if(condition, loop.carried);
    const ValueId next_index = sinks ? builder.emit(Op::Sub, {builder.constant(5), loop.index})
                                     : builder.emit(Op::Add, {loop.index, builder.constant(1)});
    const ValueId rise = builder.emit(Op::Mul, {builder.emit(Op::ToFloat, {next_index}), step});
    const ValueId offset = builder.emit(Op::Mul, {slope, builder.swizzle(rise, "xx")});
    const ValueId texel =
        builder.sample(Op::SampleLevel, 0, {builder.emit(Op::Add, {uv, offset}), zero});
    const std::vector<ValueId> found =
        builder.end_loop(std::array{rise, builder.swizzle(texel, "x")});
    const bool operands = shape.differs == Differs::Operands;
    const ValueId last =
        builder.emit(shape.differs == Differs::Op ? Op::Sub : Op::Add,
                     {shape.differs == Differs::Start ? one : start, found[operands ? 1 : 0]});
    const bool strict = (shape.strict == shape.of_hit) != (shape.differs == Differs::Strictness);
    ValueId seen{};
    if (shape.differs == Differs::InsideBranch) {
        builder.begin_if(builder.emit(Op::Greater, {start, step}));
        const ValueId inside = builder.emit(Op::Mul, {found[1], step});
        builder.begin_else({&inside, 1});
        seen = builder.end_if({&zero, 1}).front();
    }
    const ValueId truth = compare(shape.of_hit, strict, found[operands ? 0 : 1], last);
    const ValueId chosen = builder.emit(Op::Select, {truth, one, zero});
    seen = shape.differs == Differs::InsideBranch ? builder.emit(Op::Add, {seen, chosen}) : chosen;
    if (shape.differs == Differs::Escapes) seen = builder.emit(Op::Add, {seen, found[1]});
    builder.finish({&seen, 1});
    return module;
}

TEST(LowerFirstHit, EveryShapeOfAShadowRay) {
    int both = 0;
    constexpr auto stops = static_cast<unsigned>(Stop::Count);
    constexpr unsigned count = 16 * stops * static_cast<unsigned>(Differs::Count);
    for (unsigned bits = 0; bits < count; bits += stride) {
        const auto bit = [&](unsigned i) { return (bits >> i & 1u) != 0; };
        const Shadow shape = {bit(0),
                              bit(1),
                              bit(2),
                              bit(3),
                              static_cast<Stop>(bits / 16 % stops),
                              static_cast<Differs>(bits / 16 / stops)};
        SCOPED_TRACE(fmt::format("shape {}", bits));
        Module loop = shadow(shape);
        ASSERT_TRUE(optimize(loop, {.verify_each = true}).ok());
        Module any = loop;
        const std::vector<FirstHit> hits = flatten(any, FirstHitForm::AnyHit);
        ASSERT_EQ(hits.size(), 1u);
        const bool possible = shape.differs == Differs::Nowhere &&
                              (shape.stop == Stop::None || shape.stop == Stop::Stays);
        EXPECT_EQ(hits[0].form, possible ? FirstHitForm::AnyHit : FirstHitForm::PackedRefetch)
            << print(loop);
        Random random(bits);
        const Evaluator original(loop), lowered(any);
        bool seen[2] = {};
        for (int i = 0; i < 100; ++i) {
            Texture texture = height_field(random, false);
            Environment environment = view(random, loop, texture);
            for (std::size_t input : {2, 3})
                environment.inputs[input][0] = static_cast<double>(random.unit());
            environment.uniforms[0][0][0] = static_cast<double>(random.unit() * 0.6f - 0.3f);
            if (i % 2 == 0) {  // few different numbers: the ray often meets the relief exactly
                texture.filter = Texture::Filter::Nearest;
                for (float& texel : texture.levels[0]) texel = std::round(texel * 8.0f) / 8.0f;
                for (auto* number : {&environment.inputs[2][0], &environment.inputs[3][0],
                                     &environment.uniforms[0][0][0]})
                    *number = std::round(*number * 8.0) / 8.0;
            }
            environment.right_inputs = environment.lower_inputs = environment.inputs;
            const Evaluation a = original.run(environment, Precision::Single);
            const Evaluation b = lowered.run(adapt(environment, loop, any), Precision::Single);
            ASSERT_EQ(difference(a, b, Precision::Single), "") << print(loop) << print(any);
            seen[a.outputs[0][0] >= 0.5 ? 1 : 0] = true;
        }
        both += seen[0] && seen[1] ? 1 : 0;
    }
    EXPECT_GT(both, 500 / stride) << "hardly any shape is seen both ways: this shows little";
}

// The second search compares with what the first one found.
TEST(LowerFirstHit, OneRayAfterAnother) {
    Module module;
    module.stage = Stage::Function;
    module.inputs = {{"uv", float2, Semantic::Parameter}};
    module.outputs = {{"seen", float1, Semantic::Result}};
    module.samplers = {{"height", 2, ""}};
    Builder builder(module);
    const ValueId uv = builder.input(0), zero = builder.constant(0.0f);
    ValueId limit = zero;
    for (int ray = 0; ray < 2; ++ray) {
        const Builder::LoopScope loop = builder.begin_loop({"ray", 5, LoopForm::Unspecified, false},
                                                           std::array{builder.constant(-1.0f)});
        builder.break_if(builder.emit(Op::Greater, {loop.carried[0], limit}), loop.carried);
        const ValueId size = builder.constant(ray == 0 ? 0.1f : 0.3f);
        const ValueId t = builder.emit(Op::Mul, {builder.emit(Op::ToFloat, {loop.index}), size});
        const ValueId at = builder.emit(Op::Mul, {uv, builder.swizzle(t, "xx")});
        const ValueId height = builder.swizzle(builder.sample(Op::SampleLevel, 0, {at, zero}), "y");
        const ValueId found = builder.end_loop(
            std::array{builder.emit(Op::Sub, {height, builder.constant(0.3f)})})[0];
        limit = ray == 0 ? found
                         : builder.emit(Op::Select, {builder.emit(Op::Greater, {found, limit}),
                                                     builder.constant(1.0f), zero});
    }
    builder.finish({&limit, 1});
    Module loop = module;
    ASSERT_TRUE(optimize(loop, {.verify_each = true}).ok());
    Module any = loop;
    const std::vector<FirstHit> hits = flatten(any, FirstHitForm::AnyHit);
    ASSERT_EQ(hits.size(), 2u);
    EXPECT_EQ(hits[0].form, FirstHitForm::PackedRefetch);
    EXPECT_EQ(hits[1].form, FirstHitForm::AnyHit);
    expect_same(loop, any, 500, 100, Maps::Sane);
}

// With texels in [0, 1], a shadow ray that has left through the top needs no test for it.
TEST(AnyHit, FreeRoundingDropsTheStopAtTheTop) {
    const Module loop =
        technique("steep_parallax,shadow=march,output=displaced", {{"min_steps", "4"},
                                                                   {"max_steps", "4"},
                                                                   {"shadow_min_steps", "8"},
                                                                   {"shadow_max_steps", "8"}});
    const auto choose = [](const FirstHit& hit) {
        return hit.only_whether ? FirstHitForm::AnyHit : FirstHitForm::Chain;
    };
    const auto lowered = [&](Rounding rounding) {
        Module module = loop;
        EXPECT_EQ(lower_first_hit(module, choose, rounding).size(), 2u);
        EXPECT_TRUE(
            optimize(module, {.unroll_all = true, .flatten_all = true, .verify_each = true}).ok());
        return module;
    };
    const Module exact = lowered(Rounding::Exact), free = lowered(Rounding::Free);
    expect_same(loop, exact, 400, 60, Maps::Sane);
    expect_same(loop, free, 400, 60, Maps::Sane);
    EXPECT_EQ(cost_of(free).selects, cost_of(exact).selects - 8) << "one for each step";
}

}  // namespace
}  // namespace intaglio::passes

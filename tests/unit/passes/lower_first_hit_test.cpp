// First-hit searches, as loops, as chains of selects and by the greatest key, compute the same: the
// techniques over views and maps, and random searches with values on which arithmetic goes wrong.
#include "generator/passes/lower_first_hit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "generator/ir/builder.h"
#include "tests/rounds.h"
#include "tests/unit/passes/first_hit.h"

namespace intaglio::passes {
namespace {

using namespace testing;
using namespace ir;

void expect_lowered(const std::vector<FirstHit>& hits, std::size_t count) {
    EXPECT_EQ(hits.size(), count);
    for (const FirstHit& hit : hits)
        EXPECT_EQ(hit.form, FirstHitForm::PackedRefetch) << hit.loop << ": " << hit.refusal;
}

TEST(LowerFirstHit, ParallaxOcclusionWithAnyTaps) {
    for (int taps = 2; taps <= 64; taps += stride) {
        SCOPED_TRACE(fmt::format("{} taps", taps));
        const Module loop =
            technique("parallax_occlusion,output=displaced", {{"taps", std::to_string(taps)}});
        Module packed = loop, chain = loop;
        expect_lowered(flatten(packed, FirstHitForm::PackedRefetch), 1);
        flatten(chain, FirstHitForm::Chain);
        expect_same(loop, packed, static_cast<std::uint64_t>(taps), 40);
        if (HasFatalFailure()) return;
        EXPECT_EQ(cost_of(chain).reads, taps);
        EXPECT_EQ(cost_of(packed).reads, taps + 1)
            << "the floor is read at the hit alone; two reads there";
        EXPECT_EQ(cost_of(chain).selects, 3 * (taps - 1)) << "each carried value in each iteration";
        EXPECT_EQ(cost_of(packed).selects, taps) << "the keys, and `above` of a first hit";
    }
}

TEST(LowerFirstHit, SteepParallaxWithFixedAndGrowingSteps) {
    for (const auto& [least, most] :
         {std::pair{1, 1}, {8, 8}, {16, 16}, {24, 24}, {13, 13}, {5, 16}, {10, 60}}) {
        SCOPED_TRACE(fmt::format("{} to {} steps", least, most));
        const Module loop =
            technique("steep_parallax,output=displaced",
                      {{"min_steps", std::to_string(least)}, {"max_steps", std::to_string(most)}});
        Module packed = loop;
        expect_lowered(flatten(packed, FirstHitForm::PackedRefetch), 1);
        expect_same(loop, packed, 100 + static_cast<std::uint64_t>(most), 40);
        if (HasFatalFailure()) return;
    }
}

TEST(LowerFirstHit, ShadowMarchBehindAnySearch) {
    for (const char* steps : {"1", "5", "8", "20"})
        for (const char* least : {"1", steps}) {
            const Module loop = technique("steep_parallax,shadow=march,output=displaced",
                                          {{"min_steps", "4"},
                                           {"max_steps", "4"},
                                           {"shadow_min_steps", least},
                                           {"shadow_max_steps", steps}});
            Module packed = loop;
            expect_lowered(flatten(packed, FirstHitForm::PackedRefetch), 2);
            expect_same(loop, packed, 200, 60);
            if (HasFatalFailure()) return;
        }
}

TEST(LowerFirstHit, TheShadedSurface) {
    const Module loop = technique("parallax_occlusion,shadow=march", {{"taps", "9"}});
    Module packed = loop;
    expect_lowered(flatten(packed, FirstHitForm::PackedRefetch), 2);
    expect_same(loop, packed, 300, 100);
}

// Steps that are no power of two, which end beside the floor: where rounding is free, the result is
// as near as a place that is 2^-22 off allows, but for the few pixels whose secant is ill
// conditioned, and it costs less.
TEST(LowerFirstHit, FreeRoundingIsNearAndCheaper) {
    int lanes = 0, lanes_exact = 0, far = 0, pixels = 0;
    for (const char* taps : {"3", "5", "6", "7", "12", "24"}) {
        const Module loop = technique("parallax_occlusion,output=displaced", {{"taps", taps}});
        Module exact = loop, free = loop;
        flatten(exact, FirstHitForm::PackedRefetch);
        const auto packed = [](const FirstHit&) { return FirstHitForm::PackedRefetch; };
        expect_lowered(lower_first_hit(free, packed, Rounding::Free), 1);
        ASSERT_TRUE(
            optimize(free, {.unroll_all = true, .flatten_all = true, .verify_each = true}).ok());
        lanes += cost_of(free).lanes;
        lanes_exact += cost_of(exact).lanes;
        Random random(20);
        const Evaluator original(loop), lowered(free);
        for (int map = 0; map < 10; ++map) {
            const Texture texture = height_field(random, false);
            for (int i = 0; i < 100; ++i, ++pixels) {
                Environment environment = view(random, loop, texture);
                for (std::size_t k = 0; k < loop.inputs.size(); ++k)
                    if (loop.inputs[k].type == float3) environment.inputs[k][2] = 1;
                const Evaluation a = original.run(environment, Precision::Single);
                const Evaluation b = lowered.run(adapt(environment, loop, free), Precision::Single);
                bool is_far = false;
                for (std::size_t k = 0; k < 4; ++k)
                    is_far = is_far || !(std::fabs(a.outputs[0][k] - b.outputs[0][k]) < 1e-4);
                far += is_far;
            }
        }
    }
    EXPECT_LE(far, pixels / 200) << "of " << pixels;
    EXPECT_LT(lanes, lanes_exact);
}

// A search as someone may write it: what is compared and how, what it carries and leaves with, and
// from where.
class RandomSearch {
  public:
    explicit RandomSearch(std::uint64_t seed) : random_(seed) {}

    Module make() {
        module_.stage = Stage::Function;
        module_.inputs = {{"uv", float2, Semantic::Parameter},
                          {"slope", float2, Semantic::Parameter},
                          {"limit", float1, Semantic::Parameter},
                          {"step", float1, Semantic::Parameter}};
        module_.samplers = {{"height", 2, ""}, {"other", 2, ""}};
        Builder builder(module_);
        builder_ = &builder;
        uv_ = builder.input(0);
        slope_ = builder.input(1);
        limit_ = builder.input(2);
        zero_ = builder.constant(0.0f);
        trips_ = random_.between(1, 13);
        first_ = random_.between(0, 2);
        const int parts = trips_ + (random_.chance(50) ? 0 : first_ + random_.between(0, 3));
        step_ = random_.chance(70) ? builder.constant(1.0f / static_cast<float>(parts))
                                   : builder.input(3);
        const bool memoryless_start = random_.chance(60);
        std::vector<ValueId> initial;
        const ValueId before = builder.constant(static_cast<float>(first_));
        initial.push_back(memoryless_start ? builder.emit(Op::Mul, {before, step_}) : limit_);
        initial.push_back(memoryless_start ? first_sample(initial[0]) : limit_);
        initial.push_back(random_.chance(50) ? initial[1] : builder.constant(-0.5f));
        const Builder::LoopScope loop =
            builder.begin_loop({"search", trips_, LoopForm::Unspecified, false}, initial);
        const ValueId t = loop.carried[0], height = loop.carried[1];
        const bool here = random_.chance(30);  // samples before it leaves, not after
        const ValueId sampled_here = here ? sample(t) : height;
        const ValueId hit = condition(t, sampled_here);
        const auto leave = [&](ValueId carried, ValueId other) {
            return random_.chance(80) ? carried : other;
        };
        builder.break_if(hit, std::array{leave(t, step_), leave(height, sampled_here),
                                         leave(loop.carried[2], height)});
        const ValueId next_index =
            builder.emit(Op::Add, {loop.index, builder.constant(first_ + 1)});
        ValueId next = builder.emit(Op::Mul, {builder.emit(Op::ToFloat, {next_index}), step_});
        if (random_.chance(30)) next = builder.emit(Op::Min, {next, builder.constant(1.0f)});
        remembers_ = random_.chance(10);
        const ValueId above =
            remembers_ ? builder.emit(Op::Add, {loop.carried[2], height}) : height;
        const std::vector<ValueId> found =
            builder.end_loop(std::array{next, here ? sampled_here : sample(next), above});
        for (ValueId value : found)
            module_.outputs.push_back(
                {fmt::format("r{}", index_of(value)), float1, Semantic::Result});
        builder.finish(found);
        return std::move(module_);
    }

    // True if a carried value depends on its own past.
    bool remembers() const { return remembers_; }

  private:
    // What the loop samples, or nearly so.
    ValueId first_sample(ValueId t) {
        return sample(t, random_.chance(10) ? 1 : 0, random_.chance(10) ? "x" : "w");
    }

    ValueId sample(ValueId t, int sampler = 0, std::string_view lane = "w") {
        const ValueId offset = builder_->emit(Op::Mul, {slope_, builder_->swizzle(t, "xx")});
        const ValueId texel = builder_->sample(Op::SampleLevel, sampler,
                                               {builder_->emit(Op::Sub, {uv_, offset}), zero_});
        return builder_->swizzle(texel, lane);
    }

    ValueId condition(ValueId t, ValueId height) {
        const ValueId ray = builder_->emit(Op::Sub, {builder_->constant(1.0f), t});
        const ValueId compared = compare(height, ray);
        switch (random_.below(8)) {
            case 0: return builder_->emit(Op::Or, {compared, compare(t, limit_)});
            case 1: return builder_->emit(Op::And, {compared, compare(t, limit_)});
            case 2: return builder_->emit(Op::Not, {compared});
            default: return compared;
        }
    }

    ValueId compare(ValueId a, ValueId b) {
        constexpr Op ops[] = {Op::GreaterEqual, Op::Greater, Op::Less, Op::LessEqual, Op::Equal};
        if (random_.chance(50)) {
            a = builder_->emit(Op::Sub, {a, b});
            b = zero_;
        }
        if (random_.chance(20)) std::swap(a, b);
        return builder_->emit(ops[random_.chance(60) ? 0 : random_.below(5)], {a, b});
    }

    Random random_;
    Module module_;
    Builder* builder_ = nullptr;
    ValueId uv_{}, slope_{}, limit_{}, zero_{}, step_{};
    int trips_ = 0, first_ = 0;
    bool remembers_ = false;
};

TEST(LowerFirstHit, RandomSearches) {
    const Textures textures(3);
    int lowered_count = 0, refused_count = 0;
    for (std::uint64_t seed = 1; seed <= rounds(1000u); ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        RandomSearch search(seed);
        const Module written = search.make();
        Module loop = written;
        ASSERT_TRUE(optimize(loop, {.verify_each = true}).ok());
        Module lowered = loop;
        const std::vector<FirstHit> hits = lower_first_hit(lowered, FirstHitForm::PackedRefetch);
        const Status status = verify(lowered);
        ASSERT_TRUE(status.ok()) << to_string(status.error()) << print(lowered);
        if (hits.empty()) continue;  // the loop was certain to end at once
        if (hits[0].form == FirstHitForm::Chain) {
            ++refused_count;
            EXPECT_TRUE(lowered == loop) << "a refused loop stays as it is";
            EXPECT_FALSE(hits[0].refusal.empty());
            continue;
        }
        ++lowered_count;
        Module flat = lowered;
        ASSERT_TRUE(
            optimize(flat, {.unroll_all = true, .flatten_all = true, .verify_each = true}).ok());
        const Evaluator original(written), rewritten(lowered), optimized(flat);
        Random random(seed);
        Texture odd = height_field(random, true);
        for (int i = 0; i < 60; ++i) {
            Environment environment = random_environment(random, written, textures);
            if (i % 3 == 0) environment.samplers = {&odd, textures.of_dimension(2)};
            if (i % 2 == 0)
                for (auto& input : environment.inputs)
                    for (double& component : input) component = static_cast<double>(random.unit());
            const Evaluation a = original.run(environment, Precision::Single);
            const Environment adapted = adapt(environment, written, lowered);
            ASSERT_EQ(difference(a, rewritten.run(adapted, Precision::Single), Precision::Single),
                      "")
                << print(loop) << print(lowered);
            const Environment flat_adapted = adapt(environment, written, flat);
            ASSERT_EQ(
                difference(a, optimized.run(flat_adapted, Precision::Single), Precision::Single),
                "")
                << print(loop) << print(flat);
        }
    }
    EXPECT_GT(lowered_count, rounds(600));
    EXPECT_GT(refused_count, rounds(50));
}

}  // namespace
}  // namespace intaglio::passes

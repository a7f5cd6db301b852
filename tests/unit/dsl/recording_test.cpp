// What the DSL records: values, variables, loops, ifs, names, lines and steps, checked by
// evaluating the IR.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "generator/dsl/control.h"
#include "generator/dsl/resources.h"
#include "generator/dsl/schedule.h"
#include "generator/ir/evaluate.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"

namespace intaglio::dsl {
namespace {

using testing::HasSubstr;

// A function of one float2 input `p`, recorded, verified and run.
class Recorded {
  public:
    template <typename Body>
    explicit Recorded(const Body& body) {
        module_.name = "test";
        module_.stage = ir::Stage::Function;
        Recorder recorder(module_);
        const float2 p = input<2>("p");
        const float1 result = body(p.x(), p.y());
        module_.outputs = {{"result", ir::float1, ir::Semantic::Result}};
        status_ = recorder.finish({result.id()});
        if (status_) {
            const Status verified = ir::verify(module_);
            EXPECT_TRUE(verified.ok()) << to_string(verified.error());
        }
    }
    double operator()(double x, double y = 0) const {
        ir::Environment environment;
        environment.inputs = {{x, y, 0, 0}};
        return ir::Evaluator(module_).run(environment, ir::Precision::Double).outputs[0][0];
    }
    std::string text() const { return ir::print(module_); }
    const Status& status() const { return status_; }

  private:
    ir::Module module_;
    Status status_ = Done{};
};

struct Knobs : KnobOwner {
    Knob<int> count{this, "count", 5, at_least{0}, at_most{10}, "iterations"};
    Loop loop{"loop", count};
    Loop inner{"inner", count};
};

TEST(Recording, ArithmeticMeansWhatItSays) {
    const Recorded f([](float1 x, float1 y) { return (2.0f * x - y / 4) * (1 + x) - -y; });
    EXPECT_DOUBLE_EQ(f(3, 8), (2 * 3 - 8 / 4.0) * 4 + 8);
    const Recorded vectors([](float1 x, float1 y) {
        const float3 v(x, y, 1.0f);
        const float4 w(v.xy() * 2.0f, v.z(), x);
        return dot(w, float4(0.5f)) + dot(cross(v, float3(0.0f, 0.0f, 1.0f)), float3(1.0f));
    });
    EXPECT_DOUBLE_EQ(vectors(3, 5), 0.5 * (6 + 10 + 1 + 3) + (5 - 3));
    const Recorded functions([](float1 x, float1 y) {
        return max(min(x, y), 0.25f) + saturate(x) + floor(y) + frac(y) + abs(-x) +
               lerp(x, y, 0.5f) + select(x < y && !(x == y), float1(100.0f), 0.0f);
    });
    EXPECT_DOUBLE_EQ(functions(0.5, 2.25), 0.5 + 0.5 + 2 + 0.25 + 0.5 + 1.375 + 100);
}

TEST(Recording, SamplersSayWhatTheyAreAndHowTheyAreRead) {
    const Recorded f([](float1 x, float1 y) {
        const sampler3D volume("distance_map", "empty radius", sampler3D::Filter::Nearest);
        const sampler2D map("height_map", "");
        return volume.sample_level(float3(x, y, 0.5f), 0.0f).x() +
               map.sample_level(float2(x, y), 0.0f).x();
    });
    ASSERT_TRUE(f.status().ok()) << to_string(f.status().error());
    EXPECT_THAT(f.text(), HasSubstr("sampler distance_map 3d nearest \"empty radius\"\n"));
    EXPECT_THAT(f.text(), HasSubstr("sampler height_map 2d\n"));
    const Recorded twice([](float1 x, float1 y) {
        const sampler2D one("cone_map", ""), other("cone_map", "", sampler2D::Filter::Nearest);
        return one.sample_level(float2(x, y), 0.0f).x() + other.sample_level(float2(x, y), 0.0f).x();
    });
    ASSERT_FALSE(twice.status().ok());
    EXPECT_EQ(twice.status().error().code, "declared-twice");
}

TEST(Recording, GuardsAreDefinedWhereTheBareFormIsNot) {
    const Recorded unit([](float1 x, float1 y) { return length(normalize(float2(x, y))); });
    EXPECT_NEAR(unit(3, 4), 1, 1e-6);
    EXPECT_EQ(unit(0, 0), 0) << "a bare normalize of zero is NaN";
    const Recorded quotient([](float1 x, float1 y) { return ratio(x, y); });
    EXPECT_DOUBLE_EQ(quotient(1, 4), 0.25);
    EXPECT_EQ(quotient(0, 0), 0) << "a bare 0 / 0 is NaN";
    EXPECT_EQ(quotient(3, 0), 1);
}

TEST(Recording, ALoopCarriesItsVariables) {
    Knobs knobs;
    const Recorded sum([&](float1 x, float1) -> float1 {
        var<float1> total{"total", 0.0f}, power{"power", 1.0f};
        for (int1 i : knobs.loop) {
            total = total + power * float1(i);
            power = power * x;
        }
        return total;
    });
    EXPECT_DOUBLE_EQ(sum(2), 0 * 1 + 1 * 2 + 2 * 4 + 3 * 8 + 4 * 16);
    EXPECT_THAT(sum.text(), HasSubstr("loop \"loop\" 5"));
}

TEST(Recording, UntilLeavesWithTheValuesItSees) {
    Knobs knobs;
    const Recorded first_above([&](float1 x, float1) -> float1 {
        var<float1> t{"t", 0.0f}, seen{"seen", -1.0f};
        for (int1 i : knobs.loop) {
            seen = float1(i);
            knobs.loop.until(t >= x);
            t = t + 1;
        }
        return t * 10 + seen;
    });
    EXPECT_DOUBLE_EQ(first_above(2), 22);
    EXPECT_DOUBLE_EQ(first_above(-1), 0)
        << "left in the first iteration, after `seen` was assigned";
    EXPECT_DOUBLE_EQ(first_above(99), 54) << "never left early";
}

TEST(Recording, LoopsNestAndIfsCarryOut) {
    Knobs knobs;
    const Recorded count([&](float1 x, float1) -> float1 {
        var<float1> inside{"inside", 0.0f};
        for (int1 i : knobs.loop)
            for (int1 j : knobs.inner)
                If(
                    float1(i + j) < x, [&] { inside = inside + 1; },
                    [&] { inside = inside + 0.5f; });
        return inside;
    });
    EXPECT_DOUBLE_EQ(count(3), 6 * 1 + 19 * 0.5);
    const Recorded without_else([](float1 x, float1) -> float1 {
        var<float1> y{"y", x};
        If(x > 1.0f, [&] { y = 1.0f; });
        return y;
    });
    EXPECT_DOUBLE_EQ(without_else(7), 1);
    EXPECT_DOUBLE_EQ(without_else(0.5), 0.5);
}

TEST(Recording, AVariableReadsAsItsPresentValue) {
    const Recorded f([](float1 x, float1) -> float1 {
        var<float1> a{"a", x};
        const float1 before = a;
        a = a + 1;
        var<float1> b{"b", a};
        a = b = a * 2;
        return before * 100 + a * 10 + b;
    });
    EXPECT_DOUBLE_EQ(f(3), 300 + 80 + 8);
}

TEST(Recording, NamesLinesAndStepsReachTheIr) {
    const Recorded f([](float1 x, float1) -> float1 {
        Step step("half", "Take half of it.");
        return let("half_of_x", x * 0.5f);
    });
    EXPECT_THAT(f.text(), HasSubstr("\"half_of_x\""));
    EXPECT_THAT(f.text(), HasSubstr("file \"tests/unit/dsl/recording_test.cpp\"")) << "relative to the project";
    EXPECT_THAT(f.text(), HasSubstr("\"Take half of it.\""));
}

TEST(Recording, ALoopLeftByBreakIsAnError) {
    Knobs knobs;
    const Recorded f([&](float1 x, float1) -> float1 {
        for ([[maybe_unused]] int1 i : knobs.loop) break;
        return x;
    });
    ASSERT_FALSE(f.status().ok());
    EXPECT_EQ(f.status().error().code, "unclosed-scope");
}

TEST(Recording, UntilInsideAnIfIsAnErrorWithItsLine) {
    Knobs knobs;
    const Recorded f([&](float1 x, float1) -> float1 {
        for ([[maybe_unused]] int1 i : knobs.loop)
            If(x > 0.0f, [&] { knobs.loop.until(x > 1.0f); });
        return x;
    });
    ASSERT_FALSE(f.status().ok());
    EXPECT_EQ(f.status().error().code, "until-outside-loop");
    EXPECT_EQ(f.status().error().file, "tests/unit/dsl/recording_test.cpp");
    EXPECT_GT(f.status().error().line, 100);
}

TEST(Knob, KeepsItsRange) {
    Knobs knobs;
    EXPECT_TRUE(knobs.count.set("7").ok());
    EXPECT_EQ(knobs.count.value(), 7);
    for (const char* bad : {"", "x", "7x", "nan", "inf", "1e400", "0x7", " 7"})
        EXPECT_EQ(knobs.count.set(bad).error().code, "knob-value") << bad;
    EXPECT_EQ(knobs.count.set("7.5").error().code, "knob-value");
    EXPECT_EQ(knobs.count.set("11").error().code, "knob-range");
    EXPECT_EQ(knobs.count.set("-1").error().code, "knob-range");
    EXPECT_EQ(knobs.count.value(), 7) << "a refused value changes nothing";
}

TEST(Schedule, PatternsMatchTargets) {
    EXPECT_TRUE(matches_pattern("ps_2_0", "ps_2_*"));
    EXPECT_TRUE(matches_pattern("ps_2_0", "*"));
    EXPECT_TRUE(matches_pattern("ps_2_0", "ps_2_0"));
    EXPECT_TRUE(matches_pattern("ps_2_0", "*2*"));
    EXPECT_FALSE(matches_pattern("ps_3_0", "ps_2_*"));
    EXPECT_FALSE(matches_pattern("ps_2_0", "ps_2"));
}

TEST(Schedule, TheFirstMatchHolds) {
    for (const auto& [target, form] :
         {std::pair{"ps_2_b", "unrolled"}, std::pair{"glsl_450", "rolled"}}) {
        Knobs knobs;
        ir::Module module;
        module.stage = ir::Stage::Function;
        Recorder recorder(module);
        Schedule schedule(target);
        schedule.on("ps_2_*").unroll(knobs.loop);
        schedule.on("*").loop(knobs.loop);
        schedule.apply(recorder);
        var<float1> x{"x", 0.0f};
        for ([[maybe_unused]] int1 i : knobs.loop) x = x + 1;
        module.outputs = {{"result", ir::float1, ir::Semantic::Result}};
        ASSERT_TRUE(recorder.finish({x.id()}).ok());
        EXPECT_THAT(ir::print(module), HasSubstr(form));
    }
}

}  // namespace
}  // namespace intaglio::dsl

// Properties of the emitted text of random modules: it computes what the module computes, every
// witness accepts it in every language, and it is the same each time.
#include <bit>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/target/replace_int_functions.h"
#include "tests/rounds.h"
#include "tests/unit/ir/random_environment.h"
#include "tests/unit/ir/random_module.h"
#include "tests/unit/target/interpreter.h"
#include "tests/unit/target/programs.h"

namespace intaglio {
namespace {

using ir::testing::random_module;
using ir::testing::RandomModuleOptions;

// A pixel module with plain names; schedules that ask for unrolling, and consent to round
// differently, are dropped, so that it can be printed as it is and computes the same after the
// passes.
ir::Module plain_module(std::uint64_t seed, RandomModuleOptions options) {
    options.odd_text = false;
    options.unused_values = false;
    ir::Module module;
    do module = random_module(seed++, options);
    while (module.stage != ir::Stage::Pixel);
    for (std::size_t i = 0; i < module.inputs.size(); ++i)
        module.inputs[i].name = "in" + std::to_string(i);
    for (std::size_t i = 0; i < module.outputs.size(); ++i)
        module.outputs[i].name = "to" + std::to_string(i);
    for (std::size_t i = 0; i < module.uniforms.size(); ++i)
        module.uniforms[i].name = "un" + std::to_string(i);
    const auto keep_loops = [](auto&& self, ir::Region& region) -> void {
        for (ir::Instruction& instruction : region.body) {
            if (instruction.loop.form == ir::LoopForm::Unrolled)
                instruction.loop.form = ir::LoopForm::Rolled;
            instruction.loop.closed_form = false;
            for (ir::Region& inner : instruction.regions) self(self, inner);
        }
    };
    keep_loops(keep_loops, module.body);
    return module;
}

testing::TextValue text_value(ir::Type type, const ir::Environment::Vector& vector) {
    testing::TextValue value{type, {}};
    for (int i = 0; i < type.width; ++i) {
        const double component = vector[static_cast<std::size_t>(i)];
        std::uint32_t& bits = value.bits[static_cast<std::size_t>(i)];
        if (type.scalar == ir::Scalar::Float) bits = ir::float_bits(static_cast<float>(component));
        if (type.scalar == ir::Scalar::Int)
            bits = static_cast<std::uint32_t>(static_cast<std::int32_t>(component));
        if (type.scalar == ir::Scalar::Bool) bits = component != 0;
    }
    return value;
}

void expect_same(const ir::Module& module, const std::string& text, std::uint64_t seed) {
    const auto random = ir::testing::random_environment(module, seed);
    const ir::Environment& environment = random.environment;
    std::map<std::string, testing::TextValue> globals;
    for (std::size_t i = 0; i < module.inputs.size(); ++i)
        globals["in" + std::to_string(i)] =
            text_value(module.inputs[i].type, environment.inputs[i]);
    for (std::size_t i = 0; i < module.uniforms.size(); ++i)
        for (std::size_t j = 0; j < environment.uniforms[i].size(); ++j) {
            const std::string element =
                module.uniforms[i].count > 1 ? "[" + std::to_string(j) + "]" : "";
            globals["un" + std::to_string(i) + element] =
                text_value(module.uniforms[i].type, environment.uniforms[i][j]);
        }
    for (std::size_t i = 0; i < module.outputs.size(); ++i)
        globals["to" + std::to_string(i)] = {module.outputs[i].type, {}};

    const auto after = testing::run_main(text, globals);
    ASSERT_TRUE(after.ok()) << "seed " << seed << ": " << to_string(after.error()) << "\n" << text;
    const ir::Evaluation expected = ir::Evaluator(module).run(environment, ir::Precision::Single);
    for (std::size_t i = 0; i < module.outputs.size(); ++i) {
        const testing::TextValue& actual = after->at("to" + std::to_string(i));
        for (int j = 0; j < module.outputs[i].type.width; ++j) {
            const auto component = static_cast<std::size_t>(j);
            const float wanted = static_cast<float>(expected.outputs[i][component]);
            const float got = std::bit_cast<float>(actual.bits[component]);
            if (wanted != wanted && got != got) continue;
            ASSERT_EQ(ir::float_bits(wanted), actual.bits[component])
                << "seed " << seed << " output " << i << " component " << j << ": expected "
                << wanted << ", actual " << got << "\n"
                << text << ir::print(module);
        }
    }
}

// Loops and ifs that carry a few floats and mix them up: nearly every value is carried, yielded and
// read late, which is what decides whether values may share a variable.
class Shuffles {
  public:
    explicit Shuffles(std::uint64_t seed) : random_(seed), builder_(module_) {}

    ir::Module make() {
        module_.name = "shuffles";
        for (int i = 0; i < 3; ++i) {
            module_.inputs.push_back(
                {"in" + std::to_string(i), ir::float1, ir::Semantic::Interpolant});
            visible_.push_back(builder_.input(i));
        }
        for (int i = random_.between(1, 3); i > 0; --i) nest(0);
        std::vector<ir::ValueId> outputs;
        for (int i = 0; i < 4; ++i) {
            module_.outputs.push_back({"to" + std::to_string(i), ir::float1, ir::Semantic::Target});
            outputs.push_back(
                visible_[visible_.size() - 1 - static_cast<std::size_t>(i) % visible_.size()]);
        }
        builder_.finish(outputs);
        return std::move(module_);
    }

  private:
    // Recent values are likelier.
    ir::ValueId pick() {
        const int count = static_cast<int>(visible_.size());
        const int back =
            random_.chance(70) ? random_.below(std::min(count, 5)) : random_.below(count);
        return visible_[static_cast<std::size_t>(count - 1 - back)];
    }

    std::vector<ir::ValueId> picks(int count) {
        std::vector<ir::ValueId> values;
        for (int i = 0; i < count; ++i) values.push_back(pick());
        return values;
    }

    void keep(ir::ValueId value) {
        if (random_.chance(30)) module_.values[ir::index_of(value)].name = "named";
        visible_.push_back(value);
    }

    void nest(int depth) {
        if (depth == 0 || random_.chance(60))
            loop(depth);
        else
            branch(depth);
    }

    void work(int depth) {
        for (int i = random_.between(1, 4); i > 0; --i) {
            const ir::ValueId a = pick(), b = pick();
            keep(builder_.emit(random_.chance(50) ? ir::Op::Sub : ir::Op::Min, {a, b}));
        }
        if (depth < 3 && random_.chance(40)) nest(depth + 1);
    }

    void loop(int depth) {
        const int count = random_.between(1, 4);
        const std::size_t outside = visible_.size();
        const auto scope = builder_.begin_loop(
            {"loop", random_.between(1, 4), ir::LoopForm::Unspecified, false}, picks(count));
        for (ir::ValueId carried : scope.carried) keep(carried);
        work(depth);
        if (random_.chance(50)) {
            const ir::ValueId a = pick(), b = pick();
            const ir::ValueId condition = builder_.emit(ir::Op::Less, {a, b});
            builder_.break_if(condition, random_.chance(50) ? scope.carried : picks(count));
            work(depth);
        }
        const std::vector<ir::ValueId> next = picks(count);
        visible_.resize(outside);
        for (ir::ValueId result : builder_.end_loop(next)) keep(result);
    }

    void branch(int depth) {
        const int count = random_.between(1, 3);
        const std::size_t outside = visible_.size();
        const ir::ValueId a = pick(), b = pick();
        builder_.begin_if(builder_.emit(ir::Op::Less, {a, b}));
        work(depth);
        const std::vector<ir::ValueId> then_values = picks(count);
        visible_.resize(outside);
        builder_.begin_else(then_values);
        if (random_.chance(50)) work(depth);
        const std::vector<ir::ValueId> else_values = picks(count);
        visible_.resize(outside);
        for (ir::ValueId result : builder_.end_if(else_values)) keep(result);
    }

    ir::testing::Random random_;
    ir::Module module_;
    ir::Builder builder_;
    std::vector<ir::ValueId> visible_;
};

TEST(RandomText, KeepsCarriedValuesApart) {
    for (std::uint64_t seed = 1; seed <= rounds(1500u); ++seed) {
        const ir::Module module = Shuffles(seed).make();
        ASSERT_TRUE(ir::verify(module).ok()) << to_string(ir::verify(module).error());
        const auto artifact =
            find_target("glsl_330")->print(testing::program_of(module), ir::Stage::Pixel);
        ASSERT_TRUE(artifact.ok()) << to_string(artifact.error());
        for (std::uint64_t run = 0; run < 3; ++run)
            expect_same(module, artifact->text, seed * 10 + run);
        if (HasFatalFailure()) return;
    }
}

TEST(RandomText, ComputesWhatTheModuleComputesBeforeAnyPass) {
    RandomModuleOptions options;
    options.samples = options.derivatives = false;
    for (std::uint64_t seed = 1; seed <= rounds(400u); ++seed) {
        options.instructions = 10 + static_cast<int>(seed % 60);
        const ir::Module module = plain_module(seed * 1000, options);
        const auto artifact =
            find_target("glsl_330")->print(testing::program_of(module), ir::Stage::Pixel);
        ASSERT_TRUE(artifact.ok()) << to_string(artifact.error());
        for (std::uint64_t run = 0; run < 3; ++run)
            expect_same(module, artifact->text, seed * 10 + run);
        if (HasFatalFailure()) return;
    }
}

TEST(RandomText, ComputesWhatTheModuleComputesAfterThePasses) {
    RandomModuleOptions options;
    options.samples = options.derivatives = false;
    for (std::uint64_t seed = 1; seed <= rounds(150u); ++seed) {
        options.instructions = 20 + static_cast<int>(seed % 60);
        const ir::Module module = plain_module(seed * 77777, options);
        const Artifact artifact =
            testing::emitted(testing::program_of(module), ir::Stage::Pixel, "glsl_330");
        for (std::uint64_t run = 0; run < 3; ++run)
            expect_same(module, artifact.text, seed * 10 + run);
        if (HasFatalFailure()) return;
    }
}

TEST(ReplaceIntFunctions, KeepsEveryValue) {
    RandomModuleOptions options;
    options.samples = options.derivatives = false;
    int replaced = 0;
    for (std::uint64_t seed = 1; seed <= rounds(200u); ++seed) {
        options.instructions = 60;
        const ir::Module module = plain_module(seed * 4242, options);
        ir::Module after = module;
        Notes notes;
        ASSERT_TRUE(replace_int_functions(after, *find_target("glsl_120"), notes).ok());
        ASSERT_TRUE(ir::verify(after).ok()) << to_string(ir::verify(after).error());
        replaced += after == module ? 0 : 1;
        const auto random = ir::testing::random_environment(module, seed);
        const auto expected = ir::Evaluator(module).run(random.environment, ir::Precision::Single);
        const auto actual = ir::Evaluator(after).run(random.environment, ir::Precision::Single);
        for (std::size_t i = 0; i < module.outputs.size(); ++i)
            for (int j = 0; j < module.outputs[i].type.width; ++j) {
                const double wanted = expected.outputs[i][static_cast<std::size_t>(j)];
                const double got = actual.outputs[i][static_cast<std::size_t>(j)];
                if (wanted != wanted && got != got) continue;
                ASSERT_EQ(wanted, got) << "seed " << seed << "\n" << ir::print(after);
            }
    }
    EXPECT_GT(replaced, rounds(20));
}

TEST(RandomText, EveryWitnessAcceptsEveryLanguage) {
    const std::set<std::string_view> old = {"hlsl_3_0", "hlsl_2_b", "hlsl_2_0", "glsl_120",
                                            "essl_100"};
    std::map<std::string_view, int> accepted;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        RandomModuleOptions options;
        options.special_constants = seed % 2 == 0;
        const ir::Program program = testing::program_of(plain_module(seed * 1000, options));
        for (const testing::TextTarget& target : testing::text_targets) {
            const Result<Emitted> both = emit(program, *find_target(target.name));
            if (!both.ok()) {
                // The old languages have no way to write an infinity, and some have no volume
                // textures, no second colour target or no levels of texture reads.
                EXPECT_TRUE(old.contains(target.name)) << to_string(both.error());
                EXPECT_EQ(both.error().code, "target-limit");
                continue;
            }
            ++accepted[target.name];
            const Artifact& artifact = both->pixel;
            const Status words = testing::accepted(testing::source_of(artifact, target.language));
            EXPECT_TRUE(words.ok())
                << "seed " << seed << " " << target.name << ": " << to_string(words.error()) << "\n"
                << artifact.text;
            EXPECT_EQ(artifact.text, testing::emitted(program, ir::Stage::Pixel, target.name).text);
            if (::testing::Test::HasFailure()) return;
        }
    }
    for (const testing::TextTarget& target : testing::text_targets)
        EXPECT_GE(accepted[target.name], 5) << target.name;
}

}  // namespace
}  // namespace intaglio

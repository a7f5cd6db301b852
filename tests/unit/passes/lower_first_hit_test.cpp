// First-hit searches, as loops, as chains of selects and by the greatest key, compute the same: the
// techniques over views and maps, and random searches with values on which arithmetic goes wrong.
#include "generator/passes/lower_first_hit.h"

#include <gtest/gtest.h>

#include "generator/ir/builder.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/rewrite.h"
#include "templates/all_techniques.h"
#include "tests/unit/passes/environment.h"

namespace intaglio::passes {
namespace {

using namespace testing;
using namespace ir;

using Knobs = std::vector<std::pair<std::string, std::string>>;

Module technique(const std::string& composition, const Knobs& knobs) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    Result<dsl::Surface> surface = dsl::make_surface(catalogue, composition);
    EXPECT_TRUE(surface.ok());
    for (const auto& [name, value] : knobs)
        EXPECT_TRUE(surface->set_knob(name, value).ok()) << name;
    dsl::RecordOptions options;
    options.target = "glsl_450";
    const Result<Program> program = dsl::record_surface(*surface, options);
    EXPECT_TRUE(program.ok());
    Module module = program->pixel;
    EXPECT_TRUE(optimize(module, {.verify_each = true}).ok());
    return module;
}

// The module without loops, its searches in the given form.
std::vector<FirstHit> flatten(Module& module, FirstHitForm form) {
    std::vector<FirstHit> hits = lower_first_hit(module, form);
    const Status status = verify(module);
    EXPECT_TRUE(status.ok()) << to_string(status.error()) << "\n" << print(module);
    EXPECT_TRUE(
        optimize(module, {.unroll_all = true, .flatten_all = true, .verify_each = true}).ok());
    return hits;
}

struct Cost {
    int reads = 0;
    int lanes = 0;    // components computed, of any op but moves
    int selects = 0;  // of these, those of selects
    int compares = 0;
};

Cost cost_of(const Module& module) {
    Cost cost;
    for_each_instruction(module.body, [&](const Instruction& instruction) {
        if (is_sample(instruction.op)) ++cost.reads;
        if (!is_arithmetic(instruction.op) || is_leaf(instruction.op) ||
            instruction.op == Op::Compose || instruction.op == Op::Swizzle)
            return;
        const int width = module.type(instruction.result()).width;
        cost.lanes += width;
        if (instruction.op == Op::Select) cost.selects += width;
        if (info(instruction.op).type_rule == TypeRule::Compare) cost.compares += width;
    });
    return cost;
}

// A height field that rises in places, so that rays hit at once, late, and only at the floor; or
// texels that no map should have.
Texture height_field(Random& random, bool odd) {
    Texture texture;
    texture.width = 16;
    texture.height = 16;
    texture.filter = random.chance(50) ? Texture::Filter::Linear : Texture::Filter::Nearest;
    const float power = static_cast<float>(random.between(1, 6));
    std::vector<float>& texels = texture.levels.emplace_back();
    for (int i = 0; i < 4 * 16 * 16; ++i)
        texels.push_back(odd ? random.any_float() : std::pow(random.unit(), power));
    return texture;
}

// Views from straight down to below the horizon.
Environment view(Random& random, const Module& module, const Texture& texture) {
    Environment environment;
    for (const Declaration& input : module.inputs) {
        auto& vector = environment.inputs.emplace_back();
        for (double& component : vector)
            component = static_cast<double>(random.unit() * 2.0f - 1.0f);
        if (input.type == float3 && !random.chance(5)) vector[2] = std::fabs(vector[2]);
    }
    environment.right_inputs = environment.lower_inputs = environment.inputs;
    for (const Uniform& uniform : module.uniforms)
        environment.uniforms.emplace_back(static_cast<std::size_t>(uniform.count),
                                          Environment::Vector{0.3, 0.3, 0.3, 0.3});
    for (std::size_t i = 0; i < module.samplers.size(); ++i)
        environment.samplers.push_back(&texture);
    return environment;
}

void expect_same(const Module& before, const Module& after, std::uint64_t seed, int count) {
    Random random(seed);
    const Evaluator original(before), lowered(after);
    for (int map = 0; map < 12; ++map) {
        const Texture texture = height_field(random, map % 4 == 3);
        for (int i = 0; i < count; ++i) {
            const Environment environment = view(random, before, texture);
            const Evaluation a = original.run(environment, Precision::Single);
            const Evaluation b = lowered.run(adapt(environment, before, after), Precision::Single);
            ASSERT_EQ(difference(a, b, Precision::Single), "")
                << "seed " << seed << ", map " << map << ", view " << i << "\n"
                << print(before) << print(after);
        }
    }
}

void expect_lowered(const std::vector<FirstHit>& hits, std::size_t count) {
    EXPECT_EQ(hits.size(), count);
    for (const FirstHit& hit : hits)
        EXPECT_EQ(hit.form, FirstHitForm::PackedRefetch) << hit.loop << ": " << hit.refusal;
}

TEST(LowerFirstHit, ParallaxOcclusionWithAnyTaps) {
    for (int taps = 2; taps <= 64; ++taps) {
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
        if (taps == 8) std::printf("packed\n%s", print(packed).c_str());
        if (taps >= 8) {
            EXPECT_LT(cost_of(packed).lanes, cost_of(chain).lanes);
        }
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

}  // namespace
}  // namespace intaglio::passes

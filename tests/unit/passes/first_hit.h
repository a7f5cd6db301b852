// What the tests of first-hit searches share: the techniques, height fields and views, and the
// comparison of a loop with its other forms.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/lower_first_hit.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/rewrite.h"
#include "templates/all_techniques.h"
#include "tests/rounds.h"
#include "tests/unit/passes/environment.h"

namespace intaglio::passes::testing {

using namespace ir;

using Knobs = std::vector<std::pair<std::string, std::string>>;

inline Module technique(const std::string& composition, const Knobs& knobs) {
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
inline std::vector<FirstHit> flatten(Module& module, FirstHitForm form) {
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

inline Cost cost_of(const Module& module) {
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
inline Texture height_field(Random& random, bool odd) {
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
inline Environment view(Random& random, const Module& module, const Texture& texture) {
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

enum class Maps { Sane, WithOdd };
inline void expect_same(const Module& before, const Module& after, std::uint64_t seed, int count,
                        Maps maps = Maps::WithOdd) {
    Random random(seed);
    const Evaluator original(before), lowered(after);
    for (int map = 0; map < 12; ++map) {
        const Texture texture = height_field(random, maps == Maps::WithOdd && map % 4 == 3);
        for (int i = 0; i < rounds(count); ++i) {
            const Environment environment = view(random, before, texture);
            const Evaluation a = original.run(environment, Precision::Single);
            const Evaluation b = lowered.run(adapt(environment, before, after), Precision::Single);
            ASSERT_EQ(difference(a, b, Precision::Single), "")
                << "seed " << seed << ", map " << map << ", view " << i << "\n"
                << print(before) << print(after);
        }
    }
}

}  // namespace intaglio::passes::testing

// Random surroundings for a module, and the comparison of what two modules compute in them.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "generator/ir/evaluate.h"
#include "tests/unit/ir/random.h"

namespace intaglio::passes::testing {

using ir::testing::Random;

// Small textures of random texels, 2D and 3D.
class Textures {
  public:
    explicit Textures(std::uint64_t seed) : flat_(make(seed, 1)), solid_(make(seed + 1, 4)) {}

    const ir::Texture* of_dimension(int dimension) const {
        return dimension == 2 ? &flat_ : &solid_;
    }

  private:
    static ir::Texture make(std::uint64_t seed, int depth) {
        Random random(seed);
        ir::Texture texture;
        texture.width = 8;
        texture.height = 4;
        texture.depth = depth;
        for (int level = 0; level < 3; ++level) {
            const int texels = (8 >> level) * (4 >> level) * std::max(1, depth >> level);
            std::vector<float>& values = texture.levels.emplace_back();
            for (int i = 0; i < 4 * texels; ++i) values.push_back(random.unit());
        }
        return texture;
    }

    ir::Texture flat_, solid_;
};

inline ir::Environment::Vector random_vector(Random& random, ir::Type type) {
    ir::Environment::Vector vector{};
    for (int i = 0; i < type.width; ++i) {
        double& component = vector[static_cast<std::size_t>(i)];
        if (type.scalar == ir::Scalar::Float) component = static_cast<double>(random.any_float());
        if (type.scalar == ir::Scalar::Int) component = random.between(-10, 10);
        if (type.scalar == ir::Scalar::Bool) component = random.below(2);
    }
    return vector;
}

inline ir::Environment random_environment(Random& random, const ir::Module& module,
                                          const Textures& textures) {
    ir::Environment environment;
    for (const ir::Declaration& input : module.inputs) {
        environment.inputs.push_back(random_vector(random, input.type));
        environment.right_inputs.push_back(random_vector(random, input.type));
        environment.lower_inputs.push_back(random_vector(random, input.type));
    }
    for (const ir::Uniform& uniform : module.uniforms) {
        auto& elements = environment.uniforms.emplace_back();
        for (int i = 0; i < uniform.count; ++i)
            elements.push_back(random_vector(random, uniform.type));
    }
    for (const ir::Sampler& sampler : module.samplers)
        environment.samplers.push_back(textures.of_dimension(sampler.dimension));
    return environment;
}

// Equal to the bit, but any NaN equals any NaN and in Single a denormal equals the zero of its sign
// (rewrite_rules.h).
inline bool same_number(double a, double b, ir::Precision precision) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
    const auto flush = [&](double x) {
        const bool denormal = std::fabs(x) < static_cast<double>(std::numeric_limits<float>::min());
        return precision == ir::Precision::Single && denormal ? std::copysign(0.0, x) : x;
    };
    return std::bit_cast<std::uint64_t>(flush(a)) == std::bit_cast<std::uint64_t>(flush(b));
}

// Empty, or a sentence with the first component that differs.
inline std::string difference(const ir::Evaluation& before, const ir::Evaluation& after,
                              ir::Precision precision) {
    if (before.outputs.size() > after.outputs.size()) return "outputs are missing";
    for (std::size_t i = 0; i < before.outputs.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k)
            if (!same_number(before.outputs[i][k], after.outputs[i][k], precision))
                return fmt::format("output {} component {}: before {}, after {}", i, k,
                                   before.outputs[i][k], after.outputs[i][k]);
    return {};
}

// The module's declarations may be fewer after a pass: inputs, uniforms and samplers are matched by
// name.
inline ir::Environment adapt(const ir::Environment& environment, const ir::Module& before,
                             const ir::Module& after) {
    const auto slot = [](const auto& declarations, const std::string& name) {
        std::size_t i = 0;
        while (declarations[i].name != name) ++i;
        return i;
    };
    ir::Environment adapted;
    for (const ir::Declaration& input : after.inputs) {
        const std::size_t i = slot(before.inputs, input.name);
        adapted.inputs.push_back(environment.inputs[i]);
        adapted.right_inputs.push_back(environment.right_inputs[i]);
        adapted.lower_inputs.push_back(environment.lower_inputs[i]);
    }
    // Without any neighbouring input the evaluator would take derivatives for 0, and inf - inf is
    // not.
    adapted.right_inputs.emplace_back();
    adapted.lower_inputs.emplace_back();
    for (const ir::Uniform& uniform : after.uniforms)
        adapted.uniforms.push_back(environment.uniforms[slot(before.uniforms, uniform.name)]);
    for (const ir::Sampler& sampler : after.samplers)
        adapted.samplers.push_back(environment.samplers[slot(before.samplers, sampler.name)]);
    return adapted;
}

}  // namespace intaglio::passes::testing

// Random inputs, uniforms and textures for a module, special values included, for evaluating it
// before and after a pass.
#pragma once

#include <cstring>
#include <memory>
#include <vector>

#include "generator/ir/evaluate.h"
#include "tests/unit/ir/random.h"

namespace intaglio::ir::testing {

// An environment that owns its textures.
struct RandomEnvironment {
    Environment environment;
    std::vector<std::unique_ptr<Texture>> textures;
};

inline Texture random_texture(Random& random, int dimension) {
    Texture texture;
    texture.width = random.between(1, 9);
    texture.height = random.between(1, 9);
    texture.depth = dimension == 3 ? random.between(1, 4) : 1;
    texture.filter = random.chance(70) ? Texture::Filter::Linear : Texture::Filter::Nearest;
    texture.mip_filter = random.chance(70) ? Texture::Filter::Linear : Texture::Filter::Nearest;
    texture.wrap = random.chance(70) ? Texture::Wrap::Repeat : Texture::Wrap::Clamp;
    texture.weights = random.chance(70) ? Texture::Weights::Exact : Texture::Weights::EightBit;
    for (int level = 0, count = random.between(1, 4); level < count; ++level) {
        const int texels = std::max(1, texture.width >> level) *
                           std::max(1, texture.height >> level) *
                           std::max(1, texture.depth >> level);
        std::vector<float>& values = texture.levels.emplace_back();
        for (int i = 0; i < texels * 4; ++i) values.push_back(random.unit());
    }
    return texture;
}

// With `special`, one number in five is odd (NaN, infinite, denormal, any bits); otherwise all lie
// in [-4, 4].
inline RandomEnvironment random_environment(const Module& module, std::uint64_t seed,
                                            bool special = true) {
    Random random(seed);
    RandomEnvironment result;
    const auto vector = [&](Type type) {
        Environment::Vector values{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(type.width); ++i) {
            if (type.scalar == Scalar::Float)
                values[i] = special ? random.any_float() : random.unit() * 8.0f - 4.0f;
            if (type.scalar == Scalar::Int) values[i] = random.between(-8, 8);
            if (type.scalar == Scalar::Bool) values[i] = random.below(2);
        }
        return values;
    };
    for (auto* inputs : {&result.environment.inputs, &result.environment.right_inputs,
                         &result.environment.lower_inputs})
        for (const Declaration& input : module.inputs) inputs->push_back(vector(input.type));
    for (const Uniform& uniform : module.uniforms) {
        auto& elements = result.environment.uniforms.emplace_back();
        for (int i = 0; i < uniform.count; ++i) elements.push_back(vector(uniform.type));
    }
    for (const Sampler& sampler : module.samplers) {
        result.textures.push_back(
            std::make_unique<Texture>(random_texture(random, sampler.dimension)));
        result.environment.samplers.push_back(result.textures.back().get());
    }
    return result;
}

// Equal to the bit, zeros of either sign told apart; any NaN equals any NaN.
inline bool same_outputs(const Evaluation& a, const Evaluation& b) {
    if (a.outputs.size() != b.outputs.size()) return false;
    for (std::size_t i = 0; i < a.outputs.size(); ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            const double x = a.outputs[i][j], y = b.outputs[i][j];
            if (x != x && y != y) continue;
            if (std::memcmp(&x, &y, sizeof x) != 0) return false;
        }
    return true;
}

}  // namespace intaglio::ir::testing

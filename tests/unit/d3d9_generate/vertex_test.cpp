// Vertex shaders compute what the IR says, write what the pixel shader reads where it reads it, and
// are legal.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include <fmt/format.h>

#include "generator/ir/builder.h"
#include "generator/ir/parse.h"
#include "generator/ir/verify.h"
#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/generate/vertex.h"
#include "generator/target/d3d9/legality.h"
#include "generator/target/d3d9/limits.h"
#include "tests/unit/d3d9_generate/random_vertex.h"
#include "tests/unit/d3d9_generate/surfaces.h"
#include "tests/unit/d3d9_generate/vertex_draw.h"

namespace intaglio::d3d9 {
namespace {

using ::testing::HasSubstr;

constexpr unsigned seed = 30262;

double number(std::mt19937& random, float low = -2, float high = 2) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

VertexValues random_values(const ir::Module& vertex, std::mt19937& random) {
    VertexValues values;
    const auto vector = [&](int width) {
        ir::Environment::Vector value{};
        for (int k = 0; k < width; ++k) value[static_cast<std::size_t>(k)] = number(random);
        return value;
    };
    for (const ir::Declaration& input : vertex.inputs)
        values.attributes.push_back(vector(input.type.width));
    for (const ir::Uniform& uniform : vertex.uniforms) {
        values.uniforms.emplace_back();
        for (int e = 0; e < uniform.count; ++e)
            values.uniforms.back().push_back(vector(uniform.type.width));
    }
    return values;
}

// Places and directions, mirrored frames and plain ones, in turn.
void set_special_cases(const ir::Module& vertex, VertexValues& values, int draw) {
    for (std::size_t i = 0; i < vertex.inputs.size(); ++i)
        if (vertex.inputs[i].name == "tangent") values.attributes[i][3] = draw % 2 == 0 ? 1 : -1;
    for (std::size_t i = 0; i < vertex.uniforms.size(); ++i) {
        if (vertex.uniforms[i].name == "eye") values.uniforms[i][0][3] = draw / 2 % 2;
        if (vertex.uniforms[i].name == "light") values.uniforms[i][0][3] = draw / 4 % 2;
    }
}

ir::Program parsed(std::string_view text) {
    const auto module = ir::parse(text, "vertex.ir");
    EXPECT_TRUE(module) << (module ? "" : to_string(module.error()));
    EXPECT_TRUE(ir::verify(*module).ok());
    return vertex_program(*module);
}

Shader generated(const ir::Program& program, Profile profile) {
    const auto shader = generate_vertex(program, profile);
    EXPECT_TRUE(shader) << (shader ? "" : to_string(shader.error()));
    if (!shader) return {};
    const auto violations = check(*shader);
    EXPECT_TRUE(violations.empty()) << violations[0].message << "\n" << print(*shader);
    return *shader;
}

Profile pixel_profile(Profile vertex) {
    return vertex == Profile::vs_3_0 ? Profile::ps_3_0 : Profile::ps_2_0;
}

class Vertex : public ::testing::TestWithParam<Profile> {
  protected:
    // The largest difference over random draws, relative to numbers greater than 1.
    static double worst_difference(const ir::Program& program, int draws) {
        const Shader shader = generated(program, GetParam());
        const VertexDraw draw(program.vertex, shader);
        const auto wires = wires_of(program, pixel_profile(GetParam()));
        std::mt19937 random(seed);
        double worst = 0;
        for (int i = 0; i < draws; ++i) {
            VertexValues values = random_values(program.vertex, random);
            set_special_cases(program.vertex, values, i);
            for (const auto& [expected, got] : draw.run(values, wires)) {
                const double difference =
                    std::fabs(expected - got) / std::max(1.0, std::fabs(expected));
                worst = difference >= 0 ? std::max(worst, difference) : INFINITY;
            }
        }
        return worst;
    }
};
INSTANTIATE_TEST_SUITE_P(Profiles, Vertex, ::testing::Values(Profile::vs_2_0, Profile::vs_3_0),
                         [](const auto& test) { return std::string(name_of(test.param)); });

TEST_P(Vertex, ComputesThePositionAndTheFramesOfASurface) {
    for (const std::string surface : {"bump", "parallax_occlusion", "fur"}) {
        SCOPED_TRACE(surface);
        const auto program = record({surface, {}}, pixel_profile(GetParam()));
        ASSERT_TRUE(program);
        // Dot products of four terms up to 4, three of them after each other: 30 roundings.
        EXPECT_LE(worst_difference(*program, 64), 2e-5);
    }
}

// Fused and reassociated arithmetic rounds differently, and where that meets a jump (floor, a
// comparison) the result is another one: rarely.
TEST_P(Vertex, ComputesRandomModules) {
    int compared = 0, different = 0;
    for (unsigned i = 0; i < 150; ++i) {
        SCOPED_TRACE(fmt::format("seed {}", seed + i));
        const ir::Program program = random_vertex_program(seed + i, 12);
        ASSERT_TRUE(ir::verify(program.vertex).ok());
        const auto shader = generate_vertex(program, GetParam());
        if (!shader) {
            EXPECT_EQ(shader.error().code, "d3d9-limit") << to_string(shader.error());
            continue;
        }
        EXPECT_TRUE(check(*shader).empty()) << print(*shader);
        const VertexDraw draw(program.vertex, *shader);
        std::mt19937 random(seed + i);
        int here = 0;
        for (int k = 0; k < 10; ++k)
            for (const auto& [expected, got] :
                 draw.run(random_values(program.vertex, random),
                          wires_of(program, pixel_profile(GetParam())))) {
                ++compared;
                here += !(std::fabs(expected - got) <= 1e-3 * std::max(1.0, std::fabs(expected)));
            }
        EXPECT_LE(here, 8) << print(*shader);
        different += here;
    }
    EXPECT_GT(compared, 10000);
    EXPECT_LE(different, compared / 200);
}

// The components of a texture coordinate that a vertex shader writes.
Mask written(const Shader& shader, int index) {
    unsigned lanes = 0;
    for (const Instruction& instruction : shader.instructions) {
        const Destination& d = *instruction.destination;
        if (d.file == File::TexcoordOut && d.index == index) lanes |= d.mask;
        for (const Declaration& declaration : shader.declarations)
            if (d.file == File::Output && declaration.target.file == File::Output &&
                declaration.target.index == d.index && declaration.usage == Usage::Texcoord &&
                declaration.usage_index == index)
                lanes |= static_cast<unsigned>(d.mask & declaration.target.mask);
    }
    return static_cast<Mask>(lanes);
}

// Smooth, so that rounding of a coordinate moves a height by little.
ir::Texture waves(std::size_t which) {
    constexpr int size = 16;
    ir::Texture texture;
    texture.width = texture.height = size;
    texture.levels.emplace_back();
    for (int i = 0; i < size * size * 4; ++i) {
        const float x = static_cast<float>(i / 4 % size), y = static_cast<float>(i / 4 / size);
        const float phase = static_cast<float>(i % 4) + static_cast<float>(which);
        texture.levels[0].push_back(0.5f + 0.2f * std::sin(0.3926991f * x + phase) +
                                    0.2f * std::cos(0.3926991f * y - phase));
    }
    return texture;
}

// Both stages of a program in the evaluator, and in the interpreter.
class Chain {
  public:
    Chain(const ir::Program& program, const Stages& stages)
        : program_(program),
          stages_(stages),
          vertex_(program.vertex, stages.vertex),
          vertex_evaluator_(program.vertex),
          pixel_evaluator_(program.pixel) {
        for (std::size_t i = 0; i < program.pixel.samplers.size(); ++i)
            textures_.push_back(waves(i));
    }

    // The largest difference of a colour's components, for random vertices.
    double difference(std::mt19937& random, int draw) const {
        VertexValues values = random_values(program_.vertex, random);
        set_special_cases(program_.vertex, values, draw);
        ir::Environment vertex, pixel;
        vertex.inputs = values.attributes;
        vertex.uniforms = values.uniforms;
        // Uniforms of either stage, as both know them.
        std::map<std::string, std::vector<float>> named;
        for (std::size_t i = 0; i < program_.vertex.uniforms.size(); ++i)
            put(named, program_.vertex.uniforms[i], values.uniforms[i]);
        for (const ir::Uniform& uniform : program_.pixel.uniforms) {
            pixel.uniforms.push_back(elements_of(uniform, values, random));
            put(named, uniform, pixel.uniforms.back());
        }
        const ir::Evaluation at = vertex_evaluator_.run(vertex, ir::Precision::Single);
        for (const ir::Declaration& input : program_.pixel.inputs)
            for (std::size_t i = 0; i < program_.vertex.outputs.size(); ++i)
                if (program_.vertex.outputs[i].name == input.name)
                    pixel.inputs.push_back(at.outputs[i]);
        std::map<std::string, const ir::Texture*> maps;
        for (std::size_t i = 0; i < textures_.size(); ++i) {
            pixel.samplers.push_back(&textures_[i]);
            maps[program_.pixel.samplers[i].name] = &textures_[i];
        }
        const ir::Evaluation expected = pixel_evaluator_.run(pixel, ir::Precision::Single);
        const Execution got = shade(vertex_.execute(values, named), named, maps);
        double worst = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const double d =
                std::fabs(expected.outputs[0][k] - static_cast<double>(got.colours[0][k])) /
                std::max(1.0, std::fabs(expected.outputs[0][k]));
            worst = d >= 0 ? std::max(worst, d) : INFINITY;
        }
        return worst;
    }

  private:
    using Elements = std::vector<ir::Environment::Vector>;

    static void put(std::map<std::string, std::vector<float>>& named, const ir::Uniform& uniform,
                    const Elements& elements) {
        std::vector<float>& flat = named[uniform.name];
        flat.clear();
        for (const ir::Environment::Vector& element : elements)
            for (int k = 0; k < uniform.type.width; ++k)
                flat.push_back(static_cast<float>(element[static_cast<std::size_t>(k)]));
    }
    // Of a uniform that both stages know the same values.
    Elements elements_of(const ir::Uniform& uniform, const VertexValues& values,
                         std::mt19937& random) const {
        for (std::size_t i = 0; i < program_.vertex.uniforms.size(); ++i)
            if (program_.vertex.uniforms[i].name == uniform.name) return values.uniforms[i];
        Elements elements(static_cast<std::size_t>(uniform.count));
        for (ir::Environment::Vector& element : elements)
            for (int k = 0; k < uniform.type.width; ++k)
                element[static_cast<std::size_t>(k)] = number(random, 0.1f, 0.9f);
        return elements;
    }

    Execution shade(const Execution& vertex,
                    const std::map<std::string, std::vector<float>>& uniforms,
                    const std::map<std::string, const ir::Texture*>& maps) const {
        Inputs inputs;
        for (int i = 0; i < 8; ++i)
            set_input(stages_.pixel, inputs, Usage::Texcoord, i,
                      output_of(stages_.vertex, vertex, Usage::Texcoord, i));
        const auto environment = environment_of(stages_.pixel, uniforms, maps);
        const auto interpreter = Interpreter::prepare(stages_.pixel);
        EXPECT_TRUE(environment && interpreter);
        return environment && interpreter ? interpreter->run(*environment, inputs, Arithmetic::Fp32)
                                          : Execution{};
    }

    const ir::Program& program_;
    const Stages& stages_;
    VertexDraw vertex_;
    ir::Evaluator vertex_evaluator_, pixel_evaluator_;
    std::vector<ir::Texture> textures_;
};

// The pixel shader on what the vertex shader wrote gives what the two modules give, whatever was
// hoisted or packed between them.
TEST_P(Vertex, FeedsThePixelShader) {
    const std::vector<Case> cases = {
        {"bump", {}},
        {"parallax_occlusion,output=displaced", {{"taps", "3"}}},
        {"parallax_occlusion,output=displaced", {{"taps", "3"}, {"ray_per_vertex", "1"}}},
        {"parallax_occlusion", {{"taps", "8"}, {"ray_per_vertex", "1"}}},
        {"search=none,shadow=march", {{"shadow_min_steps", "3"}, {"shadow_max_steps", "3"}}}};
    for (std::size_t number = 0; number < 2 * cases.size(); ++number) {
        const Case& a_case = cases[number / 2];
        const bool per_vertex = number % 2 == 1;
        SCOPED_TRACE(a_case.name() + (per_vertex ? " per vertex" : ""));
        const Profile pixel = pixel_profile(GetParam());
        auto program = record(a_case, pixel);
        ASSERT_TRUE(program) << to_string(program.error());
        program->per_vertex = per_vertex;
        const auto stages = generate_program(*program, pixel);
        ASSERT_TRUE(stages) << to_string(stages.error());
        EXPECT_EQ(stages->vertex.profile, GetParam());
        EXPECT_TRUE(check(stages->vertex).empty()) << print(stages->vertex);
        for (const Declaration& read : stages->pixel.declarations) {
            if (read.sampler != SamplerKind::None) continue;
            EXPECT_EQ(read.target.mask & ~written(stages->vertex, read.target.index), 0)
                << print(stages->vertex) << print(stages->pixel);
        }
        const Chain chain(*program, *stages);
        std::mt19937 random(seed);
        // At the edge of a hit a pixel may fall to either side.
        int differences = 0;
        for (int i = 0; i < 200; ++i) differences += !(chain.difference(random, i) <= 1e-3);
        EXPECT_LE(differences, 4);
    }
}

// Two interpolants in one register, components in any order.
TEST_P(Vertex, ObeysThePlacesOfInterpolants) {
    const ir::Program program = parsed(R"(
vertex "places"
input position float3 attribute
input first float2 attribute
input second float2 attribute
output clip float4 position
output a float2 interpolant
output b float2 interpolant
output c float3 interpolant
{
    %p float3 = input position
    %x float2 = input first
    %y float2 = input second
    %one float1 = const 1.0
    %clip float4 = compose %p, %one
    %sum float2 = add %x, %y
    %difference float2 = sub %x, %y
    %minus float3 = neg %p
    return (%clip, %sum, %difference, %minus)
})");
    const std::vector<Interpolant> interpolants = {
        {"a", {2, 2, {1, 0, 0, 0}}}, {"b", {2, 2, {3, 2, 0, 0}}}, {"c", {5, 3, {0, 3, 1, 0}}}};
    const auto candidate = vertex_stage(program, program.vertex, interpolants, GetParam());
    ASSERT_TRUE(candidate) << to_string(candidate.error());
    EXPECT_TRUE(check(candidate->shader).empty()) << print(candidate->shader);
    EXPECT_EQ(written(candidate->shader, 2), 0xF);
    EXPECT_EQ(written(candidate->shader, 5), 0xB);
    EXPECT_EQ(written(candidate->shader, 0), 0);
    const VertexDraw draw(program.vertex, candidate->shader);
    std::mt19937 random(seed);
    std::vector<Wired> wires = {{0, {position_output, 4, {0, 1, 2, 3}}}};
    for (std::size_t i = 0; i < 3; ++i) wires.push_back({i + 1, interpolants[i].place});
    for (const auto& [expected, got] : draw.run(random_values(program.vertex, random), wires))
        EXPECT_EQ(expected, got) << print(candidate->shader);
}

// A choice between finite numbers is exact, and a quotient that is guarded may be infinite.
TEST_P(Vertex, ChoosesExactlyAndSafely) {
    const ir::Program program = parsed(R"(
vertex "choice"
input position float4 attribute
output clip float4 position
output plain float1 interpolant
output guarded float1 interpolant
output equal float1 interpolant
{
    %p float4 = input position
    %x float1 = swizzle %p.x
    %y float1 = swizzle %p.y
    %z float1 = swizzle %p.z
    %zero float1 = const 0.0
    %one float1 = const 1.0
    %seven float1 = const 7.0
    %less bool1 = less %x, %zero
    %plain float1 = select %less, %y, %z
    %nonzero bool1 = not_equal %x, %zero
    %quotient float1 = div %one, %x
    %guarded float1 = select %nonzero, %quotient, %seven
    %same bool1 = equal %y, %z
    %either bool1 = or %same, %less
    %not bool1 = not %either
    %equal float1 = select %not, %x, %seven
    return (%p, %plain, %guarded, %equal)
})");
    const Shader shader = generated(program, GetParam());
    const VertexDraw draw(program.vertex, shader);
    const auto wires = wires_of(program, pixel_profile(GetParam()));
    ASSERT_EQ(wires.size(), 4u);
    const float tiny = 1e-30f, small = 1e-20f, large = 1e20f;
    for (const float x : {0.0f, -0.0f, 1.0f, -4.0f, tiny, -tiny})
        for (const float y : {large, -1.0f, 0.0f})
            for (const float z : {3.0f, -1.0f, small})
                for (const auto& [expected, got] : draw.run({{{x, y, z, 1}}, {}}, wires))
                    EXPECT_EQ(expected, got) << fmt::format("{} {} {}\n", x, y, z) << print(shader);
}

TEST_P(Vertex, IsDeterministic) {
    const ir::Program program = random_vertex_program(seed, 20);
    EXPECT_EQ(generated(program, GetParam()), generated(program, GetParam()));
}

TEST_P(Vertex, RefusesWhatIsTooLong) {
    ir::Module module;
    module.name = "long";
    module.stage = ir::Stage::Vertex;
    module.inputs = {{"position", ir::float4, ir::Semantic::Attribute}};
    module.outputs = {{"clip", ir::float4, ir::Semantic::Position}};
    ir::Builder builder(module);
    const ir::ValueId position = builder.input(0);
    ir::ValueId value = position;
    for (int i = 0; i < limits_of(GetParam()).total_slots + 1; ++i)
        value = builder.emit(ir::Op::Add, {builder.emit(ir::Op::Mul, {value, value}), position});
    builder.finish(std::vector{value});
    const auto shader = generate_vertex(vertex_program(module), GetParam());
    ASSERT_FALSE(shader);
    EXPECT_EQ(shader.error().code, "d3d9-limit");
    EXPECT_THAT(shader.error().message, HasSubstr(fmt::format("{} needs", name_of(GetParam()))));
    EXPECT_THAT(shader.error().message, HasSubstr("compute less per vertex"));
}

TEST_P(Vertex, ReadsTexturesOnlyAsItsProfileCan) {
    const auto reading = [](std::string_view read) {
        return parsed(fmt::format(R"(
vertex "reading"
input position float3 attribute
output clip float4 position
output height float1 interpolant
sampler height_map 2d
{{
    %p float3 = input position
    %one float1 = const 1.0
    %clip float4 = compose %p, %one
    %uv float2 = swizzle %p.yx
    %texel float4 = {}
    %height float1 = swizzle %texel.x
    return (%clip, %height)
}})",
                                  read));
    };
    const ir::Program program = reading("sample_level height_map %uv, %one");
    const auto shader = generate_vertex(program, GetParam());
    if (GetParam() == Profile::vs_2_0) {
        ASSERT_FALSE(shader);
        EXPECT_EQ(shader.error().code, "d3d9-texture");
        EXPECT_THAT(shader.error().message, HasSubstr("vs_2_0 cannot read height_map"));
        return;
    }
    ASSERT_TRUE(shader) << to_string(shader.error());
    EXPECT_TRUE(check(*shader).empty()) << print(*shader);
    EXPECT_THAT(print(*shader), HasSubstr("texldl"));
}

TEST(VertexProfiles, RefusesThoseOfPixelShaders) {
    const auto shader = generate_vertex(random_vertex_program(seed, 3), Profile::ps_2_0);
    ASSERT_FALSE(shader);
    EXPECT_EQ(shader.error().code, "d3d9-stage");
}

}  // namespace
}  // namespace intaglio::d3d9

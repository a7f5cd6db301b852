// Moving affine functions to the vertex stage: a triangle's pixel computes the same from what its
// three vertices hand over, up to rounding; limits and consent are obeyed.
#include <gtest/gtest.h>

#include "generator/ir/builder.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/hoist_to_vertex.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/remove_unused_interpolants.h"
#include "generator/passes/rewrite.h"
#include "tests/rounds.h"
#include "tests/unit/passes/environment.h"

namespace intaglio::passes {
namespace {

using namespace testing;
using namespace ir;

// The vertex stage hands three attributes over as they are; nobody reads `spare`.
Module pass_through() {
    Module vertex;
    vertex.stage = Stage::Vertex;
    Builder builder(vertex);
    std::vector<ValueId> values;
    for (const char* name : {"p", "q", "r", "spare"}) {
        vertex.inputs.push_back({std::string("in_") + name, float3, Semantic::Attribute});
        vertex.outputs.push_back({name, float3, Semantic::Interpolant});
        values.push_back(builder.input(static_cast<int>(values.size())));
    }
    builder.finish(values);
    return vertex;
}

// A pixel stage of random affine arithmetic, then some that is not affine.
Module random_pixel(Random& random) {
    Module pixel;
    pixel.outputs = {{"colour", float3, Semantic::Target}, {"more", float3, Semantic::Target}};
    pixel.uniforms = {{"scale", float3, 1, ""}, {"offset", float3, 2, ""}};
    Builder builder(pixel);
    std::vector<ValueId> values, constants;
    for (const char* name : {"p", "q", "r"}) {
        pixel.inputs.push_back({name, float3, Semantic::Interpolant});
        values.push_back(builder.input(static_cast<int>(values.size())));
    }
    const auto pick = [&](const std::vector<ValueId>& from) {
        return from[static_cast<std::size_t>(random.below(static_cast<int>(from.size())))];
    };
    constants = {builder.uniform(0), builder.uniform(1, 1)};
    constants.push_back(builder.emit(Op::Mul, {constants[0], constants[1]}));
    for (int i = random.between(2, 12); i > 0; --i) {
        const ValueId value = pick(values);
        switch (random.below(8)) {
            case 0: values.push_back(builder.emit(Op::Add, {value, pick(values)})); break;
            case 1: values.push_back(builder.emit(Op::Sub, {pick(constants), value})); break;
            case 2: values.push_back(builder.emit(Op::Mul, {pick(constants), value})); break;
            case 3: values.push_back(builder.emit(Op::Div, {value, pick(constants)})); break;
            case 4: values.push_back(builder.swizzle(value, "zxy")); break;
            case 5:
                values.push_back(builder.emit(Op::Lerp, {value, pick(values), pick(constants)}));
                break;
            case 7: {  // not affine, whatever it is applied to
                constexpr Op ops[] = {Op::Max, Op::Min, Op::Mul, Op::Div, Op::Cross};
                const ValueId constant = pick(constants);
                const bool first = random.chance(50);
                values.push_back(builder.emit(
                    ops[random.below(5)], {first ? constant : value, first ? value : constant}));
                break;
            }
            case 6: {
                const ValueId dot = builder.emit(Op::Dot, {value, pick(constants)});
                values.push_back(builder.compose(std::array{dot, builder.swizzle(value, "yx")}));
                break;
            }
        }
    }
    const ValueId product = builder.emit(Op::Mul, {pick(values), pick(values)});
    const ValueId chosen = builder.emit(Op::Max, {product, pick(values)});
    builder.finish(std::array{chosen, values.back()});
    return pixel;
}

Program random_program(Random& random) {
    Program program;
    program.per_vertex = true;
    program.vertex = pass_through();
    program.pixel = random_pixel(random);
    return program;
}

// The colour of the point with these weights in a triangle.
Evaluation shade(const Program& program, const std::array<Environment, 3>& vertices,
                 const std::vector<Environment::Vector>& uniforms,
                 const std::array<double, 3>& weights) {
    const auto bind_uniforms = [&](const Module& module, Environment& environment) {
        for (const Uniform& uniform : module.uniforms)
            environment.uniforms.push_back(uniform.name == "scale"
                                               ? std::vector{uniforms[0]}
                                               : std::vector{uniforms[1], uniforms[2]});
    };
    Environment pixel;
    bind_uniforms(program.pixel, pixel);
    const Evaluator evaluator(program.vertex);
    pixel.inputs.resize(program.pixel.inputs.size());
    for (std::size_t corner = 0; corner < 3; ++corner) {
        Environment vertex;
        for (const Declaration& input : program.vertex.inputs)
            vertex.inputs.push_back(
                vertices[corner].inputs[std::string("pqrs").find(input.name[3])]);
        bind_uniforms(program.vertex, vertex);
        const Evaluation outputs = evaluator.run(vertex, Precision::Double);
        for (std::size_t i = 0; i < program.pixel.inputs.size(); ++i) {
            std::size_t slot = 0;
            while (program.vertex.outputs[slot].name != program.pixel.inputs[i].name) ++slot;
            for (std::size_t k = 0; k < 4; ++k)
                pixel.inputs[i][k] += weights[corner] * outputs.outputs[slot][k];
        }
    }
    return Evaluator(program.pixel).run(pixel, Precision::Double);
}

// Values between 0.5 and 2, so that quotients stay small.
Environment::Vector tame_vector(Random& random) {
    Environment::Vector vector{};
    for (double& component : vector) component = 0.5 + 1.5 * static_cast<double>(random.unit());
    return vector;
}

// In binary64 both ways agree to some 1e-16 for each of at most 40 operations on values below 2^12
// or so: 1e-9 of the larger one tells rounding from mistakes.
void expect_same_picture(const Program& before, const Program& after, Random& random) {
    for (int i = 0; i < 10; ++i) {
        std::array<Environment, 3> vertices;
        for (Environment& vertex : vertices)
            for (int k = 0; k < 4; ++k) vertex.inputs.push_back(tame_vector(random));
        const std::vector<Environment::Vector> uniforms = {tame_vector(random), tame_vector(random),
                                                           tame_vector(random)};
        const double u = static_cast<double>(random.unit()),
                     v = static_cast<double>(random.unit()) * (1 - u);
        const Evaluation a = shade(before, vertices, uniforms, {u, v, 1 - u - v});
        const Evaluation b = shade(after, vertices, uniforms, {u, v, 1 - u - v});
        for (std::size_t output = 0; output < 2; ++output)
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_NEAR(a.outputs[output][k], b.outputs[output][k],
                            1e-9 * std::max(1.0, std::fabs(a.outputs[output][k])))
                    << print(before.pixel) << print(after.vertex) << print(after.pixel);
    }
}

int interpolated_components(const Module& pixel) {
    int components = 0;
    for (const Declaration& input : pixel.inputs) components += input.type.width;
    return components;
}

TEST(HoistToVertex, KeepsThePicture) {
    std::size_t moved = 0;
    for (std::uint64_t seed = 1; seed <= rounds(400u); ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        Random random(seed);
        const Program before = random_program(random);
        Program after = before;
        moved += hoist_to_vertex(after).size();
        for (const Module* module : {&after.vertex, &after.pixel}) {
            const Status status = verify(*module);
            ASSERT_TRUE(status.ok()) << to_string(status.error()) << print(*module);
        }
        expect_same_picture(before, after, random);
        if (HasFatalFailure()) return;
        EXPECT_TRUE(hoist_to_vertex(after).empty()) << "what can move has moved";

        Program optimized = before;
        ASSERT_TRUE(optimize_program(optimized, {.verify_each = true}).ok());
        expect_same_picture(before, optimized, random);
        if (HasFatalFailure()) return;
        Program again = optimized;
        ASSERT_TRUE(optimize_program(again, {}).ok());
        EXPECT_EQ(print(again.pixel), print(optimized.pixel));
        EXPECT_EQ(print(again.vertex), print(optimized.vertex));
    }
    EXPECT_GT(moved, rounds(300u)) << "hardly anything moved: the test shows little";
}

TEST(HoistToVertex, ObeysTheLimits) {
    for (std::uint64_t seed = 1; seed <= rounds(100u); ++seed)
        for (const InterpolantLimits& limits :
             {InterpolantLimits{3, 32}, InterpolantLimits{8, 9}}) {
            Random random(seed);
            Program program = random_program(random);
            hoist_to_vertex(program, limits);
            remove_unused_interpolants(program);
            EXPECT_LE(static_cast<int>(program.pixel.inputs.size()), limits.count)
                << "seed " << seed;
            EXPECT_LE(interpolated_components(program.pixel), limits.components) << "seed " << seed;
        }
}

TEST(HoistToVertex, NeedsConsent) {
    Random random(3);
    Program program = random_program(random);
    program.per_vertex = false;
    const Module vertex = program.vertex, pixel = program.pixel;
    EXPECT_TRUE(hoist_to_vertex(program).empty());
    EXPECT_TRUE(program.vertex == vertex && program.pixel == pixel);
}

TEST(HoistToVertex, SaysWhyItCannot) {
    Random random(3);
    Program program = random_program(random);
    program.vertex.uniforms.push_back({"scale", float1, 1, ""});
    EXPECT_EQ(
        hoist_to_vertex(program),
        std::vector<std::string>{
            "nothing is computed per vertex: the stages declare uniform 'scale' differently"});
}

TEST(RemoveUnusedInterpolants, KeepsThePicture) {
    for (std::uint64_t seed = 1; seed <= rounds(100u); ++seed) {
        Random random(seed);
        const Program before = random_program(random);
        Program after = before;
        remove_unused_interpolants(after);
        ASSERT_TRUE(verify(after.vertex).ok() && verify(after.pixel).ok());
        EXPECT_EQ(after.vertex.outputs.size(), after.pixel.inputs.size());
        for (const Declaration& output : after.vertex.outputs) EXPECT_NE(output.name, "spare");
        expect_same_picture(before, after, random);
    }
}

}  // namespace
}  // namespace intaglio::passes

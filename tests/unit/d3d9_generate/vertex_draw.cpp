// Values by slot to the evaluator, by usage and name to the interpreter.
#include "tests/unit/d3d9_generate/vertex_draw.h"

#include <gtest/gtest.h>

#include "generator/passes/pipeline.h"
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/generate/vertex.h"

namespace intaglio::d3d9 {
namespace {

Shader through_bytes(const Shader& shader) {
    const auto decoded = decode(encode(shader));
    EXPECT_TRUE(decoded) << (decoded ? "" : decoded.error().message);
    return decoded ? *decoded : shader;
}

}  // namespace

VertexDraw::VertexDraw(const ir::Module& vertex, const Shader& shader)
    : module_(vertex), shader_(through_bytes(shader)), evaluator_(module_) {}

Execution VertexDraw::execute(const VertexValues& values,
                              std::map<std::string, std::vector<float>> uniforms) const {
    Inputs inputs;
    const std::vector<AttributeUsage> usages = attribute_usages(module_);
    for (std::size_t i = 0; i < usages.size(); ++i) {
        Vector value{};
        for (std::size_t k = 0; k < 4; ++k) value[k] = static_cast<float>(values.attributes[i][k]);
        set_input(shader_, inputs, usages[i].usage, usages[i].index, value);
    }
    const bool by_slot = uniforms.empty();
    for (std::size_t i = 0; by_slot && i < module_.uniforms.size(); ++i)
        for (const ir::Environment::Vector& element : values.uniforms[i])
            for (int k = 0; k < module_.uniforms[i].type.width; ++k)
                uniforms[module_.uniforms[i].name].push_back(
                    static_cast<float>(element[static_cast<std::size_t>(k)]));
    const auto environment = environment_of(shader_, uniforms, {});
    EXPECT_TRUE(environment) << (environment ? "" : environment.error().message);
    const auto interpreter = Interpreter::prepare(shader_);
    EXPECT_TRUE(interpreter) << (interpreter ? "" : interpreter.error().message);
    if (!environment || !interpreter) return {};
    return interpreter->run(*environment, inputs, Arithmetic::Fp32);
}

std::vector<VertexDraw::Pair> VertexDraw::run(const VertexValues& values,
                                              const std::vector<Wired>& wires,
                                              ir::Precision precision) const {
    ir::Environment environment;
    environment.inputs = values.attributes;
    environment.uniforms = values.uniforms;
    const ir::Evaluation expected = evaluator_.run(environment, precision);
    const Execution got = execute(values);
    std::vector<Pair> pairs;
    for (const Wired& wire : wires) {
        const bool position = wire.place.index == position_output;
        const Vector value = output_of(shader_, got, position ? Usage::Position : Usage::Texcoord,
                                       position ? 0 : wire.place.index);
        for (int k = 0; k < module_.outputs[wire.output].type.width; ++k) {
            const auto c = static_cast<std::size_t>(k);
            pairs.push_back(
                {expected.outputs[wire.output][c],
                 static_cast<double>(value[static_cast<std::size_t>(wire.place.lanes[c])])});
        }
    }
    return pairs;
}

std::vector<Wired> wires_of(const ir::Program& program, Profile pixel) {
    std::vector<Wired> wires;
    ir::Program optimised = program;
    passes::PipelineOptions options;
    options.unroll_all = options.flatten_all = true;
    EXPECT_TRUE(passes::optimize_program(optimised, options));
    const auto places = interpolant_places(optimised.pixel, pixel);
    for (std::size_t i = 0; i < program.vertex.outputs.size(); ++i) {
        const ir::Declaration& output = program.vertex.outputs[i];
        if (output.semantic == ir::Semantic::Position)
            wires.push_back({i, {position_output, 4, {0, 1, 2, 3}}});
        for (std::size_t k = 0; k < places.size(); ++k)
            if (output.semantic == ir::Semantic::Interpolant &&
                optimised.pixel.inputs[k].name == output.name)
                wires.push_back({i, places[k]});
    }
    return wires;
}

}  // namespace intaglio::d3d9

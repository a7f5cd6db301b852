// IR to pixels by the evaluator.
#include "src/measure/evaluated.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "generator/passes/pipeline.h"
#include "src/measure/rows.h"

namespace intaglio::measure {
namespace {

using Vector = ir::Environment::Vector;
using Uniforms = std::map<std::string, std::vector<float>>;

// The uniforms of a module from values by name; elements lie one after the other.
std::vector<std::vector<Vector>> uniforms_for(const ir::Module& module, const Uniforms& values) {
    std::vector<std::vector<Vector>> uniforms;
    for (const ir::Uniform& uniform : module.uniforms) {
        const std::vector<float>& given = values.at(uniform.name);
        std::vector<Vector> elements(static_cast<std::size_t>(uniform.count));
        const auto width = static_cast<std::size_t>(uniform.type.width);
        for (std::size_t i = 0; i < given.size() && i < width * elements.size(); ++i)
            elements[i / width][i % width] = static_cast<double>(given[i]);
        uniforms.push_back(std::move(elements));
    }
    return uniforms;
}

Status check_uniforms(const ir::Module& module, const Uniforms& known) {
    for (const ir::Uniform& uniform : module.uniforms)
        if (!known.contains(uniform.name))
            return input_error("missing-uniform",
                               fmt::format("the uniform '{}' has no value", uniform.name));
    return Done{};
}

}  // namespace

vulkan::Picture EvaluatedPicture::picture() const {
    vulkan::Picture rounded{width, height, std::vector<std::array<float, 4>>(pixels.size())};
    for (std::size_t i = 0; i < pixels.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) rounded.pixels[i][c] = static_cast<float>(pixels[i][c]);
    return rounded;
}

EvaluatedQuad::EvaluatedQuad(ir::Program program)
    : program_(std::move(program)), vertex_(program_.vertex), pixel_(program_.pixel) {}

Status EvaluatedQuad::add_textures(const Variant& variant, const Textures& textures) {
    const TextureReading reading = reading_of(variant);
    for (const ir::Module* module : {&program_.vertex, &program_.pixel})
        for (const ir::Sampler& sampler : module->samplers) {
            const std::string& name = sampler.name;
            Result<std::optional<ir::Texture>> texture = evaluator_texture(textures, reading, name);
            if (!texture) return texture.error();
            if (!*texture)
                return input_error("missing-texture", fmt::format("there is no map '{}'", name));
            std::array<ir::Texture, 2>& both = textures_[name];
            both.fill(std::move(**texture));
            both[0].weights = ir::Texture::Weights::Exact;
            both[1].weights = ir::Texture::Weights::EightBit;
        }
    return Done{};
}

Result<EvaluatedQuad> EvaluatedQuad::prepare(const Variant& variant, const Textures& textures,
                                             double scale, int width, int height,
                                             const Look& look) {
    ir::Program program = variant.program;
    const auto notes = passes::optimize_program(program, {});
    if (!notes) return notes.error();
    EvaluatedQuad quad(std::move(program));
    if (Status status = quad.add_textures(variant, textures); !status) return status.error();
    quad.look_ = look;
    quad.scale_ = scale;
    quad.width_ = width;
    quad.height_ = height;
    quad.map_width_ = textures.height.width;
    quad.map_height_ = textures.height.height;
    const Uniforms known = uniforms_of({}, {}, scale, quad.map_width_, quad.map_height_, look);
    for (const ir::Module* module : {&quad.program_.vertex, &quad.program_.pixel})
        if (Status status = check_uniforms(*module, known); !status) return status.error();
    return quad;
}

std::vector<Vector> EvaluatedQuad::inputs_at(ir::Environment& vertex, double x, double y,
                                             ir::Precision precision) const {
    const double u = x / width_, v = y / height_;
    // The attributes of vulkan::quad().
    vertex.inputs.clear();
    for (const ir::Declaration& input : program_.vertex.inputs)
        vertex.inputs.push_back(input.name == "normal"    ? Vector{0, 0, 1, 0}
                                : input.name == "tangent" ? Vector{1, 0, 0, 1}
                                                          : Vector{u, v, 0, 0});
    const ir::Evaluation done =
        vertex_.run(vertex, precision == ir::Precision::Double ? precision : ir::Precision::Single);
    std::vector<Vector> inputs;
    for (const ir::Declaration& input : program_.pixel.inputs)
        for (std::size_t i = 0; i < program_.vertex.outputs.size(); ++i)
            if (program_.vertex.outputs[i].name == input.name) inputs.push_back(done.outputs[i]);
    return inputs;
}

EvaluatedPicture EvaluatedQuad::draw(Direction view, Direction light, ir::Precision precision,
                                     ir::Texture::Weights weights, int threads) const {
    const Uniforms values = uniforms_of(view, light, scale_, map_width_, map_height_, look_);
    ir::Environment vertex, pixel;
    vertex.uniforms = uniforms_for(program_.vertex, values);
    pixel.uniforms = uniforms_for(program_.pixel, values);
    const std::size_t set = weights == ir::Texture::Weights::Exact ? 0 : 1;
    for (const ir::Sampler& sampler : program_.vertex.samplers)
        vertex.samplers.push_back(&textures_.at(sampler.name)[set]);
    for (const ir::Sampler& sampler : program_.pixel.samplers)
        pixel.samplers.push_back(&textures_.at(sampler.name)[set]);

    const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    EvaluatedPicture result{width_, height_, std::vector<std::array<double, 4>>(pixels)};
    std::vector<long> reads(pixels), instructions(pixels);
    for_each_row(height_, threads, [&](int y) {
        ir::Environment at_vertex = vertex, at_pixel = pixel;
        for (int x = 0; x < width_; ++x) {
            at_pixel.inputs = inputs_at(at_vertex, x + 0.5, y + 0.5, precision);
            const ir::Evaluation done = pixel_.run(at_pixel, precision);
            const auto at = static_cast<std::size_t>(y * width_ + x);
            result.pixels[at] = done.outputs[0];
            reads[at] = done.texture_reads;
            instructions[at] = done.instructions;
        }
    });
    const auto mean = [&](const std::vector<long>& counts) {
        return std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(pixels);
    };
    result.reads_mean = mean(reads);
    result.reads_max = *std::max_element(reads.begin(), reads.end());
    result.instructions_mean = mean(instructions);
    result.instructions_max = *std::max_element(instructions.begin(), instructions.end());
    return result;
}

bool EvaluatedQuad::sees_light() const {
    return std::any_of(program_.pixel.inputs.begin(), program_.pixel.inputs.end(),
                       [](const ir::Declaration& input) { return input.name == "to_light"; });
}

}  // namespace intaglio::measure

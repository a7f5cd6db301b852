// Bytes to pixels by the interpreter.
#include "src/measure/interpreted.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>

#include <fmt/format.h>

#include "src/measure/rows.h"

namespace intaglio::measure {
namespace {

// The textures that a shader names.
std::vector<std::string> textures_in(const d3d9::Shader& shader) {
    std::vector<std::string> names;
    for (const d3d9::Constant& constant : shader.constants)
        if (constant.set == d3d9::Constant::Set::Sampler) names.push_back(constant.name);
    return names;
}

}  // namespace

Status InterpretedQuad::add_textures(const Variant& variant, const Textures& textures) {
    const TextureReading reading = reading_of(variant);
    for (const d3d9::Shader* shader : {&vertex_, &pixel_})
        for (const std::string& name : textures_in(*shader)) {
            Result<std::optional<ir::Texture>> texture = evaluator_texture(textures, reading, name);
            if (!texture) return texture.error();
            // A name that nobody has stays missing: environment_of says so.
            if (*texture) textures_.try_emplace(name, std::move(**texture));
        }
    return Done{};
}

Result<InterpretedQuad> InterpretedQuad::prepare(const Variant& variant, const Textures& textures,
                                                 double scale, int width, int height,
                                                 const Look& look) {
    if (variant.vertex.bytecode.bytes.empty() || variant.pixel.bytecode.bytes.empty() ||
        !profile_of(*variant.target))
        return input_error("not-interpreted",
                           fmt::format("{} has no Direct3D 9 bytecode of both stages; take ps_2_0, "
                                       "ps_2_a, ps_2_b or ps_3_0",
                                       variant.target->name));
    Result<d3d9::Shader> vertex = decode_stage(variant, ir::Stage::Vertex);
    if (!vertex) return vertex.error();
    Result<d3d9::Shader> pixel = decode_stage(variant, ir::Stage::Pixel);
    if (!pixel) return pixel.error();
    Result<d3d9::Interpreter> run_vertex = d3d9::Interpreter::prepare(*vertex);
    if (!run_vertex) return run_vertex.error();
    Result<d3d9::Interpreter> run_pixel = d3d9::Interpreter::prepare(*pixel);
    if (!run_pixel) return run_pixel.error();
    InterpretedQuad quad(std::move(*vertex), std::move(*pixel), std::move(*run_vertex),
                         std::move(*run_pixel));
    if (Status status = quad.add_textures(variant, textures); !status) return status.error();
    for (const d3d9::Declaration& declaration : quad.pixel_.declarations) {
        const d3d9::File file = declaration.target.file;
        if (quad.pixel_.profile == d3d9::Profile::ps_3_0) {
            if (file == d3d9::File::Input)
                quad.links_.push_back({declaration.usage, declaration.usage_index});
        } else if (file == d3d9::File::Texture || file == d3d9::File::Input) {
            quad.links_.push_back(
                {file == d3d9::File::Texture ? d3d9::Usage::Texcoord : d3d9::Usage::Color,
                 declaration.target.index});
        }
    }
    quad.look_ = look;
    quad.scale_ = scale;
    quad.width_ = width;
    quad.height_ = height;
    quad.map_width_ = textures.height.width;
    quad.map_height_ = textures.height.height;
    return quad;
}

Result<InterpretedQuad> InterpretedQuad::with_partial_precision() const {
    InterpretedQuad half = *this;
    for (d3d9::Instruction& instruction : half.pixel_.instructions)
        if (instruction.destination) instruction.destination->partial_precision = true;
    Result<d3d9::Interpreter> run_pixel = d3d9::Interpreter::prepare(half.pixel_);
    if (!run_pixel) return run_pixel.error();
    half.run_pixel_ = std::move(*run_pixel);
    return half;
}

InterpretedQuad InterpretedQuad::with_weights(ir::Texture::Weights weights) const {
    InterpretedQuad other = *this;
    for (auto& [name, texture] : other.textures_) texture.weights = weights;
    return other;
}

d3d9::Inputs InterpretedQuad::inputs_of(const d3d9::Environment& environment, int x, int y) const {
    const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(width_);
    const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(height_);
    // The attributes of vulkan::quad(), with Direct3D's 0 and 1 for components that are not there.
    d3d9::Inputs vertex;
    d3d9::set_input(vertex_, vertex, d3d9::Usage::Position, 0, {u, v, 0, 1});
    d3d9::set_input(vertex_, vertex, d3d9::Usage::Normal, 0, {0, 0, 1, 1});
    d3d9::set_input(vertex_, vertex, d3d9::Usage::Tangent, 0, {1, 0, 0, 1});
    d3d9::set_input(vertex_, vertex, d3d9::Usage::Texcoord, 0, {u, v, 0, 1});
    const d3d9::Execution done = run_vertex_.run(environment, vertex, d3d9::Arithmetic::Fp32);
    d3d9::Inputs pixel;
    for (const Link& link : links_)
        d3d9::set_input(pixel_, pixel, link.usage, link.index,
                        d3d9::output_of(vertex_, done, link.usage, link.index));
    pixel.position = {static_cast<float>(x), static_cast<float>(y), 0, 0};
    return pixel;
}

Result<InterpretedPicture> InterpretedQuad::draw(Direction view, Direction light,
                                                 d3d9::Arithmetic arithmetic, int threads) const {
    const auto uniforms = uniforms_of(view, light, scale_, map_width_, map_height_, look_);
    std::map<std::string, const ir::Texture*> textures;
    for (const auto& [name, texture] : textures_) textures[name] = &texture;
    const Result<d3d9::Environment> for_vertex = environment_of(vertex_, uniforms, textures);
    if (!for_vertex) return for_vertex.error();
    const Result<d3d9::Environment> for_pixel = environment_of(pixel_, uniforms, textures);
    if (!for_pixel) return for_pixel.error();

    InterpretedPicture result;
    const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    result.picture = {width_, height_, std::vector<std::array<float, 4>>(pixels)};
    std::vector<int> reads(pixels);
    std::vector<long> instructions(pixels);
    std::atomic<bool> complete = true;
    for_each_row((height_ + 1) / 2, threads, [&](int pair) {
        const int y = 2 * pair;
        for (int x = 0; x < width_ && complete; x += 2) {
            std::array<d3d9::Inputs, 4> inputs;
            for (int i = 0; i < 4; ++i)
                inputs[static_cast<std::size_t>(i)] = inputs_of(*for_vertex, x + i % 2, y + i / 2);
            const auto quad = run_pixel_.run_quad(*for_pixel, inputs, arithmetic);
            for (int i = 0; i < 4; ++i) {
                // An odd size has half a quad at its edge.
                if (x + i % 2 >= width_ || y + i / 2 >= height_) continue;
                const d3d9::Execution& done = quad[static_cast<std::size_t>(i)];
                const auto at = static_cast<std::size_t>((y + i / 2) * width_ + x + i % 2);
                if (!done.complete) complete = false;
                if (!done.killed) result.picture.pixels[at] = done.colours[0];
                reads[at] = done.texture_reads;
                instructions[at] = done.instructions;
            }
        }
    });
    if (!complete)
        return input_error("endless-shader",
                           "the pixel shader was stopped: its loops do not come to an end");
    const auto mean = [&](const auto& counts) {
        return std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(pixels);
    };
    result.reads_mean = mean(reads);
    result.reads_max = *std::max_element(reads.begin(), reads.end());
    result.instructions_mean = mean(instructions);
    result.instructions_max = *std::max_element(instructions.begin(), instructions.end());
    return result;
}

}  // namespace intaglio::measure

// Names to values, once; a place is the inputs of a pixel and of its neighbours.
#include "src/measure/lone_pixel.h"

#include <algorithm>

#include <fmt/format.h>

namespace intaglio::measure {

Result<LonePixel> LonePixel::prepare(const dsl::Catalogue& catalogue, const VariantRequest& request,
                                     const Textures& textures, double scale) {
    Result<Recorded> recorded = record_variant(catalogue, request);
    if (!recorded) return recorded.error();
    auto stage = std::make_unique<Stage>(std::move(recorded->program.pixel));
    const auto values = uniforms_of({}, {}, scale, textures.height.width, textures.height.height);
    for (const ir::Uniform& uniform : stage->module.uniforms) {
        std::vector<Vector> elements(static_cast<std::size_t>(uniform.count));
        const std::vector<float>& given = values.at(uniform.name);
        const auto width = static_cast<std::size_t>(uniform.type.width);
        for (std::size_t i = 0; i < std::min(given.size(), width * elements.size()); ++i)
            elements[i / width][i % width] = static_cast<double>(given[i]);
        stage->uniforms.push_back(std::move(elements));
    }
    for (const ir::Sampler& sampler : stage->module.samplers) {
        Result<std::optional<ir::Texture>> map = evaluator_texture(textures, {}, sampler.name);
        if (!map) return map.error();
        if (!*map)
            return input_error("missing-texture",
                               fmt::format("there is no map '{}'", sampler.name));
        stage->maps.push_back(std::move(**map));
    }
    return LonePixel(std::move(stage));
}

LonePixel::Vector LonePixel::at(std::array<double, 2> uv, std::array<double, 3> eye,
                                std::array<double, 3> light, double pixel,
                                ir::Precision precision) const {
    ir::Environment environment;
    environment.uniforms = stage_->uniforms;
    for (const ir::Texture& map : stage_->maps) environment.samplers.push_back(&map);
    const auto give = [&](std::vector<Vector>& inputs, double u, double v) {
        for (const ir::Declaration& input : stage_->module.inputs)
            inputs.push_back(input.name == "uv"       ? Vector{u, v}
                             : input.name == "to_eye" ? Vector{eye[0], eye[1], eye[2]}
                                                      : Vector{light[0], light[1], light[2]});
    };
    give(environment.inputs, uv[0], uv[1]);
    give(environment.right_inputs, uv[0] + pixel, uv[1]);
    give(environment.lower_inputs, uv[0], uv[1] + pixel);
    return stage_->run.run(environment, precision).outputs[0];
}

}  // namespace intaglio::measure

// Draws from shaders, maps and directions.
#include "src/measure/render.h"

#include <map>

#include "src/check/reflect.h"
#include "src/variant/variant.h"

namespace intaglio::measure {
namespace {

// Textures that a draw wants otherwise than they are.
using Copies = std::map<std::string, vulkan::Texture>;

vulkan::Draw base_draw(const check::Program& shaders, const Textures& textures, int width,
                       int height, const PassLink& link, Copies& copies) {
    vulkan::Draw draw;
    // link_to_spirv names every entry point main, whatever the text called it.
    draw.vertex.spirv = shaders.vertex;
    draw.fragment.spirv = shaders.pixel;
    draw.textures = {{"height_map", &textures.height},
                     {"normal_map", &textures.normal},
                     {"colour_map", &textures.colour}};
    for (const std::string& name : shaders.one_level) {
        const auto found = draw.textures.find(name);
        if (found == draw.textures.end()) continue;
        vulkan::Texture& copy = copies[name] = *found->second;
        copy.levels.resize(1);
        found->second = &copy;
    }
    draw.nearest = shaders.nearest;
    if (link.before) draw.textures["displaced_map"] = link.before;
    draw.width = width;
    draw.height = height;
    draw.target_format = link.target;
    return draw;
}

// The baked maps that the stages read and nobody gave.
Status add_baked(vulkan::Draw& draw, const check::Program& shaders, const Textures& textures) {
    for (const vulkan::Stage* stage : {&draw.vertex, &draw.fragment}) {
        const Result<check::Reflection> reflection = check::reflect(stage->spirv);
        if (!reflection) return reflection.error();
        for (const check::Reflection::Image& image : reflection->images) {
            if (draw.textures.contains(image.name)) continue;
            const auto settings = shaders.baked.find(image.name);
            const Result<const vulkan::Texture*> map = textures.baked->texture(
                image.name, settings == shaders.baked.end() ? "" : settings->second);
            if (!map) return map.error();
            if (*map != nullptr) draw.textures[image.name] = *map;
        }
    }
    return Done{};
}

}  // namespace

ir::Texture evaluator_texture(const vulkan::Texture& from, bool one_level, bool nearest) {
    const auto filter_of = [&](vulkan::Texture::Filter filter) {
        return nearest || filter == vulkan::Texture::Filter::Nearest ? ir::Texture::Filter::Nearest
                                                                     : ir::Texture::Filter::Linear;
    };
    ir::Texture made;
    made.width = from.width;
    made.height = from.height;
    made.depth = std::max(1, from.depth);
    made.filter = filter_of(from.filter);
    made.mip_filter = filter_of(from.mip_filter);
    made.wrap = from.wrap == vulkan::Texture::Wrap::Repeat ? ir::Texture::Wrap::Repeat
                                                           : ir::Texture::Wrap::Clamp;
    if (from.format == vulkan::Texture::Format::Rgba8Unorm)
        made.weights = ir::Texture::Weights::EightBit;
    for (const std::vector<float>& level : from.levels) {
        made.levels.push_back(vulkan::decode(vulkan::encode(level, from.format), from.format));
        if (one_level) break;
    }
    return made;
}

Result<std::optional<ir::Texture>> evaluator_texture(const Textures& textures,
                                                     const TextureReading& reading,
                                                     const std::string& name) {
    const bool nearest = reading.nearest.contains(name);
    for (const auto& [own, texture] :
         {std::pair{"height_map", &textures.height}, std::pair{"normal_map", &textures.normal},
          std::pair{"colour_map", &textures.colour}})
        if (name == own)
            return std::optional(
                evaluator_texture(*texture, reading.one_level.contains(name), nearest));
    const auto settings = reading.baked.find(name);
    const Result<const vulkan::Texture*> baked =
        textures.baked->texture(name, settings == reading.baked.end() ? "" : settings->second);
    if (!baked) return baked.error();
    if (*baked == nullptr) return std::optional<ir::Texture>();
    return std::optional(evaluator_texture(**baked, false, nearest));
}

Result<vulkan::Program> prepare_quad(const vulkan::Device& device, const check::Program& shaders,
                                     const Textures& textures, double scale, int width, int height,
                                     const Look& look, const PassLink& link) {
    return prepare_flat(device, shaders, textures, vulkan::quad(), scale, width, height, look,
                        link);
}

Result<vulkan::Program> prepare_flat(const vulkan::Device& device, const check::Program& shaders,
                                     const Textures& textures, const vulkan::Mesh& mesh,
                                     double scale, int width, int height, const Look& look,
                                     const PassLink& link) {
    Copies copies;
    vulkan::Draw draw = base_draw(shaders, textures, width, height, link, copies);
    if (Status status = add_baked(draw, shaders, textures); !status) return status.error();
    draw.mesh = &mesh;
    draw.uniforms = uniforms_of({}, {}, scale, textures.height.width, textures.height.height, look);
    draw.uniforms.insert(link.uniforms.begin(), link.uniforms.end());
    return vulkan::Program::prepare(device, draw);
}

Status aim(vulkan::Program& program, Direction view, Direction light) {
    const std::array<float, 3> v = vector_of(view);
    const std::array<float, 3> l = vector_of(light);
    if (Status status = program.set_uniform("eye", {v[0], v[1], v[2], 0}); !status) return status;
    return program.set_uniform("light", {l[0], l[1], l[2], 0});
}

Result<vulkan::Program> prepare_mesh(const vulkan::Device& device, const check::Program& shaders,
                                     const Textures& textures, double scale, int width, int height,
                                     const MeshView& view, const Look& look, const PassLink& link) {
    Copies copies;
    vulkan::Draw draw = base_draw(shaders, textures, width, height, link, copies);
    if (Status status = add_baked(draw, shaders, textures); !status) return status.error();
    draw.mesh = &view.mesh;
    draw.uniforms = uniforms_of({}, {}, scale, textures.height.width, textures.height.height, look);
    draw.uniforms.insert(link.uniforms.begin(), link.uniforms.end());
    draw.uniforms["view_projection"] = {view.camera.view_projection.begin(),
                                        view.camera.view_projection.end()};
    draw.uniforms["eye"] = {view.camera.eye[0], view.camera.eye[1], view.camera.eye[2], 1};
    draw.uniforms["light"] = {view.light[0], view.light[1], view.light[2], 0};
    draw.depth_test = true;
    draw.clear = mesh_background;
    return vulkan::Program::prepare(device, draw);
}

}  // namespace intaglio::measure

// A variant with maps, ready to be drawn by the runner: names to values, in one place for pictures
// and measurements.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/ir/texture.h"
#include "src/check/frontend.h"
#include "src/measure/baked_maps.h"
#include "src/measure/map_set.h"
#include "src/measure/view.h"
#include "src/vulkan/camera.h"
#include "src/vulkan/program.h"

namespace intaglio {
struct TextureReading;
}

namespace intaglio::measure {

// The textures of one map set, uploaded with every program that reads them.  What techniques want
// baked is baked when the first program reads it.
struct Textures {
    vulkan::Texture height, normal, colour;
    std::shared_ptr<BakedMaps> baked;

    Textures(const MapSet& set, Filtering filtering)
        : height(height_texture(set, filtering)),
          normal(normal_texture(set, filtering)),
          colour(colour_texture(set)),
          baked(std::make_shared<BakedMaps>(set, filtering)) {}
};

// A texture as the device would hold it, for the evaluators: texels rounded as their format does,
// RGBA8 filtered by steps of 1/256; only the first level, or nearest, where the variant says so.
ir::Texture evaluator_texture(const vulkan::Texture& from, bool one_level = false,
                              bool nearest = false);
// What a sampler of that name reads: the set's map or a baked one, as `reading` says; only the
// set's own maps lose their levels.  Empty: nobody has such a map.  Errors: those of the bake.
Result<std::optional<ir::Texture>> evaluator_texture(const Textures& textures,
                                                     const TextureReading& reading,
                                                     const std::string& name);

// What one pass of a split surface needs beside the maps.
struct PassLink {
    const vulkan::Texture* before = nullptr;  // the picture of the pass before
    vulkan::Texture::Format target = vulkan::Texture::Format::Rgba32Float;
    std::map<std::string, std::vector<float>> uniforms = {};  // beside those of the draw
};

// A quad over [0, 1]^2 of texture space, seen from infinity: every pixel has the same view and
// light.
Result<vulkan::Program> prepare_quad(const vulkan::Device& device, const check::Program& shaders,
                                     const Textures& textures, double scale, int width, int height,
                                     const Look& look = {}, const PassLink& link = {});
// The same for any mesh in the plane z = 0, [0, 1]^2 of which is the picture.
Result<vulkan::Program> prepare_flat(const vulkan::Device& device, const check::Program& shaders,
                                     const Textures& textures, const vulkan::Mesh& mesh,
                                     double scale, int width, int height, const Look& look = {},
                                     const PassLink& link = {});
// Turns the eye and the light of a prepared quad.
Status aim(vulkan::Program& program, Direction view, Direction light);

// What a picture of a mesh holds where the mesh is not.
inline constexpr std::array<float, 4> mesh_background = {0.012f, 0.013f, 0.016f, 1};

// A mesh under a perspective camera, the light at infinity in world space.
struct MeshView {
    vulkan::Mesh mesh;
    vulkan::Camera camera;
    std::array<float, 3> light;
};
Result<vulkan::Program> prepare_mesh(const vulkan::Device& device, const check::Program& shaders,
                                     const Textures& textures, double scale, int width, int height,
                                     const MeshView& view, const Look& look = {},
                                     const PassLink& link = {});

}  // namespace intaglio::measure

// Searches alone, run by the evaluator: what a search says of one ray over one map, beside what the
// exact reference says of it.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "generator/dsl/surface.h"
#include "generator/ir/evaluate.h"
#include "src/reference/trace.h"
#include "tests/unit/maps/patch_textures.h"

namespace intaglio::templates {

// One relief as a texture of floats with box-filtered mip levels, as normals, as what the exact
// search has baked, and as the reference's field.
struct Map {
    ir::Texture height, normal;
    std::optional<maps::PatchTextures> baked;
    reference::HeightField field;
};

// Heights by texel; normals of a flat map unless given.
Map map_of(int width, int height, const std::function<double(int, int)>& height_of,
           const std::function<reference::Vec3(int, int)>& normal_of = {});
Map flat_map(double height);
Map noise_map(int width, int height, unsigned seed);
// A procedural map (src/maps/makers.h).
Map map_named(const std::string& maker, int width = 64, int height = 64);

// Unit vector, rounded to float as shaders get it.  Elevation 90 is straight down on the map,
// azimuth 0 along +u; degrees.
reference::Vec3 direction(double elevation, double azimuth);

struct Ray {
    reference::Vec2 uv;
    reference::Vec3 view;
    double scale = 0.08f;
    reference::Vec2 pixel = {0, 0};  // how uv changes to the pixel on the right, and down likewise
};

struct Answer {
    reference::Vec2 uv;
    double height;
    double found;  // 1 or 0; -1 where the search cannot say
    long reads;
    long instructions;

    bool finite() const;
};

using Knobs = std::vector<std::pair<std::string, std::string>>;

// A search made ready to be asked.
class Asked {
  public:
    // `section` of `sections`: the slab of the relief that is searched; scale then is the slab's.
    explicit Asked(const std::string& search, const Knobs& knobs = {}, int section = 0,
                   int sections = 1);
    Answer operator()(const Map& map, const Ray& ray) const;

    const ir::Module& module() const { return module_; }
    bool has(ir::Op op) const;

  private:
    ir::Module module_;
    std::unique_ptr<ir::Evaluator> evaluator_;
};

// uv - V.xy / V.z * scale * t.
reference::Vec2 on_ray(const Ray& ray, double t);
// t of a reported coordinate, by its nearest point on the ray; 0 where the ray does not move.
double parameter_of(const Ray& ray, reference::Vec2 uv);
// How far two coordinates lie apart, in texels of the map.
double texels_apart(const Map& map, reference::Vec2 a, reference::Vec2 b);

// A ray with a random start in the tile and a random azimuth.
Ray random_ray(unsigned& state, double elevation, double scale = 0.08f);
// In [0, 1).
double random_share(unsigned& state);

}  // namespace intaglio::templates

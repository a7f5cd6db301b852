// One pixel of a surface, computed on the CPU: what the template tests ask their techniques.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "generator/ir/evaluate.h"
#include "src/maps/makers.h"
#include "src/reference/trace.h"
#include "templates/all_techniques.h"
#include "tests/unit/maps/patch_textures.h"
#include "tests/unit/reference/witness.h"

namespace intaglio::templates::testing {

using reference::HeightField;
using reference::Vec2;
using reference::Vec3;
using reference::witness::pi;
using reference::witness::Random;
using Vector = ir::Environment::Vector;
using Knobs = std::vector<std::pair<std::string, std::string>>;

inline dsl::Surface surface_named(const std::string& text, const Knobs& knobs = {}) {
    Result<dsl::Surface> surface = dsl::make_surface(all_techniques(), text);
    if (!surface) {
        ADD_FAILURE() << to_string(surface.error());
        std::abort();
    }
    for (const auto& [name, value] : knobs) {
        const Status set = surface->set_knob(name, value);
        EXPECT_TRUE(set.ok()) << to_string(set.error());
    }
    return std::move(*surface);
}

// A map whose height at each texel centre is what `height(u, v)` says, rounded to float.
template <typename Height>
HeightField field_of(int width, int height, const Height& at) {
    HeightField field;
    field.width = width;
    field.height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            field.heights.push_back(static_cast<float>(at((x + 0.5) / width, (y + 0.5) / height)));
    return field;
}

inline HeightField made_field(const std::string& maker, int width, int height) {
    const Result<maps::Image> image = maps::make_height_map(maker, width, height, 1);
    EXPECT_TRUE(image.ok());
    HeightField field;
    field.width = width;
    field.height = height;
    field.heights.assign(image->texels.begin(), image->texels.end());
    return field;
}

// Heights in red and alpha; a map of one level.
inline ir::Texture texture_of(const HeightField& field) {
    ir::Texture texture;
    texture.width = field.width;
    texture.height = field.height;
    std::vector<float> texels;
    for (double height : field.heights) {
        const float h = static_cast<float>(height);
        texels.insert(texels.end(), {h, 0.0f, 0.0f, h});
    }
    texture.levels = {std::move(texels)};
    return texture;
}

inline Vec3 direction(double elevation, double azimuth) {
    const double e = elevation * pi / 180, a = azimuth * pi / 180;
    // On the axes exactly: those are the hard cases.
    const auto snapped = [](double value) { return std::abs(value) < 1e-15 ? 0.0 : value; };
    return {snapped(std::cos(e) * std::cos(a)), snapped(std::cos(e) * std::sin(a)),
            snapped(std::sin(e))};
}

inline const Vector white{1, 0.96, 0.88};

// Everything that a draw hands to the pixel stage, by name.
struct Draw {
    const HeightField& field;
    Vec2 uv{0.5, 0.5};
    Vec3 to_eye{0, 0, 1}, to_light{0, 0, 1};
    double scale = 0.08;
    Vector map_tangents{1, 0, 0, 1};
    Vector tile{0, 0, 1, 1};
    double gloss = 0.5;
    const ir::Texture* normal_map = nullptr;  // flat where none is given
    ir::Precision precision = ir::Precision::Single;
    Vector light_colour = white;
    // Of the lights after the first: towards it, and its colour.
    std::vector<std::pair<Vec3, Vector>> further = {};
};

// The evaluator on one module and one map: made once, asked often.
class Judge {
  public:
    Judge(ir::Module module, const HeightField& field)
        : module_(std::move(module)),
          heights_(texture_of(field)),
          baked_(field.width, field.height, field.heights),
          evaluator_(module_) {
        colour_.levels = {{0.5f, 0.25f, 0.125f, 1.0f}};
        flat_.levels = {{0.5f, 0.5f, 1.0f, 1.0f}};
    }

    ir::Evaluation operator()(const Draw& draw, const std::map<std::string, Vector>& inputs) const {
        std::map<std::string, Vector> uniforms = {
            {"scale", {draw.scale}},
            {"map_size",
             {static_cast<double>(draw.field.width), static_cast<double>(draw.field.height)}},
            {"ambient", {0.25, 0.27, 0.33}},
            {"light_colour", draw.light_colour},
            {"gloss", {draw.gloss}},
            {"tile", draw.tile},
            {"texture_span", {1}},
            {"map_tangents", draw.map_tangents}};
        for (std::size_t i = 0; i < draw.further.size(); ++i)
            uniforms[dsl::name_of_light("light_colour", static_cast<int>(i) + 1)] =
                draw.further[i].second;
        ir::Environment environment;
        for (const ir::Declaration& input : module_.inputs)
            environment.inputs.push_back(inputs.at(input.name));
        for (const ir::Uniform& uniform : module_.uniforms)
            environment.uniforms.push_back({uniforms.at(uniform.name)});
        for (const ir::Sampler& sampler : module_.samplers)
            environment.samplers.push_back(sampler.name == "height_map"   ? &heights_
                                           : sampler.name == "colour_map" ? &colour_
                                           : baked_.named(sampler.name) ? baked_.named(sampler.name)
                                           : draw.normal_map            ? draw.normal_map
                                                                        : &flat_);
        return evaluator_.run(environment, draw.precision);
    }

  private:
    ir::Module module_;
    ir::Texture heights_, colour_, flat_;
    maps::PatchTextures baked_;
    ir::Evaluator evaluator_;
};

// The pixel stage of a surface.
class Pixel {
  public:
    Pixel(const std::string& surface, const HeightField& field, const Knobs& knobs = {})
        : judge_(recorded(surface_named(surface, knobs)), field) {}

    std::array<double, 4> operator()(const Draw& draw) const {
        std::map<std::string, Vector> inputs = {
            {"uv", {draw.uv.x, draw.uv.y}},
            {"to_eye", {draw.to_eye.x, draw.to_eye.y, draw.to_eye.z}},
            {"to_light", {draw.to_light.x, draw.to_light.y, draw.to_light.z}}};
        for (std::size_t i = 0; i < draw.further.size(); ++i) {
            const Vec3& to_light = draw.further[i].first;
            inputs[dsl::name_of_light("to_light", static_cast<int>(i) + 1)] = {
                to_light.x, to_light.y, to_light.z};
        }
        return judge_(draw, inputs).outputs[0];
    }

  private:
    static ir::Module recorded(const dsl::Surface& surface) {
        Result<ir::Program> program = dsl::record_surface(surface, {"glsl_450", {}, false});
        EXPECT_TRUE(program.ok()) << to_string(program.error());
        return program->pixel;
    }
    Judge judge_;
};

// A shadow alone: how much light reaches a point of the relief.
class Visibility {
  public:
    Visibility(const std::string& shadow, const HeightField& field, const Knobs& knobs = {})
        : judge_(recorded(surface_named("search=none,shadow=" + shadow, knobs)), field) {}

    ir::Evaluation run(const Draw& draw, double height) const {
        return judge_(draw, {{"uv", {draw.uv.x, draw.uv.y}},
                             {"height", {height}},
                             {"light", {draw.to_light.x, draw.to_light.y, draw.to_light.z}}});
    }
    double operator()(const Draw& draw, double height) const {
        return run(draw, height).outputs[0][0];
    }

  private:
    static ir::Module recorded(const dsl::Surface& surface) {
        Result<ir::Program> program =
            dsl::record_function(surface, dsl::FunctionPart::Shadow, {"glsl_450", {}, false});
        EXPECT_TRUE(program.ok()) << to_string(program.error());
        return program->pixel;
    }
    Judge judge_;
};

}  // namespace intaglio::templates::testing

// The bench of the searches.
#include "tests/unit/templates/bench.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "generator/dsl/catalogue.h"
#include "src/maps/makers.h"
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

std::size_t at(int x, int y, int width) { return static_cast<std::size_t>(y * width + x); }

// The next level of a texture: means of two texels by two.
std::vector<float> halved(const std::vector<float>& texels, int width, int height) {
    const int w = std::max(width / 2, 1), h = std::max(height / 2, 1);
    std::vector<float> level(at(0, h, w) * 4);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (std::size_t c = 0; c < 4; ++c) {
                const auto texel = [&](int i, int j) {
                    return texels[at(std::min(i, width - 1), std::min(j, height - 1), width) * 4 +
                                  c];
                };
                level[at(x, y, w) * 4 + c] =
                    (texel(2 * x, 2 * y) + texel(2 * x + 1, 2 * y) + texel(2 * x, 2 * y + 1) +
                     texel(2 * x + 1, 2 * y + 1)) /
                    4;
            }
    return level;
}

ir::Texture texture_of(int width, int height, std::vector<float> texels) {
    ir::Texture texture;
    texture.width = width;
    texture.height = height;
    texture.levels = {std::move(texels)};
    for (int w = width, h = height; w > 1 || h > 1; w = std::max(w / 2, 1), h = std::max(h / 2, 1))
        texture.levels.push_back(halved(texture.levels.back(), w, h));
    return texture;
}

ir::Environment::Vector vector_of(std::initializer_list<double> values) {
    ir::Environment::Vector vector{};
    std::copy(values.begin(), values.end(), vector.begin());
    return vector;
}

}  // namespace

Map map_of(int width, int height, const std::function<double(int, int)>& height_of,
           const std::function<reference::Vec3(int, int)>& normal_of) {
    std::vector<float> heights, normals;
    Map map;
    map.field.width = width;
    map.field.height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float texel = static_cast<float>(height_of(x, y));
            map.field.heights.push_back(texel);
            heights.insert(heights.end(), {texel, texel, texel, texel});
            const reference::Vec3 n = normal_of ? normal_of(x, y) : reference::Vec3{0, 0, 1};
            for (double component : {n.x, n.y, n.z})
                normals.push_back(static_cast<float>(component * 0.5 + 0.5));
            normals.push_back(texel);
        }
    map.height = texture_of(width, height, heights);
    map.baked.emplace(width, height, map.field.heights);
    map.normal = texture_of(width, height, normals);
    return map;
}

Map flat_map(double height) {
    return map_of(4, 4, [&](int, int) { return height; });
}

Map noise_map(int width, int height, unsigned seed) {
    return map_of(width, height, [&](int, int) { return random_share(seed); });
}

Map map_named(const std::string& maker, int width, int height) {
    const Result<maps::Image> image = maps::make_height_map(maker, width, height, 1);
    EXPECT_TRUE(image.ok()) << maker;
    return map_of(width, height, [&](int x, int y) { return image->at(x, y); });
}

reference::Vec3 direction(double elevation, double azimuth) {
    const double e = elevation * std::numbers::pi / 180, a = azimuth * std::numbers::pi / 180;
    const auto rounded = [](double value) {
        return static_cast<double>(static_cast<float>(value));
    };
    return {rounded(std::cos(e) * std::cos(a)), rounded(std::cos(e) * std::sin(a)),
            rounded(std::sin(e))};
}

bool Answer::finite() const {
    return std::isfinite(uv.x) && std::isfinite(uv.y) && std::isfinite(height);
}

Asked::Asked(const std::string& search, const Knobs& knobs, int section, int sections) {
    Result<dsl::Surface> surface = dsl::make_surface(all_techniques(), "search=" + search);
    EXPECT_TRUE(surface.ok()) << search;
    for (const auto& [name, value] : knobs) {
        const Status status = surface->set_knob(name, value);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : to_string(status.error()));
    }
    module_.name = search;
    module_.stage = ir::Stage::Pixel;
    dsl::Recorder recorder(module_);
    const dsl::float2 uv = dsl::input<2>("uv");
    const dsl::float3 view = dsl::input<3>("view");
    const dsl::Relief relief{dsl::sampler2D("height_map", "heights"),
                             false,
                             dsl::uniform<1>("scale", "depth"),
                             dsl::uniform<2>("map_size", "texels"),
                             dsl::float1(surface->relief->level.value()),
                             section,
                             sections};
    const dsl::Hit hit = surface->search->find(relief, dsl::Ray::through(relief, uv, view));
    const dsl::float1 found =
        hit.found ? select(*hit.found, dsl::float1(1.0f), 0.0f) : dsl::float1(-1.0f);
    const dsl::float4 answer(hit.uv, hit.height, found);
    module_.outputs = {{"answer", ir::float4, ir::Semantic::Target}};
    const Status finished = recorder.finish({answer.id()});
    EXPECT_TRUE(finished.ok()) << (finished.ok() ? "" : to_string(finished.error()));
    evaluator_ = std::make_unique<ir::Evaluator>(module_);
}

Answer Asked::operator()(const Map& map, const Ray& ray) const {
    ir::Environment environment;
    const auto inputs_at = [&](double right, double down) {
        std::vector<ir::Environment::Vector> inputs;
        for (const ir::Declaration& input : module_.inputs)
            inputs.push_back(input.name == "uv" ? vector_of({ray.uv.x + right * ray.pixel.x,
                                                             ray.uv.y + down * ray.pixel.y})
                                                : vector_of({ray.view.x, ray.view.y, ray.view.z}));
        return inputs;
    };
    environment.inputs = inputs_at(0, 0);
    environment.right_inputs = inputs_at(1, 0);
    environment.lower_inputs = inputs_at(0, 1);
    for (const ir::Uniform& uniform : module_.uniforms)
        environment.uniforms.push_back({uniform.name == "scale"
                                            ? vector_of({ray.scale})
                                            : vector_of({static_cast<double>(map.height.width),
                                                         static_cast<double>(map.height.height)})});
    for (const ir::Sampler& sampler : module_.samplers)
        environment.samplers.push_back(sampler.name == "height_map" ? &map.height
                                       : map.baked->named(sampler.name)
                                           ? map.baked->named(sampler.name)
                                           : &map.normal);
    const ir::Evaluation result = evaluator_->run(environment, ir::Precision::Single);
    const std::array<double, 4>& out = result.outputs[0];
    return {{out[0], out[1]}, out[2], out[3], result.texture_reads, result.instructions};
}

bool Asked::has(ir::Op op) const {
    const std::function<bool(const ir::Region&)> in = [&](const ir::Region& region) {
        return std::any_of(
            region.body.begin(), region.body.end(), [&](const ir::Instruction& instruction) {
                return instruction.op == op ||
                       std::any_of(instruction.regions.begin(), instruction.regions.end(), in);
            });
    };
    return in(module_.body);
}

reference::Vec2 on_ray(const Ray& ray, double t) {
    return {ray.uv.x - ray.view.x / ray.view.z * ray.scale * t,
            ray.uv.y - ray.view.y / ray.view.z * ray.scale * t};
}

double parameter_of(const Ray& ray, reference::Vec2 uv) {
    const double x = ray.view.x / ray.view.z * ray.scale, y = ray.view.y / ray.view.z * ray.scale;
    const double squared = x * x + y * y;
    return squared > 0 ? ((ray.uv.x - uv.x) * x + (ray.uv.y - uv.y) * y) / squared : 0;
}

double texels_apart(const Map& map, reference::Vec2 a, reference::Vec2 b) {
    return std::hypot((a.x - b.x) * map.field.width, (a.y - b.y) * map.field.height);
}

double random_share(unsigned& state) {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / 16777216.0;
}

Ray random_ray(unsigned& state, double elevation, double scale) {
    const auto rounded = [](double value) {
        return static_cast<double>(static_cast<float>(value));
    };
    const double x = rounded(random_share(state)), y = rounded(random_share(state));
    return {{x, y}, direction(elevation, 360 * random_share(state)), rounded(scale)};
}

}  // namespace intaglio::templates

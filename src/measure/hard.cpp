// The suite's run.  A picture of patches, each with coordinates and a frame of its own, is drawn
// once for every map, aim and scale, and all cases take their rays from it: a technique costs one
// pipeline per map.
#include "src/measure/hard.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <thread>

#include <fmt/format.h>

#include "src/measure/hard_judge.h"
#include "src/measure/render.h"
#include "src/variant/variant.h"

namespace intaglio::measure {
namespace {

constexpr std::string_view target = "glsl_450";

// One map of the suite as the device and as the evaluator take it.
struct HardMap {
    const MapSet* set;
    reference::HeightField field;
    Textures textures;
    std::map<std::string, ir::Texture> evaluated = {};

    explicit HardMap(const std::string& name)
        : set(&hard_map(name)),
          field(set->height_field(reference::FilterWeights::Exact)),
          textures(*set, hard_filtering(name)) {}

    Result<const ir::Texture*> texture(const std::string& name) {
        const auto known = evaluated.find(name);
        if (known != evaluated.end()) return &known->second;
        Result<std::optional<ir::Texture>> texture = evaluator_texture(textures, {}, name);
        if (!texture) return texture.error();
        if (!*texture) return internal_error("hard-texture", fmt::format("no texture {}", name));
        return &evaluated.emplace(name, std::move(**texture)).first->second;
    }
};

// A technique compiled for all ways.
struct Compiled {
    check::Program shaders;
    ir::Module vertex, pixel;
    ir::Evaluator run_vertex, run_pixel;
};

Result<Compiled> compile(const dsl::Catalogue& catalogue, const HardRow& row) {
    VariantRequest request;
    request.surface = row.surface;
    request.target = target;
    request.knobs = row.knobs;
    Result<Variant> variant = make_variant(catalogue, request);
    if (!variant) return variant.error();
    Result<check::Program> shaders = link_variant(*variant);
    if (!shaders) return shaders.error();
    if (row.rewrite) {
        row.rewrite(variant->program.vertex);
        row.rewrite(variant->program.pixel);
    }
    ir::Evaluator vertex(variant->program.vertex), pixel(variant->program.pixel);
    return Compiled{std::move(*shaders), std::move(variant->program.vertex),
                    std::move(variant->program.pixel), std::move(vertex), std::move(pixel)};
}

std::vector<float> direction(const std::array<float, 3>& v) { return {v[0], v[1], v[2], 0}; }

std::map<std::string, std::vector<float>> uniforms_at(const HardMap& map, const Aim& aim,
                                                      float scale) {
    auto uniforms = uniforms_of({}, {}, scale, map.set->heights.width, map.set->heights.height);
    uniforms["eye"] = direction(aim.eye);
    uniforms["light"] = direction(aim.light);
    return uniforms;
}

template <typename Values>
ir::Environment::Vector vector_from(const Values& values, std::size_t first, std::size_t count) {
    ir::Environment::Vector vector{};
    for (std::size_t i = 0; i < count && first + i < values.size(); ++i)
        vector[i] = values[first + i];
    return vector;
}

std::vector<std::vector<ir::Environment::Vector>> by_slot(
    const ir::Module& module, const std::map<std::string, std::vector<float>>& uniforms) {
    std::vector<std::vector<ir::Environment::Vector>> all;
    for (const ir::Uniform& uniform : module.uniforms) {
        const std::vector<float>& values = uniforms.at(uniform.name);
        const auto width = static_cast<std::size_t>(uniform.type.width);
        all.emplace_back();
        for (std::size_t i = 0; i < values.size(); i += width)
            all.back().push_back(vector_from(values, i, width));
    }
    return all;
}

// What the vertex stage hands on at a pixel, by name.
std::map<std::string, std::array<double, 4>> handed_on(
    const Compiled& stages, const std::vector<std::vector<ir::Environment::Vector>>& uniforms,
    int x, int y) {
    const vulkan::Vertex vertex = hard_vertex(x, y);
    ir::Environment environment;
    environment.uniforms = uniforms;
    for (const ir::Declaration& input : stages.vertex.inputs)
        environment.inputs.push_back(input.name == "position"  ? vector_from(vertex.position, 0, 3)
                                     : input.name == "normal"  ? vector_from(vertex.normal, 0, 3)
                                     : input.name == "tangent" ? vector_from(vertex.tangent, 0, 4)
                                                               : vector_from(vertex.uv, 0, 2));
    const ir::Evaluation done = stages.run_vertex.run(environment, ir::Precision::Single);
    std::map<std::string, std::array<double, 4>> values;
    for (std::size_t i = 0; i < stages.vertex.outputs.size(); ++i)
        values[stages.vertex.outputs[i].name] = done.outputs[i];
    return values;
}

// As the shaders normalise, in real numbers.
reference::Vec3 unit(const std::array<double, 4>& v) {
    const double length = std::sqrt(
        std::max(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], static_cast<double>(dsl::tiny)));
    return {v[0] / length, v[1] / length, v[2] / length};
}

class Suite {
  public:
    Suite(const vulkan::Device& device, const dsl::Catalogue& catalogue)
        : device_(device), catalogue_(catalogue), mesh_(hard_mesh()) {}

    // What all rows share: the rays of each case and the truth about them.
    Status prepare(const std::vector<HardCase>& cases) {
        Result<Compiled> stages =
            compile(catalogue_, {"coordinates", "search=none,output=depth", {}});
        if (!stages) return stages.error();
        Result<Compiled> coordinates =
            compile(catalogue_, {"coordinates", "search=none,output=displaced", {}});
        if (!coordinates) return coordinates.error();
        for (const HardCase& hard_case : cases) maps_.try_emplace(hard_case.map, hard_case.map);
        HardMap& any = maps_.begin()->second;
        Result<vulkan::Program> program = prepare_flat(device_, coordinates->shaders, any.textures,
                                                       mesh_, 0.08, hard_pixels, hard_pixels);
        if (!program) return program.error();
        const Result<std::vector<vulkan::Picture>> uv = program->draw();
        if (!uv) return uv.error();
        for (const HardCase& hard_case : cases) add_rays(hard_case, *stages, uv->front());
        return Done{};
    }

    Status run(const HardRow& row, const std::vector<HardCase>& cases,
               std::vector<std::array<HardCell, all_ways.size()>>& cells) {
        const Result<Compiled> compiled = compile(catalogue_, row);
        if (!compiled) return compiled.error();
        std::vector<std::array<std::vector<HardOutcome>, all_ways.size()>> outcomes(cases.size());
        for (auto& [name, map] : maps_)
            if (Status status = draw_map(row, *compiled, name, map, cases, outcomes); !status)
                return status;
        std::atomic<std::size_t> next = 0;
        std::vector<std::jthread> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads.emplace_back([&] {
                for (std::size_t c = next++; c < cases.size(); c = next++)
                    evaluate_and_judge(row, *compiled, cases[c], c, outcomes[c], cells[c]);
            });
        return Done{};
    }

  private:
    void add_rays(const HardCase& hard_case, const Compiled& stages, const vulkan::Picture& uv) {
        std::vector<HardRay>& rays = rays_.emplace_back();
        const HardMap& map = maps_.at(hard_case.map);
        const auto patch =
            std::find_if(hard_patches().begin(), hard_patches().end(),
                         [&](const HardPatch& other) { return other.name == hard_case.patch; });
        const int index = static_cast<int>(patch - hard_patches().begin());
        for (std::size_t aim = 0; aim < hard_case.aims.size(); ++aim) {
            const auto uniforms =
                by_slot(stages.vertex, uniforms_at(map, hard_case.aims[aim], hard_case.scale));
            for (int i = 0; i < patch_pixels * patch_pixels; ++i) {
                HardRay ray;
                ray.x = index % patches_across * patch_pixels + i % patch_pixels;
                ray.y = index / patches_across * patch_pixels + i / patch_pixels;
                ray.aim = static_cast<int>(aim);
                ray.uv = {uv.at(ray.x, ray.y)[0], uv.at(ray.x, ray.y)[1]};
                ray.inputs = handed_on(stages, uniforms, ray.x, ray.y);
                ray.inputs["uv"] = {ray.uv[0], ray.uv[1], 0, 0};
                ray.view = unit(ray.inputs["to_eye"]);
                ray.view.z = std::max(ray.view.z, static_cast<double>(dsl::Ray::least_z));
                ray.light = unit(ray.inputs["to_light"]);
                const double scale = hard_case.scale;
                ray.reach = {ray.view.x / ray.view.z * scale, ray.view.y / ray.view.z * scale};
                ray.exact =
                    reference::first_hit(map.field, {ray.uv[0], ray.uv[1]}, ray.view, scale);
                ray.lit =
                    reference::lit(map.field, ray.exact.uv, ray.exact.height, ray.light, scale);
                rays.push_back(std::move(ray));
            }
        }
    }

    Status draw_map(const HardRow& row, const Compiled& compiled, const std::string& name,
                    HardMap& map, const std::vector<HardCase>& cases,
                    std::vector<std::array<std::vector<HardOutcome>, all_ways.size()>>& outcomes) {
        std::optional<vulkan::Program> program;
        using Key = std::pair<std::array<float, 6>, float>;
        std::map<Key, vulkan::Picture> drawn;
        for (std::size_t c = 0; c < cases.size(); ++c) {
            const HardCase& hard_case = cases[c];
            if (hard_case.map != name || !expected_of(row, hard_case)) continue;
            for (const ir::Sampler& sampler : compiled.pixel.samplers)
                if (const auto texture = map.texture(sampler.name); !texture)
                    return texture.error();
            if (row.evaluated_only) continue;
            if (!program) {
                Result<vulkan::Program> made =
                    prepare_flat(device_, compiled.shaders, map.textures, mesh_, hard_case.scale,
                                 hard_pixels, hard_pixels);
                if (!made) return made.error();
                program = std::move(*made);
            }
            for (const HardRay& ray : rays_[c]) {
                const Aim& aim = hard_case.aims[static_cast<std::size_t>(ray.aim)];
                const Key key{
                    {aim.eye[0], aim.eye[1], aim.eye[2], aim.light[0], aim.light[1], aim.light[2]},
                    hard_case.scale};
                auto picture = drawn.find(key);
                if (picture == drawn.end()) {
                    Result<vulkan::Picture> made = draw(*program, aim, hard_case.scale);
                    if (!made) return made.error();
                    picture = drawn.emplace(key, std::move(*made)).first;
                }
                const std::array<float, 4>& pixel = picture->second.at(ray.x, ray.y);
                HardOutcome outcome;
                std::copy(pixel.begin(), pixel.end(), outcome.value.begin());
                outcomes[c][0].push_back(outcome);
            }
        }
        return Done{};
    }

    static Result<vulkan::Picture> draw(vulkan::Program& program, const Aim& aim, float scale) {
        for (const auto& [name, values] :
             {std::pair{"eye", direction(aim.eye)}, std::pair{"light", direction(aim.light)},
              std::pair{"scale", std::vector<float>{scale}}})
            if (Status status = program.set_uniform(name, values); !status) return status.error();
        Result<std::vector<vulkan::Picture>> pictures = program.draw();
        if (!pictures) return pictures.error();
        return std::move(pictures->front());
    }

    void evaluate_and_judge(const HardRow& row, const Compiled& compiled, const HardCase& hard_case,
                            std::size_t index,
                            std::array<std::vector<HardOutcome>, all_ways.size()>& outcomes,
                            std::array<HardCell, all_ways.size()>& cells) const {
        const std::optional<Expect> expect = expected_of(row, hard_case);
        if (!expect) return;
        const HardMap& map = maps_.at(hard_case.map);
        ir::Environment environment;
        for (const ir::Sampler& sampler : compiled.pixel.samplers)
            environment.samplers.push_back(&map.evaluated.at(sampler.name));
        for (std::size_t w = row.evaluated_only ? 1 : 0; w < all_ways.size(); ++w) {
            const Way way = all_ways[w];
            const bool moved =
                *expect == Expect::FormatsBest && (way == Way::Narrow24 || way == Way::Narrow16);
            std::vector<HardRay> rays = rays_[index];
            if (moved)
                for (HardRay& ray : rays)
                    ray = from_held_coordinate(ray, map.field, hard_case.scale, way);
            if (!std::all_of(rays.begin(), rays.end(),
                             [&](const HardRay& ray) { return has_numbers_for(ray, way); })) {
                cells[w].verdict = Verdict::NoSuchNumber;
                continue;
            }
            outcomes[w].resize(rays.size());
            for (std::size_t r = 0; r < rays.size(); ++r) {
                const Aim& aim = hard_case.aims[static_cast<std::size_t>(rays[r].aim)];
                environment.uniforms =
                    by_slot(compiled.pixel, uniforms_at(map, aim, hard_case.scale));
                give_inputs(environment, compiled.pixel, rays[r]);
                // The device's inputs are always numbers, so that its own formula is there.
                outcomes[w][r].own =
                    w == 0 || moved || row.evaluated_only
                        ? compiled.run_pixel.run(environment, ir::Precision::Double).outputs[0]
                        : outcomes[0][r].own;
                if (way != Way::Device)
                    evaluate(compiled.run_pixel, environment, way, outcomes[w][r]);
            }
            cells[w] = judge(row, hard_case, *expect, way, map.field, rays, outcomes[w]);
        }
    }

    static void evaluate(const ir::Evaluator& pixel, const ir::Environment& environment, Way way,
                         HardOutcome& outcome) {
        const ir::Precision precision = way == Way::Single     ? ir::Precision::Single
                                        : way == Way::Narrow24 ? ir::Precision::Narrow24
                                                               : ir::Precision::Narrow16;
        const auto got = pixel.run(environment, precision).outputs;
        outcome.value = got[0];
        if (got.size() > 1) outcome.depth = got[1][0];
    }

    // The pixel's inputs, and those of its neighbours a pixel of the picture further.
    static void give_inputs(ir::Environment& environment, const ir::Module& pixel,
                            const HardRay& ray) {
        environment.inputs.clear();
        environment.right_inputs.clear();
        environment.lower_inputs.clear();
        for (const ir::Declaration& input : pixel.inputs) {
            const std::array<double, 4> here = ray.inputs.at(input.name);
            std::array<double, 4> right = here, lower = here;
            if (input.name == "uv") {
                right[0] += 1.0 / patch_pixels;
                lower[1] += 1.0 / patch_pixels;
            }
            environment.inputs.push_back(here);
            environment.right_inputs.push_back(right);
            environment.lower_inputs.push_back(lower);
        }
    }

    const vulkan::Device& device_;
    const dsl::Catalogue& catalogue_;
    vulkan::Mesh mesh_;
    std::map<std::string, HardMap> maps_;
    std::vector<std::vector<HardRay>> rays_;  // by case
};

}  // namespace

std::string_view name_of(Way way) {
    switch (way) {
        case Way::Device: return "device";
        case Way::Single: return "fp32";
        case Way::Narrow24: return "fp24";
        case Way::Narrow16: return "fp16";
    }
    return {};
}

Result<HardSuite> run_hard_suite(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                                 const std::vector<HardRow>& rows,
                                 const std::vector<HardCase>& cases,
                                 const std::function<void(int done, int all)>& progress) {
    HardSuite suite{rows, cases, {}, fmt::format("{}, {}", device.name(), device.driver())};
    Suite work(device, catalogue);
    if (Status status = work.prepare(cases); !status) return status.error();
    for (const HardRow& row : rows) {
        suite.cells.emplace_back(cases.size());
        if (Status status = work.run(row, cases, suite.cells.back()); !status)
            return status.error();
        if (progress) progress(static_cast<int>(suite.cells.size()), static_cast<int>(rows.size()));
    }
    return suite;
}

}  // namespace intaglio::measure

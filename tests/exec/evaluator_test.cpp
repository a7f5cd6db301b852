// The evaluator against the device, pixel by pixel: the IR as recorded, the IR after all passes,
// and what lavapipe draws from the emitted text.  A mismatch names its stage.
#include "tests/exec/bench.h"

#include <bit>
#include <cmath>

#include "generator/ir/evaluate.h"
#include "generator/passes/pipeline.h"

namespace intaglio::exec {
namespace {

constexpr int size = 32;
constexpr measure::Direction light{35, 130};

ir::Texture evaluator_texture(const vulkan::Texture& texture) {
    ir::Texture made;
    made.width = texture.width;
    made.height = texture.height;
    made.levels = texture.levels;
    made.filter = texture.filter == vulkan::Texture::Filter::Linear ? ir::Texture::Filter::Linear
                                                                    : ir::Texture::Filter::Nearest;
    made.mip_filter = made.filter;
    return made;
}

std::vector<double> widened(const std::vector<float>& values) {
    return {values.begin(), values.end()};
}

// Inputs and uniforms of one pixel, by the names the module declares.
ir::Environment environment_of(const ir::Module& module, int x, int y, measure::Direction view,
                               const measure::MapSet& set,
                               const std::map<std::string, const ir::Texture*>& textures) {
    ir::Environment environment;
    const std::array<float, 3> v = measure::vector_of(view), l = measure::vector_of(light);
    const std::map<std::string, std::vector<double>> inputs = {
        {"uv", {(x + 0.5) / size, (y + 0.5) / size}},
        {"to_eye", {v[0], v[1], v[2]}},
        {"to_light", {l[0], l[1], l[2]}}};
    const auto vector_from = [](const std::vector<double>& values) {
        std::array<double, 4> vector{};
        std::copy(values.begin(), values.end(), vector.begin());
        return vector;
    };
    for (const ir::Declaration& input : module.inputs)
        environment.inputs.push_back(vector_from(inputs.at(input.name)));
    const auto uniforms =
        measure::uniforms_of(view, light, test_scale, set.heights.width, set.heights.height);
    for (const ir::Uniform& uniform : module.uniforms)
        environment.uniforms.push_back({vector_from(widened(uniforms.at(uniform.name)))});
    for (const ir::Sampler& sampler : module.samplers)
        environment.samplers.push_back(textures.at(sampler.name));
    return environment;
}

// What the device draws, and what both forms of the IR compute.
struct Stages {
    vulkan::Picture device, raw, final;
};

Stages run_stages(const std::string& surface, const Knobs& knobs, const measure::MapSet& set,
                  measure::Direction view, vulkan::Texture::Filter filter) {
    const Variant variant =
        must(make_variant(templates::all_techniques(), request(surface, "glsl_450", knobs)));
    measure::Textures textures(set, measure::Filtering::Float);
    for (vulkan::Texture* texture : {&textures.height, &textures.normal, &textures.colour})
        texture->filter = texture->mip_filter = filter;
    vulkan::Program program = must(measure::prepare_quad(device(), must(link_variant(variant)),
                                                         textures, test_scale, size, size));
    must(measure::aim(program, view, light));
    Stages stages;
    stages.device = must(program.draw())[0];

    const ir::Texture height = evaluator_texture(textures.height),
                      normal = evaluator_texture(textures.normal),
                      colour = evaluator_texture(textures.colour);
    const std::map<std::string, const ir::Texture*> by_name = {
        {"height_map", &height}, {"normal_map", &normal}, {"colour_map", &colour}};
    ir::Module optimized = variant.program.pixel;
    must(passes::optimize(optimized, {}));
    for (auto [module, picture] :
         {std::pair<const ir::Module*, vulkan::Picture*>{&variant.program.pixel, &stages.raw},
          {&optimized, &stages.final}}) {
        const ir::Evaluator evaluator(*module);
        picture->width = picture->height = size;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const ir::Evaluation result = evaluator.run(
                    environment_of(*module, x, y, view, set, by_name), ir::Precision::Single);
                std::array<float, 4> pixel{};
                for (std::size_t c = 0; c < 4; ++c)
                    pixel[c] = static_cast<float>(result.outputs[0][c]);
                picture->pixels.push_back(pixel);
            }
    }
    return stages;
}

const std::vector<std::pair<std::string, Knobs>> displaced_surfaces = {
    {"search=none", {}},
    {"parallax", {}},
    {"parallax_limited", {{"normal_weight", "1"}}},
    {"parallax_iterative", {}},
    {"steep_parallax,shadow=march", {}},
    {"steep_parallax", {{"stride", "2"}}},
    {"steep_parallax", {{"stride", "3"}}},
    {"parallax_occlusion", {}},
    {"parallax_occlusion", {{"perspective_bias", "0.8"}}},
    {"relief", {}},
    {"relief_secant", {}},
    {"contact_refinement", {}},
    {"exact", {{"max_cells", "30"}, {"max_leaps", "0"}}},
    {"fur", {}}};

// With nearest filtering a read gives the stored float, and every operation in these surfaces is
// computed by lavapipe as the ops table says: nothing is left that could round differently.
TEST(Evaluator, AgreesWithTheDeviceToTheBitWithNearestFiltering) {
    const measure::MapSet bricks = map_named("bricks");
    for (const auto& [surface, knobs] : displaced_surfaces)
        for (measure::Direction view : views()) {
            SCOPED_TRACE(testing::Message() << surface << " at elevation " << view.elevation);
            const Stages stages = run_stages(dsl::with_part(surface, "output", "displaced"), knobs,
                                             bricks, view, vulkan::Texture::Filter::Nearest);
            EXPECT_TRUE(same_bits(stages.raw, stages.final)) << "a pass changed the result";
            EXPECT_TRUE(same_bits(stages.final, stages.device))
                << "the emitter or the driver changed the result";
        }
}

// With bilinear filtering lavapipe's float32 weights round otherwise than ours, by 1e-7 of a
// height.  That moves a hit by as much of the ray's reach where the search is continuous; where it
// is not (a sample just above or just below the ray), it may stop one step earlier or later.  So:
// all but 1 pixel in 200 within 2e-5 of texture space and of the reach.
TEST(Evaluator, AgreesWithTheDeviceWithinFilterRoundingWithLinearFiltering) {
    const measure::MapSet bricks = map_named("bricks");
    for (const auto& [surface, knobs] : displaced_surfaces)
        for (measure::Direction view : views()) {
            const Stages stages = run_stages(dsl::with_part(surface, "output", "displaced"), knobs,
                                             bricks, view, vulkan::Texture::Filter::Linear);
            EXPECT_TRUE(same_bits(stages.raw, stages.final)) << surface;
            const double reach = test_scale / std::max(std::tan(view.elevation / 57.3), 1.0 / 1024);
            int far = 0;
            for (std::size_t i = 0; i < stages.device.pixels.size(); ++i)
                far += std::hypot(stages.device.pixels[i][0] - stages.final.pixels[i][0],
                                  stages.device.pixels[i][1] - stages.final.pixels[i][1]) >
                       2e-5 * (1 + reach);
            EXPECT_LE(far, size * size / 200) << surface << " at elevation " << view.elevation;
        }
}

}  // namespace
}  // namespace intaglio::exec

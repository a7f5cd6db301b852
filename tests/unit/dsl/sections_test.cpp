// What a search promises to the sections of a relief: it sees its slab as a whole relief, and says
// whether the ray met it there.
#include <gtest/gtest.h>

#include <cmath>

#include "generator/ir/evaluate.h"
#include "templates/all_techniques.h"

namespace intaglio::dsl {
namespace {

// The search in section `section` of `sections`, as a function of uv and a unit view vector:
// coordinate, height in the whole relief, and 1 where the relief was met; -1 where the search
// cannot say.
ir::Module record_section(const Search& search, int section, int sections) {
    ir::Module module;
    module.name = "find";
    module.stage = ir::Stage::Function;
    Recorder recorder(module);
    const float share = 1.0f / static_cast<float>(sections);
    const float1 scale = uniform<1>("scale", "depth of the relief");
    Relief relief{sampler2D("height_map", "heights"),
                  false,
                  scale * share,
                  uniform<2>("map_size", "texels"),
                  float1(0.0f),
                  section,
                  sections};
    const Ray whole{input<2>("uv"), input<3>("view"), Ray::reach_of(scale, input<3>("view"))};
    const Ray part{whole.at(static_cast<float>(section) * share), whole.view, whole.reach * share};
    const Hit hit = search.find(relief, part);
    const float1 found = hit.found ? select(*hit.found, float1(1.0f), 0.0f) : float1(-1.0f);
    const float4 result(hit.uv, relief.in_whole(hit.height), found);
    module.outputs = {{"result", ir::float4, ir::Semantic::Result}};
    EXPECT_TRUE(recorder.finish({result.id()}).ok());
    return module;
}

// What a flat relief of this height has in the texture of that name: docs/maps.md.
ir::Texture flat_map(const std::string& name, float height) {
    ir::Texture map;
    map.width = map.height = 2;
    map.levels = {std::vector<float>(16, height)};
    if (name == "cone_map" || name == "relaxed_cone_map")
        for (std::size_t alpha = 3; alpha < 16; alpha += 4) map.levels[0][alpha] = 1;
    if (name == "max_mip_map" || name == "summit_map") map.levels.push_back(std::vector<float>(4, height));
    if (name == "distance_map") {
        map.depth = 32;
        map.levels = {{}};
        for (int slice = 0; slice < 32; ++slice) {
            const float floor_of_slice = (static_cast<float>(slice) - 0.5f) / 31;
            map.levels[0].insert(map.levels[0].end(), 16, std::max(0.0f, floor_of_slice - height));
        }
    }
    return map;
}

TEST(Sections, ASearchFindsAFlatReliefInItsOwnSection) {
    constexpr float scale = 0.1f;
    for (const Entry<Search>& row : templates::all_techniques().searches)
        for (const int sections : {1, 2, 3})
            for (int section = 0; section < sections; ++section) {
                const ir::Module module = record_section(*row.make(), section, sections);
                for (const float height : {0.05f, 0.3f, 0.55f, 0.8f}) {
                    SCOPED_TRACE(row.name + ", section " + std::to_string(section) + " of " +
                                 std::to_string(sections) + ", height " + std::to_string(height));
                    std::vector<ir::Texture> maps;
                    for (const ir::Sampler& sampler : module.samplers)
                        maps.push_back(flat_map(sampler.name, height));
                    ir::Environment environment;
                    for (const ir::Texture& map : maps) environment.samplers.push_back(&map);
                    for (const ir::Uniform& uniform : module.uniforms)
                        environment.uniforms.push_back({uniform.name == "scale"
                                                            ? ir::Environment::Vector{scale}
                                                            : ir::Environment::Vector{2, 2}});
                    environment.inputs = {{0.25, 0.75}, {0.6, 0, 0.8}};
                    const auto result =
                        ir::Evaluator(module).run(environment, ir::Precision::Single).outputs[0];
                    if (result[3] < 0 || row.name == "none") continue;
                    const double n = sections;
                    EXPECT_EQ(result[3] == 1, height >= 1 - (section + 1) / n);
                    const bool above = height >= 1 - section / n;
                    if (result[3] == 0 || above) continue;
                    // A march ends within one of its steps, of which it has at least 8 here.
                    EXPECT_NEAR(result[2], height, 1 / (8 * n) + 1e-6);
                    const double t = (0.25 - result[0]) / (0.75 * scale);
                    EXPECT_NEAR(t, 1 - height, 1 / (8 * n) + 1e-6);
                }
            }
}

}  // namespace
}  // namespace intaglio::dsl

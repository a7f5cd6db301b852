// Shells as techniques of the runner's own: the vertex stage hands the layer's height on as the
// length of the light's vector, which every surface normalises and none measures.
#include "src/measure/shells.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "src/measure/displaced.h"

namespace intaglio::measure {
namespace {

using namespace dsl;

constexpr int most_layers = 512;
// Where dropped fragments say they are, and the tile that only they are outside of.
constexpr float far_away = 1e6f, tile_edge = 1e5f;

class ShellVertex : public VertexWork {
  public:
    Vertex transform(int lights) const override {
        Step step("vertex", "View and light in the tangent frame; the light as long as the layer.");
        const float3 position = input<3>("position"), normal = input<3>("normal");
        const float4 tangent_and_layer = input<4>("tangent");
        const float3 tangent = tangent_and_layer.xyz();
        const float1 coded = tangent_and_layer.w(), layer = let("layer", abs(coded));
        const float3 bitangent = let("bitangent", cross(normal, tangent) * (coded / layer));
        const auto to_tangent_space = [&](float3 v) {
            return float3(dot(tangent, v), dot(bitangent, v), dot(normal, v));
        };
        const auto direction_to = [&](std::string_view name) {
            const float4 place =
                uniform<4>(name, "in world space: w = 1 a point, w = 0 a direction");
            return place.xyz() - position * place.w();
        };
        const auto row = [](int i) {
            return uniform_row("view_projection", 4, i, "world to clip space: four rows");
        };
        const float4 place = let("place", float4(position, 1.0f));
        const float3 to_eye = let("world_to_eye", direction_to("eye"));
        const float4 eye_direction = let("eye_direction", float4(to_eye, 0.0f));
        const float4 clip(dot(row(0), place), dot(row(1), place), dot(row(2), place),
                          dot(row(3), place));
        const float2 uv = input<2>("uv");
        const float3 to_eye_here = to_tangent_space(to_eye);
        // The first light's vector is there without lights too: it carries the layer.
        std::vector<float3> to_lights = {normalize(to_tangent_space(direction_to("light"))) *
                                         layer};
        for (int number = 1; number < lights; ++number)
            to_lights.push_back(to_tangent_space(direction_to(name_of_light("light", number))));
        return {clip, uv, to_eye_here, std::move(to_lights),
                float4(clip.zw(), dot(row(2), eye_direction), dot(row(3), eye_direction))};
    }
};

class Shells : public Search {
  public:
    Knob<int> layers{this, "layers", 16, at_least{1}, at_most{most_layers}, "how many shells"};
    Knob<int> fins{this, "fins", 0, at_least{0}, at_most{1}, "1: the mesh has fins too"};
    Knob<float> fin_view{this,       "fin_view",
                         0.35f,      at_least{0},
                         at_most{1}, "sine of the angle below which the surface shows its fins"};
    Knob<int> counting{this,        "counting", 0,
                       at_least{0}, at_most{1}, "1: one layer alone, with every fragment of it"};

    Hit find(const Relief& relief, const Ray& ray) const override {
        Step step("shells", "Keep the fragment where the relief reaches its layer.");
        const float count = static_cast<float>(layers.value());
        // The layer's height is a multiple of 1 / count: what interpolation lost is rounded away.
        const float1 coded = length(input<3>("to_light")) - 1.0f;
        const float1 index = let("layer_index", floor(coded * count + 0.5f));
        const float1 layer = let("layer_height", index * (1.0f / count));
        if (counting.value() == 1) {
            const float1 shown = uniform<1>("shown_layer", "the layer that is drawn, from 0");
            return {kept(ray.uv, abs(index - shown) < 0.5f), layer, bool1(true)};
        }
        const float1 height = let("map_height", relief.height(ray.uv));
        if (fins.value() == 0) return {kept(ray.uv, height >= layer), height, bool1(true)};
        // A fin's height needs no rounding: it is not compared with another of its layer.
        const bool1 is_fin = let("is_fin", coded > 1.5f);
        const float3 eye = input<3>("to_eye");
        const bool1 edge_on = abs(eye.z()) < length(eye) * fin_view.value();
        return {kept(ray.uv, height >= select(is_fin, coded - 2.0f, layer) && (edge_on || !is_fin)),
                height, bool1(true)};
    }

  private:
    static float2 kept(float2 uv, bool1 test) {
        return let("kept", select(test, uv, float2(far_away, far_away)));
    }
};

// Moves a vertex down its normal.
void lower(vulkan::Vertex& vertex, double by) {
    for (std::size_t i = 0; i < 3; ++i)
        vertex.position[i] =
            static_cast<float>(vertex.position[i] - static_cast<double>(vertex.normal[i]) * by);
}

}  // namespace

void add_shells(dsl::Catalogue& catalogue) {
    catalogue.searches.push_back(entry<Search, Shells>(
        "shells", "Layers of the polygon, each kept where the relief reaches it",
        "Lengyel et al. 2001"));
    catalogue.vertex_works.push_back(entry<VertexWork, ShellVertex>(
        "shells", "View and light vectors in tangent space, and the layer's height",
        "Lengyel et al. 2001"));
}

VariantRequest shells_request(VariantRequest request, int layers, bool counting) {
    request.surface = dsl::with_part(request.surface, "search", "shells");
    request.surface = dsl::with_part(request.surface, "vertex", "shells");
    request.knobs.emplace_back("clip_tile", "1");
    request.knobs.emplace_back("layers", std::to_string(layers));
    if (counting) request.knobs.emplace_back("counting", "1");
    return request;
}

VariantRequest with_fins(VariantRequest request) {
    request.knobs.emplace_back("fins", "1");
    return request;
}

Result<vulkan::Mesh> shells_of(const vulkan::Mesh& mesh, int layers, double depth) {
    if (layers < 1 || layers > most_layers)
        return input_error("layers", fmt::format("1 to {} layers; {} is not", most_layers, layers));
    if (Status status = check_mesh_size(mesh.vertices.size() * static_cast<std::size_t>(layers));
        !status)
        return status.error();
    vulkan::Mesh shells;
    for (int layer = 0; layer < layers; ++layer) {
        const double height = static_cast<double>(layer) / layers;
        const std::uint32_t first = static_cast<std::uint32_t>(shells.vertices.size());
        for (vulkan::Vertex vertex : mesh.vertices) {
            lower(vertex, (1 - height) * depth);
            vertex.tangent[3] *= static_cast<float>(1 + height);
            shells.vertices.push_back(vertex);
        }
        for (const std::uint32_t index : mesh.indices) shells.indices.push_back(first + index);
    }
    return shells;
}

Result<vulkan::Mesh> add_fins(vulkan::Mesh shells, const vulkan::Mesh& mesh, double depth) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            edges.insert(std::minmax(mesh.indices[i + k], mesh.indices[i + (k + 1) % 3]));
    if (Status status = check_mesh_size(shells.vertices.size() + edges.size() * 4); !status)
        return status.error();
    for (const auto& [a, b] : edges) {
        const std::uint32_t first = static_cast<std::uint32_t>(shells.vertices.size());
        for (const std::uint32_t end : {a, b})
            for (const int height : {0, 1}) {
                vulkan::Vertex vertex = mesh.vertices[end];
                lower(vertex, (1 - height) * depth);
                vertex.tangent[3] *= static_cast<float>(3 + height);
                shells.vertices.push_back(vertex);
            }
        for (const std::uint32_t corner : {0, 1, 2, 2, 1, 3})
            shells.indices.push_back(first + corner);
    }
    return shells;
}

PassLink shells_link() {
    PassLink link;
    link.uniforms["shown_layer"] = {0};
    return link;
}

Status set_shells(vulkan::Program& program) {
    return program.set_uniform("tile", {-tile_edge, -tile_edge, tile_edge, tile_edge});
}

Result<std::vector<int>> count_overdraw(vulkan::Program& program, int layers) {
    std::vector<int> fragments;
    for (int layer = 0; layer < layers; ++layer) {
        if (Status status = program.set_uniform("shown_layer", {static_cast<float>(layer)});
            !status)
            return status.error();
        const Result<std::vector<vulkan::Picture>> pictures = program.draw();
        if (!pictures) return pictures.error();
        const vulkan::Picture& picture = pictures->front();
        fragments.resize(picture.pixels.size());
        for (std::size_t i = 0; i < fragments.size(); ++i)
            fragments[i] += picture.pixels[i] != mesh_background ? 1 : 0;
    }
    return fragments;
}

}  // namespace intaglio::measure

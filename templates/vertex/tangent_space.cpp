// View and light vectors in tangent space, per vertex.  The bitangent is cross(normal, tangent)
// times the handedness in tangent.w, so that mirrored coordinates keep their light.  Directions are
// homogeneous: w = 1 is a place, w = 0 is at infinity, where the vector is the same at every
// vertex.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

float3 transform_rows(std::string_view name, float4 point, std::string_view comment) {
    return {dot(uniform_row(name, 3, 0, comment), point),
            dot(uniform_row(name, 3, 1, comment), point),
            dot(uniform_row(name, 3, 2, comment), point)};
}

class TangentSpace : public VertexWork {
  public:
    Vertex transform(int lights) const override {
        const std::string_view world = "world", world_comment = "object to world: three rows";
        Step step("vertex", "View and light vectors in the vertex's tangent frame.");
        const auto to_world = [&](std::string_view name, float4 v) {
            return let(name,
                       transform_rows(world, let(std::string(name) + "_in", v), world_comment));
        };
        const float3 position = to_world("world_position", float4(input<3>("position"), 1.0f));
        const float3 normal =
            let("world_normal",
                normalize(to_world("normal_direction", float4(input<3>("normal"), 0.0f))));
        const float4 tangent_and_side = input<4>("tangent");
        const float3 tangent =
            let("world_tangent",
                normalize(to_world("tangent_direction", float4(tangent_and_side.xyz(), 0.0f))));
        const float3 bitangent =
            let("world_bitangent", cross(normal, tangent) * tangent_and_side.w());

        const auto to_tangent_space = [&](float3 v) {
            return float3(dot(tangent, v), dot(bitangent, v), dot(normal, v));
        };
        const auto direction_to = [&](float4 place) { return place.xyz() - position * place.w(); };
        const float4 eye =
            uniform<4>("eye", "eye in world space: w = 1 a point, w = 0 a direction");
        std::vector<float4> light_places;
        for (int number = 0; number < lights; ++number)
            light_places.push_back(
                uniform<4>(name_of_light("light", number),
                           "light in world space: w = 1 a point, w = 0 a direction"));
        const float3 world_to_eye = let("world_to_eye", direction_to(eye));
        std::vector<float3> world_to_lights;
        for (int number = 0; number < lights; ++number)
            world_to_lights.push_back(
                let(name_of_light("world_to_light", number),
                    direction_to(light_places[static_cast<std::size_t>(number)])));

        const float4 place = let("place", float4(position, 1.0f));
        const auto row = [](int i) {
            return uniform_row("view_projection", 4, i, "world to clip space: four rows");
        };
        const float4 position_in_clip(dot(row(0), place), dot(row(1), place), dot(row(2), place),
                                      dot(row(3), place));
        const float4 eye_direction = let("eye_direction", float4(world_to_eye, 0.0f));
        const float2 uv = input<2>("uv");
        const float3 to_eye = to_tangent_space(world_to_eye);
        std::vector<float3> to_lights;
        for (const float3& world_to_light : world_to_lights)
            to_lights.push_back(to_tangent_space(world_to_light));
        return {
            position_in_clip, uv, to_eye, std::move(to_lights),
            float4(position_in_clip.zw(), dot(row(2), eye_direction), dot(row(3), eye_direction))};
    }
};

}  // namespace

dsl::Entry<dsl::VertexWork> vertex_tangent_space() {
    return dsl::entry<dsl::VertexWork, TangentSpace>("tangent_space",
                                                     "View and light vectors in tangent space", "");
}

}  // namespace intaglio::templates

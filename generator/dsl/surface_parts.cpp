// The pieces of a surface's recording.
#include "generator/dsl/surface_parts.h"

namespace intaglio::dsl {

float3 unit_input(std::string_view name, std::string_view unit_name) {
    return let(unit_name, normalize(input<3>(name)));
}

float1 relief_scale() { return uniform<1>("scale", "depth of the relief in texture units"); }

Relief make_relief(const Surface& surface) {
    const bool packed = surface.relief->packed == 1;
    const sampler2D map =
        packed ? sampler2D("normal_map", "tangent-space normal in rgb, height in alpha")
               : sampler2D("height_map", "height in red: 1 is the polygon, 0 the deepest");
    const float2 map_size = uniform<2>("map_size", "size of the height map in texels");
    Relief relief{map, packed, relief_scale(), map_size, float1(surface.relief->level.value())};
    relief.known_level = surface.relief->level.value();
    return relief;
}

Hit PolygonPoint::continuous(const Hit& local_hit) const {
    Hit hit = local_hit;
    if (tile) hit.uv = let("displaced_uv", local_hit.uv + *tile);
    return hit;
}

PolygonPoint polygon_point(const Surface& surface, float2 uv) {
    if (surface.relief->local_origin == 0) return {uv, uv};
    return {uv, let("local_uv", frac(uv)), let("tile", floor(uv))};
}

Ray make_ray(const Surface& surface, const Relief& relief, const PolygonPoint& from, float3 view) {
    Ray ray = surface.relief->ray_per_vertex == 0 ? Ray::through(relief, from.local, view)
                                                  : Ray{from.local, view, input<2>("reach")};
    if (from.tile) ray.polygon_uv = from.uv;
    return ray;
}

void add_settings(const Surface& surface, const Technique& technique,
                  std::vector<std::string>& settings) {
    const bool is_lighting = &technique == surface.lighting.get();
    if (&technique == surface.shadow.get() && surface.lighting->shadowing() == 0) return;
    for (const KnobBase* knob : technique.knobs())
        if (!is_lighting || knob->number() != knob->initial()) settings.push_back(knob->setting());
}

Status check_techniques(const Surface& surface) {
    for (const Technique* technique : surface.techniques())
        if (Status status = technique->check(); !status) return status;
    return Done{};
}

bool apply_schedules(const Surface& surface, const RecordOptions& options, Recorder& recorder) {
    Schedule schedule(options.target);
    for (const Technique* technique : surface.techniques()) technique->schedule(schedule);
    schedule.apply(recorder);
    for (const auto& [loop, form] : options.loop_forms) recorder.override_loop_form(loop, form);
    return schedule.moves_to_vertex() || options.per_vertex;
}

float1 inside_tile(const Hit& hit) {
    const float4 tile = uniform<4>(
        "tile", "part of the map that the polygon wears: least uv in xy, greatest in zw");
    const float2 least = hit.uv - tile.xy(), greatest = tile.zw() - hit.uv;
    return let("inside", min(min(least.x(), least.y()), min(greatest.x(), greatest.y())));
}

float3 shade(const Surface& surface, const Relief& relief, const Hit& hit, float2 uv, float3 view,
             const std::vector<Light>& lights) {
    Step step("shading",
              "Shade the point with its own normal and colour, read where the ray met the relief.");
    const Footprint footprint{let("ddx_uv", ddx(uv)), let("ddy_uv", ddy(uv))};
    const float3 normal = let("normal", surface.normal->normal(relief, hit, footprint));
    const sampler2D colour_map("colour_map", "albedo");
    const float3 albedo =
        let("albedo", colour_map.sample_grad(hit.uv, footprint.ddx_uv, footprint.ddy_uv).xyz());
    const Fragment fragment{normal, view, albedo, relief, hit, footprint};
    float3 diffuse = surface.shading->ambient(fragment);
    std::optional<float3> specular;
    for (const Light& light : lights) {
        const Reflected reflected = surface.shading->reflect(fragment, light);
        if (reflected.diffuse) diffuse = diffuse + *reflected.diffuse;
        if (reflected.specular)
            specular = specular ? *specular + *reflected.specular : *reflected.specular;
    }
    const float3 dimmed = albedo * diffuse;
    return specular ? dimmed + *specular : dimmed;
}

}  // namespace intaglio::dsl

// The pieces that every recording of a surface is made of, whole, in passes or as a function.
// Internal to generator/dsl.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/dsl/surface.h"

namespace intaglio::dsl {

// An interpolated or given vector, made unit: neither arrives so.
float3 unit_input(std::string_view name, std::string_view unit_name);
float1 relief_scale();
Relief make_relief(const Surface& surface);

// Where a pixel looks at the polygon.  With local_origin the maps are read from `local` on, in
// their first tile; whoever reads coordinates outside of the shader gets continuous ones.
struct PolygonPoint {
    float2 uv, local;                 // the same without local_origin
    std::optional<float2> tile = {};  // uv - local, whole numbers; empty: 0

    Hit continuous(const Hit& local_hit) const;
};
PolygonPoint polygon_point(const Surface& surface, float2 uv);

Ray make_ray(const Surface& surface, const Relief& relief, const PolygonPoint& from, float3 view);

// The knobs of one technique of the surface, as Surface::settings has them.
void add_settings(const Surface& surface, const Technique& technique,
                  std::vector<std::string>& settings);
Status check_techniques(const Surface& surface);
// Applies schedules and the caller's overrides; gives whether any schedule moves work to the vertex
// stage.
bool apply_schedules(const Surface& surface, const RecordOptions& options, Recorder& recorder);

// How far the hit lies inside the part of the map that the polygon wears; below 0 outside.  The
// hit is a continuous one.
float1 inside_tile(const Hit& hit);

// The colour of the point that the ray met; `uv` is where the ray entered, continuous.
float3 shade(const Surface& surface, const Relief& relief, const Hit& hit, float2 uv, float3 view,
             const std::vector<Light>& lights);

}  // namespace intaglio::dsl

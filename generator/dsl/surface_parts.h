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
Ray make_ray(const Surface& surface, const Relief& relief, float2 uv, float3 view);

// The knobs of one technique of the surface, as Surface::settings has them.
void add_settings(const Surface& surface, const Technique& technique,
                  std::vector<std::string>& settings);
Status check_techniques(const Surface& surface);
// Applies schedules and the caller's overrides; gives whether any schedule moves work to the vertex
// stage.
bool apply_schedules(const Surface& surface, const RecordOptions& options, Recorder& recorder);

// How far the hit lies inside the part of the map that the polygon wears; below 0 outside.
float1 inside_tile(const Hit& hit);

// The colour of the point that the ray met; `uv` is where the ray entered.
float3 shade(const Surface& surface, const Relief& relief, const Hit& hit, float2 uv, float3 view,
             const std::vector<Light>& lights);

}  // namespace intaglio::dsl

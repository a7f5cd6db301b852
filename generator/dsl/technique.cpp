// Relief, ray and lights.
#include "generator/dsl/technique.h"

#include <cmath>

#include <fmt/format.h>

namespace intaglio::dsl {

float1 Relief::height_at_level(float2 uv, float1 mip_level, Place place) const {
    const float4 texel = map.sample_level(uv, mip_level, place);
    return in_section(height_of(texel));
}

float2 Relief::level_size() const {
    const float coarser = std::floor(known_level);
    if (coarser == 0) return map_size;
    return let("level_size", max(floor(map_size * std::exp2(-coarser)), 1.0f));
}

// Section k of n runs from height 1 - k / n down to 1 - (k + 1) / n.
float1 Relief::in_section(float1 whole) const {
    if (sections == 1) return whole;
    return whole * static_cast<float>(sections) - static_cast<float>(sections - 1 - section);
}

float1 Relief::in_whole(float1 in_section) const {
    if (sections == 1) return in_section;
    const float share = 1.0f / static_cast<float>(sections);
    return in_section * share + static_cast<float>(sections - 1 - section) * share;
}

float2 Ray::reach_of(float1 scale, float3 view) {
    return let("reach", view.xy() / max(view.z(), float1(least_z)) * scale);
}

std::string name_of_light(std::string_view name, int number) {
    return number == 0 ? std::string(name) : fmt::format("{}_{}", name, number);
}

float3 Light::colour() const {
    return uniform<3>(name_of_light("light_colour", number), "colour of the light, linear rgb");
}

float3 Shading::ambient(const Fragment&) const {
    return uniform<3>("ambient", "ambient light, linear rgb");
}

}  // namespace intaglio::dsl

// Relief and ray.
#include "generator/dsl/technique.h"

namespace intaglio::dsl {

float1 Relief::height_at_level(float2 uv, float1 mip_level, Place place) const {
    const float4 texel = map.sample_level(uv, mip_level, place);
    return in_alpha ? texel.w() : texel.x();
}

float2 Ray::reach_of(float1 scale, float3 view) {
    return let("reach", view.xy() / max(view.z(), float1(least_z)) * scale);
}

}  // namespace intaglio::dsl

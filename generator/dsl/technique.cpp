// Relief and ray.
#include "generator/dsl/technique.h"

namespace intaglio::dsl {

float1 Relief::height_at_level(float2 uv, float1 mip_level, Place place) const {
    const float4 texel = map.sample_level(uv, mip_level, place);
    return in_alpha ? texel.w() : texel.x();
}

Ray Ray::through(const Relief& relief, float2 uv, float3 view) {
    const float2 reach = let("reach", view.xy() / max(view.z(), float1(least_z)) * relief.scale);
    return {uv, view, reach};
}

}  // namespace intaglio::dsl

// Emboss bump mapping: the height where we are less the height a little towards the light is the
// slope that the light sees.  Schlag, "Fast Embossing Effects on Raster Image Data", Graphics Gems
// IV, 1994; named among their forerunners by Brawley and Tatarchuk, ShaderX3, 2004.
//
// It is Blinn's N' = N - h_u scale P_u - h_v scale P_v dotted with L and not normalised,
//     N'.L = L.z - scale (h_u L.x + h_v L.y),
// with the bracket as one difference along L.xy.  So it needs no normal, and errs by what 1 / |N'|
// would have dimmed: it is too bright on steep slopes.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Emboss : public Shading {
  public:
    Knob<float> distance{
        this,          "emboss_distance",
        1.0f,          at_least{0.125},
        at_most{64.0}, "texels between the two heights, for a light at the horizon"};

    Reflected reflect(const Fragment& fragment, const Light& light) const override {
        const float3 colour = light.colour();
        const Relief& relief = fragment.relief;
        const auto height = [&](float2 uv) {
            return relief.height_of(
                relief.map.sample_grad(uv, fragment.footprint.ddx_uv, fragment.footprint.ddy_uv));
        };
        const float1 per_unit = let(
            "per_unit", max(relief.map_size.x(), relief.map_size.y()) * (1.0f / distance.value()));
        const float2 towards_light =
            let("towards_light", fragment.hit.uv + light.direction.xy() / per_unit);
        const float1 fall = let("fall", height(fragment.hit.uv) - height(towards_light));
        const float1 slope = let("slope", fall * (relief.scale * per_unit));
        const float1 diffuse = let("diffuse", select(light.direction.z() > 0.0f,
                                                     saturate(light.direction.z() + slope), 0.0f));
        return {colour * (diffuse * light.visibility)};
    }
};

}  // namespace

dsl::Entry<dsl::Shading> shading_emboss() {
    return dsl::entry<dsl::Shading, Emboss>(
        "emboss", "Diffuse light from the difference of two heights along the light",
        "Schlag 1994");
}

}  // namespace intaglio::templates

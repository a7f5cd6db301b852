// Fast bump mapping: brightness is read from a phong map at the polygon's own place in it plus the
// bump's offset; one read in place of products and powers.  "Fast Bump Mapping" (seeds).
//
// The source's pointer is the polygon's normal seen along the light's two map vectors and its
// offsets are the differences of the height map.  Ours: the pointer is where the halfway vector
// leans, -H.xy, the offset the bumped normal's own lean, N.xy, so that the map's centre is where
// both agree.  The same map serves diffuse light and highlight, as in the source, where light and
// eye are one; with the light far from the eye the diffuse part leans halfway to the eye.
#include <fmt/format.h>

#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

constexpr float edge = 1.125f;  // the offset at the map's edge

class PhongMap : public Shading {
  public:
    Knob<float> shininess{this,        "shininess",  32.0f,
                          at_least{1}, at_most{256}, "exponent of the highlight, as baked"};

    Reflected reflect(const Fragment& fragment, const Light& light) const override {
        const float3 colour = light.colour();
        const float1 gloss = uniform<1>("gloss", "strength of the highlight");
        const sampler2D map("phong_map", "diffuse light in red, highlight in alpha, by offset",
                            sampler2D::Filter::Linear,
                            fmt::format("shininess={}", shininess.value()));

        const float3 halfway =
            let("halfway", normalize(let("between", light.direction + fragment.view)));
        const float2 offset = let("offset", fragment.normal.xy() - halfway.xy());
        const float4 brightness =
            let("brightness", map.sample_level(saturate(offset * (0.5f / edge) + 0.5f), 0.0f));
        const float1 facing = select(light.direction.z() > 0.0f, light.visibility, 0.0f);
        const float3 highlights = colour * (gloss * brightness.w() * facing);
        return {colour * (brightness.x() * facing), highlights};
    }
};

}  // namespace

dsl::Entry<dsl::Shading> shading_phong_map() {
    return dsl::entry<dsl::Shading, PhongMap>(
        "phong_map", "Brightness from a baked map at the bump's offset: one read",
        "Fast Bump Mapping");
}

}  // namespace intaglio::templates

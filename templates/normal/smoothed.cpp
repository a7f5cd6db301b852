// Normals smoothed along the gradient, so that the slices of a march do not show: the normal where
// the ray met the relief, added to the one found a little downhill, where that normal points.
// McGuire and McGuire, "Steep Parallax Mapping", page of 2005, the line that the listing leaves
// commented out.
//
// The page adds vec2(n.x, -n.y) * mipScale: its bitmaps have row 0 at the bottom, ours at the top,
// and n points along +v here as it does in the map.  It leaves mipScale open ("a function of the
// resolution and of the bump scale and number of steps"); ours is counted in texels.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Smoothed : public NormalSource {
  public:
    Knob<float> distance{this,        "smoothing",
                         2.0f,        at_least{0},
                         at_most{64}, "texels to the second normal, times the sine of the slope"};

    float3 normal(const Relief& relief, const Hit& hit, const Footprint& footprint) const override {
        const sampler2D map("normal_map", "tangent-space normal in rgb, height in alpha");
        const auto unpacked = [&](float2 uv) {
            return map.sample_grad(uv, footprint.ddx_uv, footprint.ddy_uv).xyz() * 2.0f - 1.0f;
        };
        const float3 here = let("unpacked", unpacked(hit.uv));
        const float2 downhill =
            let("downhill", hit.uv + here.xy() * (float2(distance.value()) / relief.map_size));
        return normalize(let("smoothed", here + unpacked(downhill)));
    }
};

}  // namespace

dsl::Entry<dsl::NormalSource> normal_smoothed() {
    return dsl::entry<dsl::NormalSource, Smoothed>(
        "smoothed", "Normals from a normal map, smoothed downhill so that slices do not show",
        "McGuire and McGuire 2005");
}

}  // namespace intaglio::templates

// Normals from a normal map, read at the displaced coordinate.  The level comes from the
// undisplaced coordinate: at a silhouette inside the relief the displaced one jumps, and its
// derivatives would pick a wrong level there.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Map : public NormalSource {
  public:
    float3 normal(const Relief&, const Hit& hit, const Footprint& footprint) const override {
        const sampler2D map("normal_map", "tangent-space normal in rgb, height in alpha");
        const float4 texel = map.sample_grad(hit.uv, footprint.ddx_uv, footprint.ddy_uv);
        return normalize(let("unpacked", texel.xyz() * 2.0f - 1.0f));
    }
};

}  // namespace

dsl::Entry<dsl::NormalSource> normal_map() {
    return dsl::entry<dsl::NormalSource, Map>("map", "Normals from a normal map", "");
}

}  // namespace intaglio::templates

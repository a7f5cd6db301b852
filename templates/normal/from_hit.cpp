// The normal of the surface that an exact search meets: between four texel centres the relief is a
// bilinear patch, and its slopes at the hit follow from the four heights.  Ours.
//
// The heights are read at texel centres, where filter weights are 0 and 1, so that what a device's
// filter rounds plays no part.  The normal jumps from cell to cell, as the patches' slopes do.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class FromHit : public NormalSource {
  public:
    float3 normal(const Relief& relief, const Hit& hit, const Footprint&) const override {
        const float2 size = relief.level_size();
        // The first tile, where float coordinates are finest.
        const float2 texel = let("texel", frac(hit.uv) * size - 0.5f);
        const float2 corner = let("corner", floor(texel));
        const float2 inside = let("inside", texel - corner);
        const auto height = [&](float right, float below) {
            const float2 centre = corner + float2(right + 0.5f, below + 0.5f);
            return relief.height(centre / size);
        };
        const float1 h00 = height(0, 0), h10 = height(1, 0);
        const float1 h01 = height(0, 1), h11 = height(1, 1);
        const float2 slope = let("slope", float2(lerp(h10 - h00, h11 - h01, inside.y()),
                                                 lerp(h01 - h00, h11 - h10, inside.x())) *
                                              size * relief.scale);
        return normalize(let("patch_normal", float3(-slope, 1.0f)));
    }
};

}  // namespace

dsl::Entry<dsl::NormalSource> normal_from_hit() {
    return dsl::entry<dsl::NormalSource, FromHit>(
        "from_hit", "The normal of the bilinear patch where the ray met it", "");
}

}  // namespace intaglio::templates

// Soft self-shadow from eight reads: the point's own height and seven along the light ray, each
// weighed by how near it is, because what is near throws the harder shadow; the worst of them
// decides.  No address depends on a read, so that all eight are under way at once.  Tatarchuk,
// "Dynamic Parallax Occlusion Mapping with Approximate Soft Shadows", I3D 2006.
//
// The source follows L.xy without the division by L.z, so that low lights throw the shadows of high
// ones; ours divides, and `soft_undivided` brings the source's ray back.
#include <array>

#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

struct Tap {
    float rise, weight;  // how far up the light ray, and how hard a shadow from there is
};
constexpr std::array<Tap, 7> taps = {
    {{0.88f, 1}, {0.77f, 2}, {0.66f, 4}, {0.55f, 6}, {0.44f, 8}, {0.33f, 10}, {0.22f, 12}}};

class Soft : public Shadow {
  public:
    Knob<float> softening{this,        "softening",
                          0.58f,       at_least{0},
                          at_most{16}, "strength of the shadow per height above the light ray"};
    Knob<int> undivided{this,       "soft_undivided",
                        0,          at_least{0},
                        at_most{1}, "1: the light ray is L.xy, as in the source; 0: L.xy / L.z"};

    float1 visibility(const Relief& relief, const Hit& hit, float3 light) const override {
        const float2 slope =
            undivided.value() == 1 ? light.xy() : light.xy() / max(light.z(), float1(Ray::least_z));
        const float2 reach = let("shadow_reach", slope * relief.scale);
        // Read anew: searches that interpolate report the ray's height, not the relief's.
        const float1 start = let("shadow_start", relief.height(hit.uv));
        var<float1> worst{"occlusion", 0.0f};
        for (const Tap& tap : taps) {
            const float1 above = relief.height(hit.uv + reach * tap.rise) - start - tap.rise;
            worst = max(worst, above * (tap.weight * softening.value()));
        }
        return let("lit", select(light.z() > 0.0f, 1.0f - min(worst, 1.0f), 0.0f));
    }
};

}  // namespace

dsl::Entry<dsl::Shadow> shadow_soft() {
    return dsl::entry<dsl::Shadow, Soft>(
        "soft", "The worst of seven weighed samples towards the light: penumbrae from eight reads",
        "Tatarchuk 2006");
}

}  // namespace intaglio::templates

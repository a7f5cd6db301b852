// Horizon mapping: the light is compared with how high the relief stands in its direction, baked
// for eight azimuths.  Max, "Horizon Mapping: Shadows for Bump-Mapped Surfaces", The Visual
// Computer, 1988; Sloan and Cohen, "Interactive Horizon Mapping", 2000, whose two maps of four
// azimuths and weights by direction these are.
//
// The sources store angles and so one depth of the relief; the maps here hold slopes
// (docs/maps.md), and the scale comes in at run time.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

constexpr float middle = 16.0f;        // the slope that is stored as one half
constexpr float cosine = 0.70710678f;  // of the 45 degrees between two azimuths

class Horizon : public Shadow {
  public:
    float1 visibility(const Relief& relief, const Hit& hit, float3 light) const override {
        const sampler2D axes("horizon_map", "horizon towards +u, +v, -u and -v");
        const sampler2D diagonals("horizon_diagonal_map",
                                  "horizon towards +u+v, -u+v, -u-v and +u-v");
        const float1 flat = let("flat", length(light.xy()));
        const float2 d = let("azimuth", light.xy() / max(flat, tiny));
        const float1 sum = (d.x() + d.y()) * cosine, difference = (d.x() - d.y()) * cosine;
        // An azimuth counts the more the nearer it is, and not at all 45 degrees away.
        const auto weights = [](std::string_view name, float1 first, float1 second) {
            return let(name, max(float4(first, second, -first, -second) - cosine, 0.0f));
        };
        const float4 on_axes = weights("on_axes", d.x(), d.y());
        const float4 on_diagonals = weights("on_diagonals", sum, -difference);
        const float4 one(1.0f);
        const float1 horizon =
            let("horizon", (dot(on_axes, axes.sample_level(hit.uv, 0.0f)) +
                            dot(on_diagonals, diagonals.sample_level(hit.uv, 0.0f))) /
                               max(dot(on_axes + on_diagonals, one), tiny));
        const float1 scale = relief.sections == 1
                                 ? relief.scale
                                 : relief.scale * static_cast<float>(relief.sections);
        const bool1 above = light.z() * (1 - horizon) >= horizon * flat * scale * middle;
        return select(light.z() > 0.0f && above, float1(1.0f), 0.0f);
    }
};

}  // namespace

dsl::Entry<dsl::Shadow> shadow_horizon() {
    return dsl::entry<dsl::Shadow, Horizon>(
        "horizon", "The light against baked horizons in eight azimuths: two reads",
        "Max 1988; Sloan and Cohen 2000");
}

}  // namespace intaglio::templates

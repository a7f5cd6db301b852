// The chapter's shadow: from the displaced coordinate, read the height profile along the light's
// parallax vector, and ask whether any sample is above the light ray; no intersection is solved.
// Brawley and Tatarchuk, "Parallax Occlusion Mapping", ShaderX3, 2004, section "Self-Occlusion and
// Shadowing Computation".
//
// The chapter prints no listing.  The samples of ours lie between the point and the place where the
// ray leaves through the top: above it nothing can be in the way.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class OcclusionProfile : public Shadow {
  public:
    Knob<int> taps{this, "shadow_taps", 8, at_least{1}, at_most{256}, "height reads to the light"};
    Knob<float> bias{this,       "profile_bias",
                     0.0f,       at_least{0},
                     at_most{1}, "height that a sample may rise above the light ray and not shade"};
    Loop profile{"shadow_profile", taps};

    float1 visibility(const Relief& relief, const Hit& hit, float3 light) const override {
        const float2 reach =
            let("shadow_reach", light.xy() / max(light.z(), float1(Ray::least_z)) * relief.scale);
        const float1 step = let("shadow_step", max(1.0f - hit.height, 0.0f) *
                                                   (1.0f / static_cast<float>(taps.value() + 1)));
        // How far the profile has risen above the ray; the surface itself touches it.
        var<float1> above{"shadow_gap", 0.0f};
        for (int1 i : profile) {
            profile.until(above > bias.value());
            const float1 rise = let("rise", (i + 1) * step);
            above = relief.height(hit.uv + reach * rise) - (hit.height + rise);
        }
        return let("lit", select(light.z() > 0.0f && above <= bias.value(), float1(1.0f), 0.0f));
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(profile);
        s.on("*").loop(profile);
    }
};

}  // namespace

dsl::Entry<dsl::Shadow> shadow_occlusion_profile() {
    return dsl::entry<dsl::Shadow, OcclusionProfile>(
        "occlusion_profile", "In shadow where any sample of the profile is above the light ray",
        "Brawley and Tatarchuk 2004");
}

}  // namespace intaglio::templates

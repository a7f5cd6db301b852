// The self-shadow loop: march from the point we see towards the light; in shadow if the relief
// rises to the ray before the ray leaves through the top.  McGuire and McGuire, "Steep Parallax
// Mapping", page of 2005, shadow section.
//
// The page's listing starts 0.1 step above the point (against shadow acne), and counts 60 steps at
// the horizon, 5 at the zenith.  Its loop lost its braces and its selfShadow keeps the relief's
// height below the ray's as "lit"; we read it so. With the light at or below the horizon nothing is
// lit.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class March : public Shadow {
  public:
    Knob<int> min_steps{
        this,        "shadow_min_steps", 5,
        at_least{1}, at_most{512},       "shadow steps with the light at the zenith"};
    Knob<int> max_steps{this,         "shadow_max_steps",
                        60,           at_least{1},
                        at_most{512}, "shadow steps with the light at the horizon"};
    Knob<float> start{this,        "shadow_start", 0.1f,
                      at_least{0}, at_most{1},     "start above the surface, in steps"};
    Loop march{"shadow_march", max_steps};

    float1 visibility(const Relief& relief, const Hit& hit, float3 light) const override {
        const float1 steps = step_count(light);
        const float1 step = let("shadow_step", 1.0f / steps);
        const float2 reach =
            let("shadow_reach", light.xy() / max(light.z(), float1(Ray::least_z)) * relief.scale);

        var<float1> rise{"rise", start.value() * step}, height{"shadow_height", hit.height};
        for (int1 i : march) {
            const float1 ray_height = let("light_ray_height", hit.height + rise);
            march.until(height >= ray_height || ray_height >= 1.0f);
            height = relief.height(hit.uv + reach * ((i + 1) * step));
            rise = ((i + 1) + start.value()) * step;
        }
        const bool1 lit = light.z() > 0.0f && height < hit.height + rise;
        return select(lit, float1(1.0f), 0.0f);
    }

    Status check() const override {
        if (min_steps > max_steps)
            return input_error("knob-relation",
                               "shadow_min_steps is above shadow_max_steps; steps run from the "
                               "first (zenith) to the second (horizon)");
        return Done{};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march);
        s.on("*").loop(march);
    }

  private:
    float1 step_count(float3 light) const {
        if (min_steps == max_steps) return static_cast<float>(max_steps.value());
        const float1 wanted = lerp(float1(static_cast<float>(max_steps.value())),
                                   static_cast<float>(min_steps.value()), saturate(light.z()));
        return let("shadow_steps", floor(wanted + 0.5f));
    }
};

}  // namespace

dsl::Entry<dsl::Shadow> shadow_march() {
    return dsl::entry<dsl::Shadow, March>(
        "march", "A march towards the light that stops at the top of the relief",
        "McGuire and McGuire 2005");
}

}  // namespace intaglio::templates

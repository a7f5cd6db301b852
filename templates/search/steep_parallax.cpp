// Steep parallax mapping: march the view ray down in equal steps, more of them the flatter the ray,
// and stop at the first sample that is not below it.  McGuire and McGuire, "Steep Parallax
// Mapping", I3D 2005 poster and page.
//
// The page's listing lost its loop's closing brace and flips y for the bitmap's orientation; E
// there points to the eye as V does here.  It interpolates the step count over N.V between numSteps
// * 2 and numSteps, and mentions lerp(60, 10, z): both are the knobs min_steps and max_steps.  We
// round the count, so that the last step ends on the floor.  `nyquist` chooses the mip level on
// which a step is at most one texel, the page's guard against missed features, in place of the
// relief's own level.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class SteepParallax : public Search {
  public:
    Knob<int> min_steps{this,        "min_steps",  10,
                        at_least{1}, at_most{512}, "steps when looking straight down"};
    Knob<int> max_steps{this,        "max_steps",  60,
                        at_least{1}, at_most{512}, "steps at the most grazing view"};
    Knob<int> nyquist{this,       "nyquist",
                      0,          at_least{0},
                      at_most{1}, "1: read on the mip level where a step is at most one texel"};
    Loop march{"march", max_steps};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const float1 steps = step_count(ray);
        const float1 step = let("step", 1.0f / steps);
        const float1 level =
            nyquist.value() == 1 ? level_below_nyquist(relief, ray, step) : relief.level;

        Step marching("march", "March the ray down until it is no longer above the relief.");
        var<float1> t{"t", 0.0f}, height{"height", relief.height_at_level(ray.uv, level)};
        for (int1 i : march) {
            const float1 ray_height = let("ray_height", 1 - t);
            march.until(height >= ray_height);
            t = min((i + 1) * step, 1.0f);
            height = relief.height_at_level(ray.at(t), level);
        }
        // The height is the relief's, not the ray's, which is up to a step below it: shadows start
        // there.
        return {let("displaced", ray.at(t)), height, height >= 1 - t};
    }

    Status check() const override {
        if (min_steps > max_steps)
            return input_error("knob-relation",
                               "min_steps is above max_steps; steps run from min_steps (straight "
                               "down) to max_steps (grazing)");
        return Done{};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march);
        s.on("*").loop(march);
    }

  private:
    float1 step_count(const Ray& ray) const {
        if (min_steps == max_steps) return static_cast<float>(max_steps.value());
        const float1 wanted = lerp(float1(static_cast<float>(max_steps.value())),
                                   static_cast<float>(min_steps.value()), saturate(ray.view.z()));
        return let("steps", floor(wanted + 0.5f));
    }

    // log2 of the texels that one step crosses, and never below the finest level.
    float1 level_below_nyquist(const Relief& relief, const Ray& ray, float1 step) const {
        const float2 texels = let("texels", abs(ray.reach * step * relief.map_size));
        return let("level", log2(max(max(texels.x(), texels.y()), 1.0f)));
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_steep_parallax() {
    return dsl::entry<dsl::Search, SteepParallax>(
        "steep_parallax",
        "A march in equal height steps that stops at the first sample above the ray",
        "McGuire and McGuire 2005");
}

}  // namespace intaglio::templates

// Parallax occlusion mapping: read the height profile along the view ray in equal steps, stop at
// the first sample that rises above the ray, and intersect the ray with the profile's last segment.
// Brawley and Tatarchuk, "Parallax Occlusion Mapping: Self-Shadowing, Perspective-Correct Bump
// Mapping Using Reverse Height Map Tracing", ShaderX3, 2004.
//
// The chapter's listing numbers its samples from the bottom (h0 at the ray's end) and takes its
// parallax vector in the vertex shader; ours counts from the top and computes the vector per pixel.
// Like the listing we spend no read on the entry point: the profile before the first tap is level
// with it.  The last tap lies on the floor of the relief, so one tap always rises above the ray.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class ParallaxOcclusion : public Search {
  public:
    Knob<int> taps{this, "taps", 8, at_least{1}, at_most{256}, "height reads along the ray"};
    Loop march{"march", taps, -1};  // the first tap stands before the loop

    Hit find(const Relief& relief, const Ray& ray) const override {
        const float step = 1.0f / static_cast<float>(taps.value());
        // How far the relief rises above the ray at t; below 0 the ray is still outside.
        const auto gap = [&](float1 t) { return relief.height(ray.at(t)) - (1 - t); };

        var<float1> t{"t", step}, below{"below", gap(step)};
        var<float1> above{"above", ray.entry_height ? *ray.entry_height - 1.0f : below - step};
        {
            Step marching("march",
                          "Walk down the ray until a sample of the height profile rises above it.");
            for (int1 i : march) {
                march.until(below >= 0.0f);
                above = below;
                t = (i + 2) * step;  // from i, so that the taps do not depend on each other
                below = gap(t);
            }
        }
        Step refining("refine", "Intersect the ray with the last segment of the profile.");
        const float1 hit = let("hit", t - step * ratio(below, below - above));
        // Where nothing was found the last gap is the relief's height: there the ray is at 0.
        return {let("displaced", ray.at(hit)), 1 - hit, below >= 0.0f, below};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march);
        s.on("*").loop(march);
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_parallax_occlusion() {
    return dsl::entry<dsl::Search, ParallaxOcclusion>(
        "parallax_occlusion",
        "Equal steps along the view ray, then one intersection with the last segment",
        "Brawley and Tatarchuk 2004");
}

}  // namespace intaglio::templates

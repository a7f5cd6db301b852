// Sphere tracing in a volume of distances: wherever the ray is, the volume says how large a ball
// around it is empty.  Donnelly, "Per-Pixel Displacement Mapping with Distance Functions", GPU Gems
// 2, 2005.
//
// The source reads distances between voxels linearly, which may be too much, and stops after a
// fixed number of steps wherever it is.  Ours are never too much (docs/maps.md) and so are 0 next
// to the relief; there the ray goes on by a least step until the relief's own height is above it,
// and the last step is intersected.  Of the combined class: what is thinner than that step may be
// missed, nothing else.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

// Of the baked volume: its slices, and the square of how deep it takes the relief to be, in
// texture units.
constexpr float slices = 32;
constexpr float depth_squared = 1.0f / 64;

class DistanceFunction : public Search {
  public:
    Knob<int> ball_steps{this,        "ball_steps", 32,
                         at_least{1}, at_most{512}, "balls and least steps at most"};
    Knob<float> least_step{this,       "least_step",
                           0.02f,      at_least{0.0001f},
                           at_most{1}, "the step next to the relief, in height"};
    Loop march{"march", ball_steps};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const sampler3D map("distance_map", "radius of the empty ball, per depth of the volume",
                            sampler3D::Filter::Nearest);
        const float parts = static_cast<float>(relief.sections);
        const float2 whole_reach = relief.sections == 1 ? ray.reach : ray.reach * parts;
        // Height that a ball of radius 1 lets the ray descend.
        const float1 descent = let("descent", parts * rsqrt(1.0f + dot(whole_reach, whole_reach) *
                                                                       (1.0f / depth_squared)));
        const float steps = static_cast<float>(ball_steps.value());
        Step marching("march", "Step over empty balls, until the relief is above the ray.");
        var<float1> t{"t", 0.0f}, step{"step", 0.0f}, above{"above", 0.0f};
        var<float1> gap{"gap", relief.height(ray.uv) - 1.0f};
        for (int1 i : march) {
            march.until(gap >= 0.0f || t >= 1.0f);
            const float2 at = let("at", ray.at(t));
            const float1 height = relief.in_whole(1 - t);
            const float1 slice = height * ((slices - 1) / slices) + 0.5f / slices;
            const float1 radius = let("radius", map.sample_level(float3(at, slice), 0.0f).x());
            // A section is left to the next at its floor and nowhere else, so its steps must reach
            // it: where least steps are too short for that, what is left is shared out evenly.
            const float1 least = relief.sections == 1
                                     ? float1(least_step.value())
                                     : max((1 - t) / (steps - i * 1.0f), least_step.value());
            step = min(max(radius * descent, least), 1 - t);
            t = t + step;
            above = gap;
            gap = relief.height(ray.at(t)) - (1 - t);
        }
        // The last step's crossing, both sides taken as straight; none went in: its end.
        const float1 back = let("back", saturate(gap / max(gap - above, tiny)));
        const float1 hit = let("hit", t - step * select(gap >= 0.0f, back, 0.0f));
        const bool last = relief.section + 1 == relief.sections;
        return {let("displaced", ray.at(hit)), 1 - hit,
                last ? bool1(true) : gap >= 0.0f || t < 1.0f, gap};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march);
        s.on("*").loop(march);
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_distance() {
    return dsl::entry<dsl::Search, DistanceFunction>(
        "distance", "Steps over the empty balls of a baked volume of distances", "Donnelly 2005");
}

}  // namespace intaglio::templates

// Relief mapping with interval refinement: a linear march, then intersections of the ray with the
// line between the two ends of the bracket, each end replaced as the relief there demands.  Risser,
// Shah and Pattanaik, "Faster Relief Mapping Using the Secant Method", Journal of Graphics Tools
// 12(3), 2007, after "Interval Mapping", 2005.
//
// The last intersection spends no read: with 0 secant_steps it is parallax occlusion mapping.
#include "templates/all_techniques.h"
#include "templates/search/linear_march.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class ReliefSecant : public Search {
  public:
    Knob<int> linear_steps{this,        "linear_steps", 15,
                           at_least{1}, at_most{512},   "equal steps to the first sample inside"};
    Knob<int> secant_steps{this,        "secant_steps",
                           3,           at_least{0},
                           at_most{24}, "intersections of the last step, each a read"};
    Loop march{"march", linear_steps, -1};  // the first sample stands before the loop
    Loop refine{"refine", secant_steps};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const float step = 1.0f / static_cast<float>(linear_steps.value());
        const Crossing crossing = march_linearly(relief, ray, march, step);

        Step refining("refine", "Intersect the ray with the line between the ends of the bracket.");
        // The crossing lies in (t - width, t]; the gaps at both ends.
        var<float1> t{"far", crossing.t}, width{"width", step};
        var<float1> far_gap{"far_gap", crossing.inside}, near_gap{"near_gap", crossing.outside};
        for ([[maybe_unused]] int1 i : refine) {
            const float1 share = let("share", ratio(far_gap, far_gap - near_gap));
            const float1 middle = let("middle", t - width * share);
            const float1 middle_gap = let("middle_gap", gap(relief, ray, middle));
            const bool1 inside = middle_gap >= 0.0f;
            width = width * select(inside, 1 - share, share);
            t = select(inside, middle, t);
            far_gap = select(inside, middle_gap, far_gap);
            near_gap = select(inside, near_gap, middle_gap);
        }
        const float1 hit = let("hit", t - width * ratio(far_gap, far_gap - near_gap));
        return crossing.hit(ray, hit);
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march).unroll(refine);
        s.on("*").loop(march).loop(refine);
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_relief_secant() {
    return dsl::entry<dsl::Search, ReliefSecant>(
        "relief_secant",
        "Equal steps to the first sample inside, then intersections of its bracket",
        "Risser, Shah and Pattanaik 2007");
}

}  // namespace intaglio::templates

// Relief mapping: a linear march to the first sample inside the relief, then halvings of the last
// step.  Policarpo, Oliveira and Comba, "Real-Time Relief Mapping on Arbitrary Polygonal Surfaces",
// I3D 2005; the march of 15 and 6 halvings as in their published loop.
//
// The source's map holds depths and its ray runs to 1 at the floor: our t.  The halving keeps
// whichever half its middle sample says, and so keeps a wrong one where the march stepped over a
// feature: the miss that the steep parallax page warns of.
#include "templates/all_techniques.h"
#include "templates/search/linear_march.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class ReliefMapping : public Search {
  public:
    Knob<int> linear_steps{this,        "linear_steps", 15,
                           at_least{1}, at_most{512},   "equal steps to the first sample inside"};
    Knob<int> binary_steps{this,        "binary_steps", 6,
                           at_least{0}, at_most{24},    "halvings of the last step"};
    Loop march{"march", linear_steps, -1};  // the first sample stands before the loop
    Loop halve{"halve", binary_steps};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const float step = 1.0f / static_cast<float>(linear_steps.value());
        const Crossing crossing = march_linearly(relief, ray, march, step);

        Step halving("refine", "Halve the last step: keep the half that the crossing is in.");
        // The crossing lies in (t - width, t].
        var<float1> t{"hit", crossing.t}, width{"width", step};
        for ([[maybe_unused]] int1 i : halve) {
            width = width * 0.5f;
            const float1 middle = let("middle", t - width);
            t = select(gap(relief, ray, middle) >= 0.0f, middle, t);
        }
        return crossing.hit(ray, t);
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march).unroll(halve);
        s.on("*").loop(march).loop(halve);
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_relief() {
    return dsl::entry<dsl::Search, ReliefMapping>(
        "relief", "Equal steps to the first sample inside, then halvings of the last step",
        "Policarpo, Oliveira and Comba 2005");
}

}  // namespace intaglio::templates

// Contact refinement: march in coarse steps, at the first sample inside go one step back, and march
// that step in fine ones.  Riccardi, "Contact Refinement Parallax Mapping", 2019: n + m reads
// resolve the ray as n * m would.
//
// The source runs both marches in one loop that shortens its step once.  Two loops do the same; the
// fine one spares the last sample, which the coarse march has read.
#include "templates/all_techniques.h"
#include "templates/search/linear_march.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class ContactRefinement : public Search {
  public:
    Knob<int> coarse_steps{this,        "coarse_steps", 16,
                           at_least{1}, at_most{512},   "steps of the whole ray"};
    Knob<int> fine_steps{this,        "fine_steps", 16,
                         at_least{1}, at_most{512}, "steps of the coarse step before contact"};
    Loop march{"march", coarse_steps, -1};  // the first sample stands before the loop
    Loop contact{"contact", fine_steps, -1};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const float step = 1.0f / static_cast<float>(coarse_steps.value());
        const float fine = step / static_cast<float>(fine_steps.value());
        const Crossing crossing = march_linearly(relief, ray, march, step);

        Step refining("refine", "Go one step back and march it again in fine steps.");
        var<float1> t{"hit", crossing.t};
        for (int1 i : contact) {
            // One sum from the sample inside: a sum of two known numbers may be folded, and rounds
            // otherwise then.
            const int1 left = fine_steps.value() - 1 - i;
            const float1 next = let("next", crossing.t - left * fine);
            const bool1 inside = gap(relief, ray, next) >= 0.0f;
            t = select(inside, next, crossing.t);
            contact.until(inside);
        }
        return crossing.hit(ray, t);
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march).unroll(contact);
        s.on("*").loop(march).loop(contact);
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_contact_refinement() {
    return dsl::entry<dsl::Search, ContactRefinement>(
        "contact_refinement", "Coarse steps to contact, one step back, then fine steps",
        "Riccardi 2019");
}

}  // namespace intaglio::templates

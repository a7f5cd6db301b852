// A search of one's own: halve the ray until the crossing is found.  Exact on smooth reliefs that
// the ray crosses once, wrong where it crosses more often: then it finds one of the crossings, not
// always the first.
#include "bisection.h"

namespace {

using namespace intaglio::dsl;

// [technique]
class Bisection : public Search {
  public:
    Knob<int> halvings{this,        "halvings",  8,
                       at_least{1}, at_most{24}, "reads, each halving the interval"};
    Loop halve{"halve", halvings};

    Hit find(const Relief& relief, const Ray& ray) const override {
        Step searching(
            "halve",
            "Halve the ray: keep the half whose ends lie on different sides of the relief.");
        var<float1> outside{"outside", 0.0f}, inside{"inside", 1.0f};
        for ([[maybe_unused]] int1 i : halve) {
            const float1 middle = let("middle", (outside + inside) * 0.5f);
            const bool1 below = relief.height(ray.at(middle)) >= 1 - middle;
            inside = select(below, middle, inside);
            outside = select(below, outside, middle);
        }
        return {let("displaced", ray.at(inside)), 1 - inside};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(halve);
        s.on("*").loop(halve);
    }
};
// [technique]

}  // namespace

intaglio::dsl::Entry<Search> bisection() {
    return entry<Search, Bisection>("bisection", "Halving of the ray", "");
}

// Parallax mapping: one height, read where the ray enters, moves the coordinate to where the ray
// meets a level plane of that height, t = s + B[s] E.xy / E.z.  Kaneko et al., "Detailed Shape
// Representation with Parallax Mapping", ICAT 2001; bias and scale as in Welsh 2004.
//
// The source's heights rise above the polygon, ours lie below it: that is the bias of -1.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Parallax : public Search {
  public:
    Knob<float> bias{this,       "parallax_bias",
                     -1.0f,      at_least{-1},
                     at_most{0}, "height of the polygon: -1 the top of the relief, 0 its floor"};
    Knob<float> scale{this,        "parallax_scale", 1.0f,
                      at_least{0}, at_most{4},       "factor of the offset; 0 is no parallax"};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const float1 height = let("height", relief.height(ray.uv));
        const float1 rise = let("rise", (height + bias.value()) * scale.value());
        return {let("displaced", ray.uv + ray.reach * rise), height};
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_parallax() {
    return dsl::entry<dsl::Search, Parallax>(
        "parallax", "One height moves the coordinate along the view, as if the relief were level",
        "Kaneko et al. 2001");
}

}  // namespace intaglio::templates

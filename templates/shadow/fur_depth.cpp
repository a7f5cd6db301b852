// Fur's depth-shadow: light falls off with depth, no rays.  McGuire and McGuire, "Steep Parallax
// Mapping", I3D 2005 poster, "Fur and Grass", after Lengyel et al., "Real-Time Fur over Arbitrary
// Surfaces", 2001.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class FurDepth : public Shadow {
  public:
    Knob<float> root_light{this,        "root_light", 0.25f,
                           at_least{0}, at_most{1},   "light left at the deepest point"};

    float1 visibility(const Relief&, const Hit& hit, float3) const override {
        return lerp(float1(root_light.value()), 1.0f, hit.height);
    }
    bool depends_on_light() const override { return false; }
};

}  // namespace

dsl::Entry<dsl::Shadow> shadow_fur_depth() {
    return dsl::entry<dsl::Shadow, FurDepth>("fur_depth",
                                             "Darkening with depth in place of shadow rays",
                                             "McGuire and McGuire 2005, after Lengyel 2001");
}

}  // namespace intaglio::templates

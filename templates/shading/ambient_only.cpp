// The albedo under ambient light: no normal, no light, no shadow.  For maps with light baked into
// their colours, of which Brawley and Tatarchuk (ShaderX3, 2004, "Art Content Suggestions") say
// that the displaced coordinate alone is a simple and convincing effect.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class AmbientOnly : public Shading {
  public:
    float3 shade(const Fragment& fragment) const override {
        return fragment.albedo * uniform<3>("ambient", "ambient light, linear rgb");
    }
};

}  // namespace

dsl::Entry<dsl::Shading> shading_ambient_only() {
    return dsl::entry<dsl::Shading, AmbientOnly>("ambient_only",
                                                 "The colour map under ambient light", "");
}

}  // namespace intaglio::templates

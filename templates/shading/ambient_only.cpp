// The albedo under ambient light: no normal, no light, no shadow.  For maps with light baked into
// their colours, of which Brawley and Tatarchuk (ShaderX3, 2004, "Art Content Suggestions") say
// that the displaced coordinate alone is a simple and convincing effect.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class AmbientOnly : public Shading {
  public:
    Reflected reflect(const Fragment&, const Light&) const override { return {}; }
};

}  // namespace

dsl::Entry<dsl::Shading> shading_ambient_only() {
    return dsl::entry<dsl::Shading, AmbientOnly>("ambient_only",
                                                 "The colour map under ambient light", "");
}

}  // namespace intaglio::templates

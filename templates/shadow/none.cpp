// No self-shadow: every point sees the light.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class None : public Shadow {
  public:
    float1 visibility(const Relief&, const Hit&, float3) const override { return 1.0f; }
    bool depends_on_light() const override { return false; }
};

}  // namespace

dsl::Entry<dsl::Shadow> shadow_none() {
    return dsl::entry<dsl::Shadow, None>("none", "Every point sees the light", "");
}

}  // namespace intaglio::templates

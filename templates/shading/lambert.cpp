// Diffuse light alone, by the cosine law (Lambert, "Photometria", 1760): ambient + N.L, dimmed by
// the shadow.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Lambert : public Shading {
  public:
    Reflected reflect(const Fragment& fragment, const Light& light) const override {
        const float3 colour = light.colour();
        const float1 diffuse = let("diffuse", saturate(dot(fragment.normal, light.direction)));
        return {colour * (diffuse * light.visibility)};
    }
};

}  // namespace

dsl::Entry<dsl::Shading> shading_lambert() {
    return dsl::entry<dsl::Shading, Lambert>("lambert", "Ambient and diffuse light",
                                             "Lambert 1760");
}

}  // namespace intaglio::templates

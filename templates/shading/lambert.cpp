// Diffuse light alone, by the cosine law (Lambert, "Photometria", 1760): ambient + N.L, dimmed by
// the shadow.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Lambert : public Shading {
  public:
    float3 shade(const Fragment& fragment) const override {
        const float3 ambient = uniform<3>("ambient", "ambient light, linear rgb");
        const float3 light_colour = uniform<3>("light_colour", "colour of the light, linear rgb");
        const float1 diffuse = let("diffuse", saturate(dot(fragment.normal, fragment.light)));
        return fragment.albedo * (ambient + light_colour * (diffuse * fragment.visibility));
    }
};

}  // namespace

dsl::Entry<dsl::Shading> shading_lambert() {
    return dsl::entry<dsl::Shading, Lambert>("lambert", "Ambient and diffuse light",
                                             "Lambert 1760");
}

}  // namespace intaglio::templates

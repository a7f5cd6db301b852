// Phong illumination with the halfway vector: ambient + diffuse + specular, the last two dimmed by
// the shadow. As both papers use it; the powers of the steep parallax page (square of N.H) is
// shininess = 2.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Phong : public Shading {
  public:
    Knob<float> shininess{this,        "shininess",  32.0f,
                          at_least{1}, at_most{256}, "exponent of the highlight"};

    Reflected reflect(const Fragment& fragment, const Light& light) const override {
        const float3 colour = light.colour();
        const float1 gloss = uniform<1>("gloss", "strength of the highlight");

        const float1 diffuse = let("diffuse", saturate(dot(fragment.normal, light.direction)));
        const float3 halfway =
            let("halfway", normalize(let("between", light.direction + fragment.view)));
        // pow(0, y) is 0 or NaN by device: the least base is a power that rounds to nothing on
        // screen.
        const float1 highlight =
            let("highlight", pow(max(dot(fragment.normal, halfway), 1e-4f), shininess.value()));
        // No highlight on the side that faces away.
        const float1 specular = let("specular", select(diffuse > 0.0f, gloss * highlight, 0.0f));
        const float3 highlights = colour * (specular * light.visibility);
        return {colour * (diffuse * light.visibility), highlights};
    }
};

}  // namespace

dsl::Entry<dsl::Shading> shading_phong() {
    return dsl::entry<dsl::Shading, Phong>(
        "phong", "Ambient, diffuse and a highlight by the halfway vector", "");
}

}  // namespace intaglio::templates

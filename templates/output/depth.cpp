// The shaded colour, with the depth of the point that the ray met rather than the polygon's: what
// stands in the relief is hidden by it and hides it.  McGuire and McGuire, "Steep Parallax
// Mapping", page of 2005, which writes glFragDepth = 1 / (z + ray distance).
//
// The point lies on the line from the polygon's pixel P away from the eye E, at P + k (P - E). Both
// ends of that line in clip space are affine in P, so their interpolation is exact, and with them
//     depth = (P.z - k (E - P).z) / (P.w - k (E - P).w),
// the value that a polygon through the point would leave in the depth buffer.  The page's formula
// grows towards the eye, as a reversed depth buffer with its near plane at 1 does, and takes the
// distance where such a buffer takes its part along the camera's axis.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Depth : public Output {
  public:
    Knob<int> page{this,       "page_depth",
                   0,          at_least{0},
                   at_most{1}, "1: 1 / (z + ray distance), as on the page; 0: the polygon's kind"};
    Knob<int> symmetric{
        this,       "depth_range",
        0,          at_least{0},
        at_most{1}, "clip space reaches from z = 0 (0), or from z = -w (1: OpenGL)"};

    std::string name() const override { return "colour"; }
    bool shaded() const override { return true; }
    float4 write(const Hit&, float1, float3 colour) const override { return {colour, 1.0f}; }

    bool writes_depth() const override { return true; }
    std::optional<float1> depth(const Relief& relief, const Hit& hit) const override {
        Step step("depth", "Write the depth of the point that the ray met.");
        const float3 to_eye = input<3>("to_eye");
        const float1 span = uniform<1>("texture_span", "world units that a texture unit spans");
        // The eye's height above the polygon, no less than the ray's own guard makes it.
        const float1 distance = let("eye_distance", sqrt(max(dot(to_eye, to_eye), tiny)));
        const float1 above = max(to_eye.z(), distance * Ray::least_z);
        const float1 beyond =
            let("beyond", max(1.0f - hit.height, 0.0f) * (relief.scale * span) / above);
        if (page.value() == 1) return let("depth", 1.0f / (distance + distance * beyond));
        const float4 line = input<4>("depth_line");
        const float2 place = let("clip_place", line.xy() - line.zw() * beyond);
        const float1 ratio = let("clip_depth", place.x() / max(place.y(), tiny));
        return let("depth", saturate(symmetric.value() == 1 ? ratio * 0.5f + 0.5f : ratio));
    }
};

}  // namespace

dsl::Entry<dsl::Output> output_depth() {
    return dsl::entry<dsl::Output, Depth>(
        "depth", "The shaded colour, and the depth of the point that the ray met",
        "McGuire and McGuire 2005");
}

}  // namespace intaglio::templates

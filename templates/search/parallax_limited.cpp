// Parallax mapping with offset limiting: without the division by E.z the offset is never longer
// than the relief is deep, and flattens towards the horizon in place of swimming.  Welsh, "Parallax
// Mapping with Offset Limiting: A Per-Pixel Approximation of Uneven Surfaces", 2004.
//
// The steep parallax page mentions a further factor, "scaling the offset by N dot V to reduce swim
// where the gradient is large".  Only the map's own normal knows the gradient, so that is the N of
// the knob normal_weight.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class ParallaxLimited : public Search {
  public:
    Knob<float> bias{this,       "limited_bias",
                     -1.0f,      at_least{-1},
                     at_most{0}, "height of the polygon: -1 the top of the relief, 0 its floor"};
    Knob<float> scale{this,        "limited_scale", 1.0f,
                      at_least{0}, at_most{4},      "factor of the offset; 0 is no parallax"};
    Knob<int> normal_weight{this,       "normal_weight",
                            0,          at_least{0},
                            at_most{1}, "1: the offset is scaled by N.V, N from the normal map"};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const float1 height = let("height", relief.height(ray.uv));
        const float1 rise = let("rise", (height + bias.value()) * scale.value() * relief.scale);
        const float1 limited =
            normal_weight == 1 ? let("weighted", rise * facing(relief, ray)) : rise;
        return {let("displaced", ray.uv + ray.view.xy() * limited), height};
    }

  private:
    static float1 facing(const Relief& relief, const Ray& ray) {
        const sampler2D normals("normal_map", "tangent-space normal in rgb, height in alpha");
        const float3 texel = normals.sample_level(ray.uv, relief.level).xyz();
        return let("facing", saturate(dot(normalize(texel * 2.0f - 1.0f), ray.view)));
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_parallax_limited() {
    return dsl::entry<dsl::Search, ParallaxLimited>(
        "parallax_limited",
        "Parallax without its division: offsets no longer than the relief is deep", "Welsh 2004");
}

}  // namespace intaglio::templates

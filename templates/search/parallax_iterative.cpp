// Iterated parallax: each read corrects the point by how far the relief still is from the ray, in
// smaller steps where the map is steep.  Premecz, "Iterative Parallax Mapping with Slope
// Information", CESCG 2006: repeat p += n_z (h(p) - p_z) V.
//
// The source's p never leaves the ray, so that one number says where it is: p_z = -t.  The step
// then is t' = lerp(t, 1 - h, n_z V.z), between two numbers of [0, 1] whatever the map holds.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class ParallaxIterative : public Search {
  public:
    Knob<int> iterations{this,        "iterations", 4,
                         at_least{1}, at_most{64},  "reads, each from where the last one led"};
    Knob<int> slope{this,       "slope",
                    1,          at_least{0},
                    at_most{1}, "1: steps shortened by the normal map's z; 0: as in Welsh 2004"};
    Loop approach{"approach", iterations};

    Hit find(const Relief& relief, const Ray& ray) const override {
        Step approaching("approach", "Move the point along the ray by its distance to the relief.");
        const float1 least_z = Ray::least_z;
        const float1 limit = let("limit", max(ray.view.z(), least_z));
        var<float1> t{"t", 0.0f};
        for ([[maybe_unused]] int1 i : approach) {
            const float2 uv = ray.at(t);
            const float1 wanted = let("wanted", 1 - relief.height(uv));
            const float1 share = slope == 1 ? limit * normal_z(relief, uv) : limit;
            t = lerp(t, wanted, share);
        }
        return {let("displaced", ray.at(t)), 1 - t};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(approach);
        s.on("*").loop(approach);
    }

  private:
    static float1 normal_z(const Relief& relief, float2 uv) {
        const sampler2D normals("normal_map", "tangent-space normal in rgb, height in alpha");
        return let("normal_z", saturate(normals.sample_level(uv, relief.level).z() * 2.0f - 1.0f));
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_parallax_iterative() {
    return dsl::entry<dsl::Search, ParallaxIterative>(
        "parallax_iterative", "A few reads, each moving the point by its distance to the relief",
        "Premecz 2006");
}

}  // namespace intaglio::templates

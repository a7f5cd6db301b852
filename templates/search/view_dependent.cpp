// View-dependent displacement: the hit is looked up, not searched.  A volume holds where the ray
// ends for every texel and a grid of views; one read, four views in its channels.  Wang, Wang,
// Tong, Lin, Hu, Guo and Shum, "View-Dependent Displacement Mapping", SIGGRAPH 2003, without
// curvature.
//
// The source tabulates angles and needs one map for each scale; ours tabulates how far the ray
// travels (docs/maps.md), which is all that a flat relief depends on.  Of the unsafe class: between
// texels and views the answers are mixed, whatever they hit.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

// Of the baked volume: views along both axes of its grid, and the reach in its middle.
constexpr float views = 9, cells = views - 1;
constexpr float middle = 0.25f, widest = 0.9f;

class ViewDependent : public Search {
  public:
    Hit find(const Relief&, const Ray& ray) const override {
        const sampler3D map("view_dependent_map", "where rays of four views end, in rgba");
        Step looking("look_up", "Mix the answers for the four baked views around this one.");
        const float1 travel = let("travel", length(ray.reach));
        // The direction in the unit disc; flatter views count as the flattest baked one.
        const float1 shrink =
            let("shrink", min(1.0f / (travel + middle), widest / max(travel, tiny)));
        const float2 grid =
            let("grid", ray.reach * (shrink * (0.5f * cells)) + float2(0.5f * cells, 0.5f * cells));
        const float2 cell = let("cell", min(floor(grid), float2(cells - 1, cells - 1)));
        const float2 within = let("within", grid - cell);
        const float1 slice = (cell.y() * cells + cell.x() + 0.5f) * (1.0f / (cells * cells));
        const float4 answers = let("answers", map.sample_level(float3(ray.uv, slice), 0.0f));
        const float2 rows = let("rows", lerp(float2(answers.x(), answers.z()),
                                             float2(answers.y(), answers.w()), within.x()));
        const float1 t = let("t", lerp(rows.x(), rows.y(), within.y()));
        return {let("displaced", ray.at(t)), 1 - t};
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_view_dependent() {
    return dsl::entry<dsl::Search, ViewDependent>(
        "view_dependent", "The hit read from a volume baked over texels and views",
        "Wang et al. 2003");
}

}  // namespace intaglio::templates

// Steep parallax mapping: march the view ray down in equal steps, more of them the flatter the ray,
// and stop at the first sample that is not below it.  McGuire and McGuire, "Steep Parallax
// Mapping", I3D 2005 poster and page.
//
// The page's listing lost its loop's closing brace and flips y for the bitmap's orientation; E
// there points to the eye as V does here.  It interpolates the step count over N.V between numSteps
// * 2 and numSteps, and mentions lerp(60, 10, z): both are the knobs min_steps and max_steps.  We
// round the count, so that the last step ends on the floor.  `nyquist` chooses the mip level on
// which a step is at most one texel, the page's guard against missed features, in place of the
// relief's own level.
//
// `stride` says what is constant: the step's height, or its length on the map (the page's second
// form, whose arithmetic is not right: docs/techniques/steep_parallax.md).  Or nothing is, and the
// march goes from texel to texel, as the page would have it: to the next line between texel
// centres, where the filtered relief has its edges, or with texels as columns.
#include <algorithm>

#include "templates/all_techniques.h"
#include "templates/search/texel_walk.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class SteepParallax : public Search {
  public:
    Knob<int> min_steps{this,        "min_steps",  10,
                        at_least{1}, at_most{512}, "steps when looking straight down"};
    Knob<int> max_steps{this,        "max_steps",  60,
                        at_least{1}, at_most{512}, "steps at the most grazing view"};
    Knob<int> nyquist{this,       "nyquist",
                      0,          at_least{0},
                      at_most{1}, "1: read on the mip level where a step is at most one texel"};
    Knob<int> stride{this,
                     "stride",
                     0,
                     at_least{0},
                     at_most{3},
                     "0: steps of equal height; 1: of equal length on the map; 2: to the next line "
                     "between texel centres; 3: from texel to texel, each a column"};
    Knob<float> texels_per_step{this,           "texels_per_step", 1.0f,
                                at_least{0.25}, at_most{64},       "their length with stride = 1"};
    Loop march{"march", max_steps};

    Hit find(const Relief& relief, const Ray& ray) const override {
        if (stride < 2) return march_steps(relief, ray);
        const float1 level = nyquist.value() == 1 ? level_within_reach(relief, ray) : relief.level;
        return stride == 2 ? walk_lines(relief, ray, level) : walk_columns(relief, ray, level);
    }

    Status check() const override {
        if (min_steps > max_steps)
            return input_error("knob-relation",
                               "min_steps is above max_steps; steps run from min_steps (straight "
                               "down) to max_steps (grazing)");
        return Done{};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march);
        s.on("*").loop(march);
    }

  private:
    Hit march_steps(const Relief& relief, const Ray& ray) const {
        const float1 steps = step_count(relief, ray);
        const float1 step = let("step", 1.0f / steps);
        const float1 level =
            nyquist.value() == 1 ? level_below_nyquist(relief, ray, step) : relief.level;

        Step marching("march", "March the ray down until it is no longer above the relief.");
        var<float1> t{"t", 0.0f}, height{"height", relief.height_at_level(ray.uv, level)};
        for (int1 i : march) {
            const float1 ray_height = let("ray_height", 1 - t);
            march.until(height >= ray_height);
            t = min((i + 1) * step, 1.0f);
            height = relief.height_at_level(ray.at(t), level);
        }
        // The height is the relief's, not the ray's, which is up to a step below it: shadows start
        // there.
        return {let("displaced", ray.at(t)), height, height >= 1 - t};
    }

    // A ray that crosses more lines or texels than max_steps ends there, and says so; with nyquist
    // = 1 they are those of the mip level on which it does not.
    float2 grid_at(const Relief& relief, float1 level) const {
        if (nyquist.value() == 0) return relief.map_size;
        // 0.01: the rounding of exp2.
        return let("grid", max(floor(relief.map_size * exp2(-level) + 0.01f), float1(1.0f)));
    }

    Hit walk_lines(const Relief& relief, const Ray& ray, float1 level) const {
        const TexelWalk cells = TexelWalk::along(ray, grid_at(relief, level), 0.5f);
        Step walking("march", "Go from line to line until the ray is no longer above the relief.");
        var<float1> t{"t", 0.0f}, height{"height", relief.height_at_level(ray.uv, level)};
        var<float2> crossed{"crossed", float2(0.0f, 0.0f)};
        for ([[maybe_unused]] int1 i : march) {
            march.until(height >= 1 - t);
            const float2 next = let("next", cells.next(crossed));
            t = min(min(next.x(), next.y()), 1.0f);
            height = relief.height_at_level(ray.at(t), level);
            crossed = TexelWalk::over_nearer(crossed, next);
        }
        return {let("displaced", ray.at(t)), height, height >= 1 - t};
    }

    // The ray meets a column's side where it enters the texel, or its top further on.
    Hit walk_columns(const Relief& relief, const Ray& ray, float1 level) const {
        const TexelWalk texels = TexelWalk::along(ray, grid_at(relief, level), 0);
        Step walking("march", "Go from texel to texel until the ray meets a column.");
        var<float1> t{"t", 0.0f}, height{"height", 0.0f};
        var<float2> crossed{"crossed", float2(0.0f, 0.0f)};
        var<bool1> found{"found", false};
        for ([[maybe_unused]] int1 i : march) {
            const float2 next = let("next", texels.next(crossed));
            const float1 leave = let("leave", min(min(next.x(), next.y()), 1.0f));
            height = relief.height_at_level(texels.near_texel(crossed), level);
            const float1 meeting = let("meeting", max(t, 1 - height));
            found = meeting <= leave;
            t = min(meeting, leave);
            march.until(meeting <= leave || leave >= 1.0f);
            crossed = TexelWalk::over_nearer(crossed, next);
        }
        return {let("displaced", ray.at(t)), height, found};
    }

    float1 step_count(const Relief& relief, const Ray& ray) const {
        if (min_steps == max_steps) return static_cast<float>(max_steps.value());
        if (stride == 1) {
            const float2 texels = let("texels", abs(ray.reach * relief.map_size));
            const float1 wanted = max(texels.x(), texels.y()) * (1.0f / texels_per_step.value());
            return let("steps", max(min(-floor(-wanted), static_cast<float>(max_steps.value())),
                                    static_cast<float>(min_steps.value())));
        }
        const float1 wanted = lerp(float1(static_cast<float>(max_steps.value())),
                                   static_cast<float>(min_steps.value()), saturate(ray.view.z()));
        return let("steps", floor(wanted + 0.5f));
    }

    // The first level on which the ray crosses at most max_steps cells, two of them in part.
    float1 level_within_reach(const Relief& relief, const Ray& ray) const {
        const float2 texels = let("texels", abs(ray.reach * relief.map_size));
        const float whole = static_cast<float>(std::max(max_steps.value() - 2, 1));
        // A little more than its share, so that the logarithm's rounding cannot cost a cell.
        const float1 share = (texels.x() + texels.y()) * (1.001f / whole);
        return let("level", -floor(-log2(max(share, 1.0f))));
    }

    // log2 of the texels that one step crosses, and never below the finest level.
    float1 level_below_nyquist(const Relief& relief, const Ray& ray, float1 step) const {
        const float2 texels = let("texels", abs(ray.reach * step * relief.map_size));
        return let("level", log2(max(max(texels.x(), texels.y()), 1.0f)));
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_steep_parallax() {
    return dsl::entry<dsl::Search, SteepParallax>(
        "steep_parallax",
        "A march in equal height steps that stops at the first sample above the ray",
        "McGuire and McGuire 2005");
}

}  // namespace intaglio::templates

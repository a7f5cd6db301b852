// The exact self-shadow: along the light ray over the bilinear patches that a texture unit
// reconstructs; nothing is sampled, so nothing is missed.  As in the exact search, an inner loop
// leaps from cell to cell, or over whole squares of them, while the relief there is below the ray,
// and an outer one judges the patch that is not.  A light ray rises: over a square it stays above
// the square's summit if it enters it so.
//
// Without baked maps it goes texel by texel, as Amanatides and Woo, "A Fast Voxel Traversal
// Algorithm", 1987.  Between two crossings of texel lines the surface less the ray is a quadratic,
// and three filtered reads say all of it: at the way in (carried from the cell before), half way,
// and at the way out.  Two reads a cell where a patch from its corners takes four.  Each crossing
// is computed from the number of lines crossed, never accumulated, so that the last is as exact as
// the first.
#include "templates/all_techniques.h"
#include "templates/search/patch_walk.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

// One axis of the walk, in texels from the start.
struct Axis {
    float1 first;  // the rise of the ray at which it crosses its first texel line
    float1 each;   // from one line to the next
    float1 next(float1 crossed) const { return first + crossed * each; }
};

// `at` and `step`: the start and the ray's travel per unit of height, in texels whose centres are
// the integers.
Axis axis_of(float1 at, float1 step, std::string_view first, std::string_view each) {
    // Slower than a millionth of a texel the ray meets at most one line more than it should, which
    // costs a cell and changes nothing.
    const float1 per_texel = let(each, 1.0f / max(abs(step), 1e-6f));
    const float1 inside = frac(at);
    return {let(first, select(step < 0.0f, inside, 1.0f - inside) * per_texel), per_texel};
}

class Exact : public Shadow {
  public:
    Knob<int> cells{this,
                    "shadow_cells",
                    250,
                    at_least{1},
                    at_most{4096},
                    "patches that the light ray is judged over at most; beyond them it is free"};
    Knob<int> leaps{this,
                    "shadow_leaps",
                    250,
                    at_least{0},
                    at_most{4096},
                    "leaps before each patch, at most; 0: no baked maps, every texel that the light "
                    "ray crosses is judged"};
    Knob<float> bias{
        this,        "exact_bias",
        1.0f / 4096, at_least{0},
        at_most{1},  "height that the relief may rise above the light ray and not shade"};
    Loop walk{"shadow_walk", cells};
    Loop leap{"shadow_leap", leaps};

    float1 visibility(const Relief& relief, const Hit& hit, float3 light) const override {
        const float2 uv = let("wrapped", frac(hit.uv));
        const float2 reach =
            let("shadow_reach", light.xy() / max(light.z(), float1(Ray::least_z)) * relief.scale);
        // A point that the search has left below the surface would be in its own shadow.
        const float1 from = let("light_height", max(relief.height(uv), hit.height));
        const float1 end = let("light_exit", max(1.0f - from, 0.0f));
        // What is baked is the finest level's.
        const bool baked = leaps > 0 && relief.known_level == 0;
        const float1 highest = baked ? leaping(relief, uv, reach, from, end, light)
                                     : walking(relief, uv, reach, from, end);
        return let("lit", select(light.z() > 0.0f && highest <= bias.value(), float1(1.0f), 0.0f));
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(walk).unroll(leap);
        s.on("*").loop(walk).loop(leap);
    }

  private:
    // How far the relief rises above the light ray, up to where that is more than the bias.
    float1 leaping(const Relief& relief, float2 uv, float2 reach, float1 from, float1 end,
                   float3 light) const {
        const BakedPatches patches;
        const TexelWalk texels = TexelWalk::along({uv, light, -reach}, relief.map_size, 0.5f);
        // Above the top of the map the light is free.
        const float1 top = let("top_of_map", patches.top().x());
        const float1 free = let(
            "light_free", select(light.z() > 0.0f, min(end, max(top - from, 0.0f)), 0.0f));
        const float1 allowed = let("allowed", from + bias.value());
        const float2 first = let("first_shadow_lines", (1 - texels.within) * texels.pause);
        var<float1> rise{"rise", 0.0f}, highest{"highest", 0.0f};
        var<float2> crossed{"crossed", float2(0.0f, 0.0f)};
        for ([[maybe_unused]] int1 i : walk) {
            for ([[maybe_unused]] int1 j : leap) {
                const float4 summits =
                    let("summits", patches.summits.sample_level(texels.cell(crossed), 0.0f));
                const float1 height = let("height", allowed + rise);
                leap.until(summits.x() > height || rise >= free);
                const float2 next = let("next", crossed * texels.pause + first);
                const auto over = [&](int square, float1 summit) {
                    return select(summit <= height, BakedPatches::border(texels, next, square),
                                  0.0f);
                };
                const float1 leave = let("leave", min(next.x(), next.y()));
                const float1 near = let("near", max(max(leave, rise), over(1, summits.y())));
                rise = max(near, max(over(2, summits.z()), over(3, summits.w())));
                crossed = BakedPatches::crossed_at(texels, crossed, next, rise);
            }
            walk.until(rise >= free);
            const float2 next = let("next_lines", texels.next(crossed));
            const float1 out = let("rise_out", max(min(min(next.x(), next.y()), end), rise));
            const float1 span = let("span", out - rise);
            const Profile profile =
                patches.profile(relief, texels, crossed, rise, from + rise, -1);
            highest = max(highest, max(summit(profile.c, profile.at(span * 0.5f),
                                              profile.at(span)),
                                       max(profile.c, profile.at(span))));
            walk.until(highest > bias.value());
            rise = out;
            crossed = TexelWalk::over_nearer(crossed, next);
        }
        return highest;
    }

    float1 walking(const Relief& relief, float2 uv, float2 reach, float1 from, float1 end) const {
        const float2 size = relief.level_size();
        const float2 start = let("start_texel", uv * size - 0.5f);
        const float2 travel = let("texels_per_height", reach * size);
        const Axis x = axis_of(start.x(), travel.x(), "first_x", "each_x");
        const Axis y = axis_of(start.y(), travel.y(), "first_y", "each_y");
        const auto gap = [&](float1 rise) {
            return relief.height(uv + reach * rise) - (from + rise);
        };

        var<float1> crossed_x{"crossed_x", 0.0f}, crossed_y{"crossed_y", 0.0f};
        var<float1> rise{"rise", 0.0f}, before{"gap_in", 0.0f}, highest{"highest", 0.0f};
        for ([[maybe_unused]] int1 i : walk) {
            walk.until(highest > bias.value() || rise >= end);
            const float1 next_x = let("next_x", x.next(crossed_x));
            const float1 next_y = let("next_y", y.next(crossed_y));
            const float1 out = let("rise_out", min(min(next_x, next_y), end));
            const float1 middle = let("gap_middle", gap((rise + out) * 0.5f));
            const float1 after = let("gap_out", gap(out));
            highest = max(after, summit(before, middle, after));
            crossed_x = crossed_x + select(next_x <= next_y, float1(1.0f), 0.0f);
            crossed_y = crossed_y + select(next_x <= next_y, float1(0.0f), 1.0f);
            before = after;
            rise = out;
        }
        return highest;
    }

    // The highest value of the quadratic through three equally spaced values, or the middle one if
    // the quadratic has its summit outside.
    static float1 summit(float1 left, float1 middle, float1 right) {
        const float1 difference = let("difference", right - left);
        const float1 bulge = let("bulge", middle * 4.0f - (left + right) * 2.0f);
        return select(bulge > abs(difference),
                      middle + difference * difference / max(bulge * 4.0f, tiny), middle);
    }
};

}  // namespace

dsl::Entry<dsl::Shadow> shadow_exact() {
    return dsl::entry<dsl::Shadow, Exact>(
        "exact", "Texel by texel towards the light over the bilinear surface: misses nothing", "");
}

}  // namespace intaglio::templates

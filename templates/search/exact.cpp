// The exact search: in each cell that the ray crosses the first intersection with the bilinear
// patch that the texture unit reconstructs between four texel centres.  Nothing is sampled, so
// nothing is missed, at any angle.  Our own; cell walks of height fields go back to Musgrave, "Grid
// Tracing: Fast Ray Tracing for Height Fields", 1988, the quadratic along a ray to Ramsey, Potter
// and Hansen, "Ray Bilinear Patch Intersections", 2004.
//
// Two loops.  The inner one only asks how high the relief is, and goes from cell to cell, or over
// whole squares of them, until a patch reaches up to the ray; one read says the maxima of the patch
// and of three squares around it.  The outer one solves that patch: with s from where the ray
// enters it, the relief rises above the ray by a s^2 + b s + c.  It is below at the entry, c < 0, so
// that the first root is the only one that matters: -2 c / (b + root), or where b < 0 the same
// number without its cancellation, (root - b) / 2 a.
#include "templates/all_techniques.h"
#include "templates/search/patch_walk.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Exact : public Search {
  public:
    Knob<int> max_cells{this,        "max_cells",    240,
                        at_least{1}, at_most{4096}, "patches solved at most"};
    Knob<int> max_leaps{this,
                        "max_leaps",
                        240,
                        at_least{0},
                        at_most{4096},
                        "leaps before each patch, at most; 0: no baked maps, every patch that the "
                        "ray crosses is solved"};
    Loop walk{"walk", max_cells};
    Loop leap{"leap", max_leaps};

    Hit find(const Relief& relief, const Ray& ray) const override {
        // What is baked is the finest level's.
        return max_leaps > 0 && relief.known_level == 0 ? find_leaping(relief, ray)
                                                        : find_walking(relief, ray);
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(walk).unroll(leap);
        s.on("*").loop(walk).loop(leap);
    }

  private:
    // Where the ray is.
    struct State {
        var<float1> t, beyond{"beyond", 0.0f};
        var<float2> crossed;
        var<bool1> found{"found", false};

        State(float1 start, float2 lines) : t("t", start), crossed("crossed", lines) {}
    };

    Hit find_leaping(const Relief& relief, const Ray& ray) const {
        const BakedPatches patches;
        const TexelWalk cells = TexelWalk::along(ray, relief.map_size, 0.5f);
        Step walking("walk", "Leap to the next patch that reaches up to the ray, solve it.");
        // No ray is above a section's top, which the map's may be.
        const float1 top = 1 - relief.in_section(patches.top().x());
        const float1 start = let("start_t", relief.sections == 1 ? top : saturate(top));
        State at(start, floor(cells.within + cells.speed * start));
        for ([[maybe_unused]] int1 i : walk) {
            leap_to_patch(relief, cells, patches, at);
            const float1 t = at.t;
            solve(cells, patches.profile(relief, cells, at.crossed, t, 1 - t, 1), at);
        }
        return hit_of(relief, ray, at);
    }

    Hit find_walking(const Relief& relief, const Ray& ray) const {
        const TexelWalk cells = TexelWalk::along(ray, relief.map_size, 0.5f);
        Step walking("walk", "Solve the patch of each cell that the ray crosses.");
        State at(0.0f, float2(0.0f, 0.0f));
        for ([[maybe_unused]] int1 i : walk) solve(cells, profile_of(relief, cells, at), at);
        return hit_of(relief, ray, at);
    }

    // The ray falls: over a square it stays above the square's summit until it is as low.
    void leap_to_patch(const Relief& relief, const TexelWalk& cells, const BakedPatches& patches,
                       State& at) const {
        // As cells.next() has it, but for a rounding, which a leap does not mind.
        const float2 first = let("first_lines", (1 - cells.within) * cells.pause);
        for ([[maybe_unused]] int1 i : leap) {
            const float2 next = let("next", at.crossed * cells.pause + first);
            const float1 leave = let("leave", min(min(next.x(), next.y()), 1.0f));
            const float4 summits =
                let("summits", patches.summits.sample_level(cells.cell(at.crossed), 0.0f));
            leap.until(above_floor(relief, summits.x()) >= 1 - leave);
            const auto over = [&](int square, float1 summit) {
                return min(BakedPatches::border(cells, next, square),
                           1 - above_floor(relief, summit));
            };
            const float1 near = let("near", max(max(leave, at.t), over(1, summits.y())));
            at.t = max(near, max(over(2, summits.z()), over(3, summits.w())));
            at.crossed = BakedPatches::crossed_at(cells, at.crossed, next, at.t);
        }
    }
    // A section may lie above a summit.
    static float1 above_floor(const Relief& relief, float1 whole) {
        const float1 height = relief.in_section(whole);
        return relief.sections == 1 ? height : max(height, 0.0f);
    }

    void solve(const TexelWalk& cells, const Profile& profile, State& at) const {
        const float2 next = let("next_lines", cells.next(at.crossed));
        const float1 leave = let("leave_patch", min(min(next.x(), next.y()), 1.0f));
        const float1 span = let("span", leave - at.t);
        const float1 root = let("root", first_root(profile));
        at.found = root <= span;
        at.beyond = profile.at(span) + (1 - leave);
        at.t = select(root <= span, at.t + root, leave);
        walk.until(root <= span || leave >= 1.0f);
        at.crossed = TexelWalk::over_nearer(at.crossed, next);
    }

    // The least s >= 0 where the ray is not above the relief; beyond any cell where there is none.
    static float1 first_root(const Profile& profile) {
        const auto& [a, b, c] = profile;
        const float1 square = let("square", b * b - 4.0f * a * c);
        const float1 both = let("both", abs(b) + sqrt(max(square, 0.0f)));
        // A divisor of 0 or below makes a root far outside of the cell, which there is none in.
        const float1 rising = -2.0f * c / max(both, tiny);
        const float1 falling = both / max(2.0f * a, tiny);
        const float1 ahead = select(b >= 0.0f, rising, falling);
        const float1 real = select(square >= 0.0f, ahead, 4.0f);
        return select(c >= 0.0f, float1(0.0f), real);
    }

    static Profile profile_of(const Relief& relief, const TexelWalk& cells, const State& at) {
        const float2 texel = let("near_texel", cells.near_texel(at.crossed)),
                     step = cells.texel_step();
        const float2 far = let("far_texel", texel + step);
        const float1 h00 = let("h00", relief.height(texel));
        const float1 h10 = let("h10", relief.height(float2(far.x(), texel.y())));
        const float1 h01 = let("h01", relief.height(float2(texel.x(), far.y())));
        const float1 h11 = let("h11", relief.height(far));
        const float2 place = let("place", cells.inside(at.crossed, at.t));
        const float2 rise = let("rise", float2(h10 - h00, h01 - h00));
        return Profile::of(h00, rise, let("twist", h11 - h10 - rise.y()), place, cells.speed,
                           1 - at.t, 1);
    }

    static Hit hit_of(const Relief& relief, const Ray& ray, const State& at) {
        const float1 t = at.t, beyond = at.beyond;
        // The floor of the relief is there, however a device's division rounds the last root.
        const bool last_section = relief.section + 1 == relief.sections;
        const bool1 met = last_section ? at.found || t >= 1.0f : bool1(at.found);
        return {let("displaced", ray.at(t)), 1 - t, met, beyond};
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_exact() {
    return dsl::entry<dsl::Search, Exact>(
        "exact", "Every patch along the ray that reaches up to it, solved: misses nothing", "");
}

}  // namespace intaglio::templates

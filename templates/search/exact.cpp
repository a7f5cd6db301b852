// The exact search: texel by texel along the ray, in each cell the first intersection with the
// bilinear patch that the texture unit reconstructs between four texel centres.  Nothing is
// sampled, so nothing is missed, at any angle.  Our own; cell walks of height fields go back to
// Musgrave, "Grid Tracing: Fast Ray Tracing for Height Fields", 1988, the quadratic along a ray to
// Ramsey, Potter and Hansen, "Ray Bilinear Patch Intersections", 2004.
//
// In a cell, with s from where the ray enters it, the relief rises above the ray by
// a s^2 + b s - c.  It is below at the entry, c > 0, so that the first root is the only one that
// matters: 2 c / (b + root), or where b < 0 the same number without its cancellation,
// (root - b) / 2 a.
#include "templates/all_techniques.h"
#include "templates/search/texel_walk.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Exact : public Search {
  public:
    Knob<int> max_cells{this,
                        "max_cells",
                        240,
                        at_least{1},
                        at_most{4096},
                        "cells walked at most; a ray crosses |reach.x * width| + |reach.y * "
                        "height| + 2"};
    Loop walk{"walk", max_cells};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const TexelWalk cells = TexelWalk::along(ray, relief.map_size, 0.5f);
        Step walking("walk", "Solve the patch of each cell that the ray crosses.");
        var<float1> t{"t", 0.0f}, beyond{"beyond", 0.0f};
        var<float2> crossed{"crossed", float2(0.0f, 0.0f)};
        var<bool1> found{"found", false};
        for ([[maybe_unused]] int1 i : walk) {
            const float2 next = let("next", cells.next(crossed));
            const float1 leave = let("leave", min(min(next.x(), next.y()), 1.0f));
            const float1 span = let("span", leave - t);
            const Profile profile = profile_of(relief, cells, crossed, t);
            const float1 root = let("root", profile.first_root());
            found = root <= span;
            beyond = profile.at(span) + (1 - leave);
            t = select(root <= span, t + root, leave);
            walk.until(root <= span || leave >= 1.0f);
            crossed = TexelWalk::over_nearer(crossed, next);
        }
        // The floor of the relief is there, however a device's division rounds the last root.
        const bool last_section = relief.section + 1 == relief.sections;
        const bool1 met = last_section ? found || t >= 1.0f : found;
        return {let("displaced", ray.at(t)), 1 - t, met, beyond};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(walk);
        s.on("*").loop(walk);
    }

  private:
    // How far the relief rises above the ray at s from the cell's entry: (a s + b) s + c.
    struct Profile {
        float1 a, b, c;

        float1 at(float1 s) const { return (a * s + b) * s + c; }
        // The least s >= 0 where the ray is not above the relief; beyond any cell where there is
        // none.
        float1 first_root() const {
            const float1 square = let("square", b * b - 4.0f * a * c);
            const float1 both = let("both", abs(b) + sqrt(max(square, 0.0f)));
            // A divisor of 0 or below makes a root far outside of the cell, which there is none in.
            const float1 rising = -2.0f * c / max(both, tiny);
            const float1 falling = both / max(2.0f * a, tiny);
            const float1 ahead = select(b >= 0.0f, rising, falling);
            const float1 real = select(square >= 0.0f, ahead, 4.0f);
            return select(c >= 0.0f, float1(0.0f), real);
        }
    };

    static Profile profile_of(const Relief& relief, const TexelWalk& cells, float2 crossed,
                              float1 t) {
        const float2 texel = let("near_texel", cells.near_texel(crossed)),
                     step = cells.texel_step();
        const float2 far = let("far_texel", texel + step);
        const float1 h00 = let("h00", relief.height(texel));
        const float1 h10 = let("h10", relief.height(float2(far.x(), texel.y())));
        const float1 h01 = let("h01", relief.height(float2(texel.x(), far.y())));
        const float1 h11 = let("h11", relief.height(far));

        const float2 place = let("place", cells.inside(crossed, t));
        const float2 rise = let("rise", float2(h10 - h00, h01 - h00));
        const float1 twist = let("twist", h11 - h10 - rise.y());
        const float2 slope = let("slope", rise + place.yx() * twist);
        return {let("a", twist * cells.speed.x() * cells.speed.y()),
                let("b", dot(slope, cells.speed) + 1.0f),
                let("c", h00 + dot(rise, place) + twist * place.x() * place.y() - (1 - t))};
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_exact() {
    return dsl::entry<dsl::Search, Exact>(
        "exact", "Every cell along the ray, its bilinear patch solved: misses nothing", "");
}

}  // namespace intaglio::templates

// The quadtree of maxima: a ray above a node's highest point crosses the whole node in one step and
// goes on in a node twice as large; else it descends to where it reaches that height, and in a
// smaller node.  Tevs, Ihrke and Seidel, "Maximum Mipmaps for Fast, Accurate, and Scalable Dynamic
// Height Field Rendering", I3D 2008; Drobot, "Quadtree Displacement Mapping", GPU Pro, 2010.
//
// The sources' leaves are texels; ours are the patches between texel centres, and in a leaf the
// crossing is solved: along a line a patch is a quadratic, which three filtered reads know whole.
// Both axes are mirrored where the ray runs towards lower coordinates, so that it always moves up
// and a ray along an axis divides by no zero.  Safe, up to the filter's precision and a thousandth
// of a texel that each border is stepped over by.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

// Beyond any border, in texels: what rounding may make of a position on a border.
constexpr float over_border = 1.0f / 1024;

class MaxMip : public Search {
  public:
    Knob<int> max_nodes{this,        "max_nodes",   96,
                        at_least{1}, at_most{4096}, "nodes looked at, at most"};
    Loop traverse{"traverse", max_nodes};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const sampler2D nodes("max_mip_map", "highest point of the relief over a node, in red",
                              sampler2D::Filter::Nearest);
        const float2 size = relief.map_size;
        const auto forward = [](float1 reach) {
            return select(reach <= 0.0f, float1(1.0f), -1.0f);
        };
        const float2 way = let("way", float2(forward(ray.reach.x()), forward(ray.reach.y())));
        const float2 start = let("start", way * (frac(ray.uv) - float2(0.5f, 0.5f) / size));
        const float2 speed = let("speed", abs(ray.reach));
        const float2 pause = let("pause", float2(1.0f, 1.0f) / max(speed, float1(tiny)));
        const float2 texels = speed * size;
        const float1 nudge =
            let("nudge", over_border / max(max(texels.x(), texels.y()), float1(1.0f)));
        // The root of the tree; rounded, because powers of two are not exact everywhere.
        const float1 top = let("top", floor(log2(max(size.x(), size.y())) + 0.001f));

        Step traversing("traverse", "Cross nodes that lie below the ray, descend into the others.");
        var<float1> t{"t", 0.0f}, level{"level", top},
            share{"share", 1.0f / floor(exp2(top) + 0.5f)}, beyond{"beyond", 0.0f};
        var<bool1> found{"found", false};
        for ([[maybe_unused]] int1 i : traverse) {
            const float2 count = let("count", max(floor(size * share), 1.0f));
            const float2 node = let("node", floor((start + speed * t) * count));
            const float2 next = let("next", ((node + 1.0f) / count - start) * pause);
            const float1 leave = let("leave", max(min(min(next.x(), next.y()), 1.0f), t));
            const float1 highest =
                let("highest",
                    relief.in_section(nodes.sample_level(way * (node + 0.5f) / count, level).x()));
            const bool1 over = let("over", 1 - leave > highest);
            const bool1 leaf = let("leaf", level < 0.5f);
            var<bool1> cross{"cross", over};
            If(leaf && !over, [&] {
                const float1 span = let("span", leave - t);
                const float1 first = gap(relief, ray, t), last = gap(relief, ray, leave);
                const float1 root =
                    let("root", first_root(first, gap(relief, ray, t + span * 0.5f), last));
                found = root <= 1.0f;
                cross = root > 1.0f;
                t = select(root <= 1.0f, t + span * root, t);
                beyond = last + (1 - leave);
            });
            traverse.until(found);
            // Down: to where the ray reaches the node's height.  Up: behind the node.
            t = select(cross, leave + nudge, max(t, min(1 - highest, leave)));
            traverse.until(t >= 1.0f);
            const bool1 rise = cross && level < top - 0.5f;
            const bool1 sink = !cross && level > 0.5f;
            level = level + select(rise, float1(1.0f), select(sink, float1(-1.0f), 0.0f));
            share = share * select(rise, float1(0.5f), select(sink, float1(2.0f), 1.0f));
        }
        const float1 hit = let("hit", min(t, 1.0f));
        const bool last_section = relief.section + 1 == relief.sections;
        return {let("displaced", ray.at(hit)), 1 - hit,
                last_section ? bool1(true) : found || t < 1.0f, beyond};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(traverse);
        s.on("*").loop(traverse);
    }

  private:
    // How far the relief rises above the ray.
    static float1 gap(const Relief& relief, const Ray& ray, float1 t) {
        return relief.height(ray.at(t)) - (1 - t);
    }

    // The least s >= 0 at which the parabola through (0, first), (1/2, middle) and (1, last) is not
    // below 0; above 1 where there is none in [0, 1].
    static float1 first_root(float1 first, float1 middle, float1 last) {
        const float1 a = let("curve", 2.0f * (first + last) - 4.0f * middle);
        const float1 b = let("rise", last - first - a);
        const float1 square = let("square", b * b - 4.0f * a * first);
        const float1 both = let("both", abs(b) + sqrt(max(square, 0.0f)));
        const float1 rising = -2.0f * first / max(both, tiny);
        const float1 falling = both / max(2.0f * a, tiny);
        const float1 ahead = select(b >= 0.0f, rising, falling);
        const float1 real = select(square >= 0.0f, ahead, 4.0f);
        // Where the end is inside there is a root, whatever rounding says.
        const float1 certain = select(last >= 0.0f, min(real, 1.0f), real);
        return select(first >= 0.0f, float1(0.0f), certain);
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_max_mip() {
    return dsl::entry<dsl::Search, MaxMip>(
        "max_mip", "Descends the quadtree of the relief's maxima along the ray",
        "Tevs et al. 2008; Drobot 2010");
}

}  // namespace intaglio::templates

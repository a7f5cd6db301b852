// Cone stepping: from cone to cone.  The map's alpha says how wide a cone over each texel is empty;
// the ray may advance to the cone's border at once.  Dummer, "Cone Step Mapping: An Iterative
// Ray-Heightfield Intersection Algorithm", 2006.  Relaxed: the cone may hold relief, as long as a
// ray enters it at most once; the one crossing of the last step is then halved.  Policarpo and
// Oliveira, "Relaxed Cone Stepping for Relief Mapping", GPU Gems 3, 2007; 15 steps and 8 halvings
// as theirs.
//
// Both sources store cones over texels, which a filtered read falls short of: rays slip through.
// Ours hold for every position between the texels (docs/maps.md), so that neither search ever
// passes through the relief; where steps run out it stops in front of it.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

// The map read at one position of the ray.
struct Cone {
    float1 gap;    // how far the ray is above the relief
    float1 ratio;  // radius in texture units at one unit of height above the apex

    static Cone at(const sampler2D& map, const Relief& relief, const Ray& ray, float1 t) {
        const float4 texel = let("texel", map.sample_level(ray.at(t), 0.0f));
        const float1 ratio = let("ratio", texel.w() * texel.w());
        return {
            let("gap", 1 - t - relief.in_section(texel.x())),
            relief.sections == 1 ? ratio : ratio * (1.0f / static_cast<float>(relief.sections))};
    }
    // To where a ray that travels so far for a descent of 1 leaves the cone.
    float1 step(float1 travel) const { return ratio * gap / max(travel + ratio, tiny); }
};

class ConeStepping : public Search {
  public:
    Knob<int> cone_steps{this,        "cone_steps", 32,
                         at_least{1}, at_most{512}, "cones stepped over at most"};
    // Cones end the nearer the closer the ray is: without an end they are never done.
    Knob<float> contact{this,       "cone_contact",
                        0.002f,     at_least{0},
                        at_most{1}, "height above the relief that counts as a hit"};
    Loop march{"march", cone_steps};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const sampler2D map("cone_map", "height in red, root of the empty cone's ratio in alpha");
        const float1 travel = let("travel", length(ray.reach));
        Step marching("march", "Step to the border of each empty cone.");
        var<float1> t{"t", 0.0f}, height{"height", 1.0f};
        for ([[maybe_unused]] int1 i : march) {
            const Cone cone = Cone::at(map, relief, ray, t);
            height = 1 - t - cone.gap;
            march.until(cone.gap <= contact.value() || t >= 1.0f);
            t = min(t + cone.step(travel), 1.0f);
        }
        const bool last = relief.section + 1 == relief.sections;
        return {let("displaced", ray.at(t)), 1 - t, last ? bool1(true) : t < 1.0f, height};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march);
        s.on("*").loop(march);
    }
};

class RelaxedConeStepping : public Search {
  public:
    Knob<int> cone_steps{this,        "cone_steps", 15,
                         at_least{1}, at_most{512}, "cones stepped over at most"};
    Knob<int> binary_steps{this,        "binary_steps", 8,
                           at_least{0}, at_most{24},    "halvings of the step that went in"};
    Loop march{"march", cone_steps};
    Loop halve{"halve", binary_steps};

    Hit find(const Relief& relief, const Ray& ray) const override {
        const sampler2D map("relaxed_cone_map",
                            "height in red, root of the relaxed cone's ratio in alpha");
        const float1 travel = let("travel", length(ray.reach));
        Step marching("march", "Step to the border of each cone, until a step went in.");
        var<float1> t{"t", 0.0f}, width{"width", 0.0f}, height{"height", 1.0f};
        for ([[maybe_unused]] int1 i : march) {
            const Cone cone = Cone::at(map, relief, ray, t);
            height = 1 - t - cone.gap;
            march.until(cone.gap <= 0.0f || t >= 1.0f);
            width = min(cone.step(travel), 1 - t);
            t = t + width;
        }
        Step halving("refine", "Halve the last step: there is one crossing in it at most.");
        // The crossing lies in (hit - width, hit]; where no step went in, nothing moves.
        var<float1> hit{"hit", t};
        for ([[maybe_unused]] int1 i : halve) {
            width = width * 0.5f;
            const float1 middle = let("middle", hit - width);
            const Cone cone = Cone::at(map, relief, ray, middle);
            hit = select(cone.gap <= 0.0f, middle, hit);
        }
        const bool last = relief.section + 1 == relief.sections;
        return {let("displaced", ray.at(hit)), 1 - hit, last ? bool1(true) : hit < 1.0f, height};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march).unroll(halve);
        s.on("*").loop(march).loop(halve);
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_cone() {
    return dsl::entry<dsl::Search, ConeStepping>(
        "cone", "Steps over empty cones, which never pass through the relief", "Dummer 2006");
}

dsl::Entry<dsl::Search> search_cone_relaxed() {
    return dsl::entry<dsl::Search, RelaxedConeStepping>(
        "cone_relaxed", "Steps over cones that a ray enters the relief in once, then halvings",
        "Policarpo and Oliveira 2007");
}

}  // namespace intaglio::templates

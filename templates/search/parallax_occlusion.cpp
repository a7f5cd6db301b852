// Parallax occlusion mapping: read the height profile along the view ray in equal steps, stop at
// the first sample that rises above the ray, and intersect the ray with the profile's last segment.
// Brawley and Tatarchuk, "Parallax Occlusion Mapping: Self-Shadowing, Perspective-Correct Bump
// Mapping Using Reverse Height Map Tracing", ShaderX3, 2004.
//
// The chapter's listing numbers its samples from the bottom (h0 at the ray's end) and takes its
// parallax vector in the vertex shader; ours counts from the top and computes the vector per pixel.
// Like the listing we spend no read on the entry point: the profile before the first tap is level
// with it.  The last tap lies on the floor of the relief, so one tap always rises above the ray.
//
// Off by default, and then nothing of them is recorded: the chapter's perspective bias and its
// power of N.V, which shorten the ray towards the horizon, and the fade to plain bump mapping by
// mip level of Tatarchuk, "Dynamic Parallax Occlusion Mapping with Approximate Soft Shadows", I3D
// 2006.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class ParallaxOcclusion : public Search {
  public:
    Knob<int> taps{this, "taps", 8, at_least{1}, at_most{256}, "height reads along the ray"};
    Knob<float> perspective_bias{
        this,       "perspective_bias",
        1.0f,       at_least{0},
        at_most{1}, "1: the true ray; below, shorter ones towards the horizon"};
    Knob<float> attenuation{this,       "attenuation",
                            0.0f,       at_least{0},
                            at_most{8}, "power of N.V that shortens the ray; 0: none"};
    Knob<float> fade_level{this,        "fade_level",
                           0.0f,        at_least{0},
                           at_most{16}, "mip level from which on nothing is displaced; 0: no fade"};
    Loop march{"march", taps, -1};  // the first tap stands before the loop

    Hit find(const Relief& relief, const Ray& true_ray) const override {
        const Ray ray = shortened(true_ray);
        const bool fades = fade_level > 0;
        const float1 share = fades ? fade(relief, ray) : float1(1.0f);
        const float step = 1.0f / static_cast<float>(taps.value());
        // How far the relief rises above the ray at t; below 0 the ray is still outside.
        const auto gap = [&](float1 t) { return relief.height(ray.at(t)) - (1 - t); };

        var<float1> t{"t", step}, below{"below", gap(step)};
        var<float1> above{"above", ray.entry_height ? *ray.entry_height - 1.0f : below - step};
        {
            Step marching("march",
                          "Walk down the ray until a sample of the height profile rises above it.");
            for (int1 i : march) {
                march.until(fades ? below >= 0.0f || share <= 0.0f : below >= 0.0f);
                above = below;
                t = (i + 2) * step;  // from i, so that the taps do not depend on each other
                below = gap(t);
            }
        }
        Step refining("refine", "Intersect the ray with the last segment of the profile.");
        const float1 hit = let("hit", t - step * ratio(below, below - above));
        const float1 moved = fades ? hit * share : hit;
        // A section begins where the true ray leaves the one above it, which a shortened ray, or a
        // faded hit, is not on: then it does not say what it found, and so runs in no sections.
        const bool bent = perspective_bias < 1 || attenuation > 0 || fades;
        if (bent && relief.sections > 1) return {let("displaced", ray.at(moved)), 1 - hit};
        // Where nothing was found the last gap is the relief's height: there the ray is at 0.
        return {let("displaced", ray.at(moved)), 1 - hit, below >= 0.0f, below};
    }

    void schedule(Schedule& s) const override {
        s.on("ps_2_*").unroll(march);
        s.on("*").loop(march);
    }

  private:
    // The chapter's two ways against the flattening at the horizon, where offsets grow without
    // bound.  Its bias turns the ray round where b + (1 - b)(2 z - 1) < 0; ours stops there.
    Ray shortened(const Ray& ray) const {
        Ray result = ray;
        const float bias = perspective_bias.value();
        if (bias < 1)
            result.reach =
                let("biased_reach",
                    result.reach * max(bias + (1 - bias) * (2.0f * ray.view.z() - 1.0f), 0.0f));
        if (attenuation > 0)
            result.reach = let(
                "attenuated_reach",
                result.reach * pow(max(saturate(ray.view.z()), Ray::least_z), attenuation.value()));
        return result;
    }

    // 1 up to one level below fade_level, 0 from there on: the level that a colour read would take.
    float1 fade(const Relief& relief, const Ray& ray) const {
        const float2 uv = ray.polygon_uv.value_or(ray.uv);
        const float2 dx = let("texels_dx", ddx(uv) * relief.map_size);
        const float2 dy = let("texels_dy", ddy(uv) * relief.map_size);
        const float1 level =
            let("mip_level", 0.5f * log2(max(max(dot(dx, dx), dot(dy, dy)), tiny)));
        return let("fade", saturate(fade_level.value() - level));
    }
};

}  // namespace

dsl::Entry<dsl::Search> search_parallax_occlusion() {
    return dsl::entry<dsl::Search, ParallaxOcclusion>(
        "parallax_occlusion",
        "Equal steps along the view ray, then one intersection with the last segment",
        "Brawley and Tatarchuk 2004");
}

}  // namespace intaglio::templates

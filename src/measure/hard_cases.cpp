// The tables of the suite.
#include "src/measure/hard_cases.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include <fmt/format.h>

#include "src/measure/view.h"

namespace intaglio::measure {
namespace {

constexpr float usual_scale = 0.08f;
const std::array<float, 3> usual_light = vector_of({50, 120});

std::vector<Aim> seen_from(const std::vector<Direction>& views) {
    std::vector<Aim> aims;
    for (Direction view : views) aims.push_back({vector_of(view), usual_light});
    return aims;
}
std::vector<Aim> lit_from(const std::vector<std::array<float, 3>>& lights) {
    std::vector<Aim> aims;
    for (const std::array<float, 3>& light : lights) aims.push_back({vector_of({60, 30}), light});
    return aims;
}
const std::vector<Aim> usual = seen_from({{45, 30}});

using Expects = std::vector<std::pair<HardPart, Expect>>;
Expects of_searches(Expect expect) {
    return {{HardPart::Search, expect}, {HardPart::Colour, Expect::OwnFormula}};
}
Expects of_everything(Expect expect) {
    return {{HardPart::Search, expect},
            {HardPart::Shadow, Expect::Shadow},
            {HardPart::Colour, Expect::OwnFormula}};
}
Expects of_lights(Expect expect) {
    return {{HardPart::Shadow, expect}, {HardPart::Colour, Expect::OwnFormula}};
}

void add_views(std::vector<HardCase>& all) {
    const auto add = [&](std::string name, std::string expectation, std::string reason,
                         std::vector<Aim> aims, Expect expect, std::string patch = "general") {
        all.push_back({std::move(name), std::move(expectation), std::move(reason), "smooth",
                       std::move(patch), std::move(aims), usual_scale, of_searches(expect)});
    };
    add("straight_down", "the hit is the coordinate, to the bit",
        "V.xy = 0: normalize(V.xy) is 0 / 0, and published listings make NaN of every pixel",
        seen_from({{90, 0}}), Expect::Undisplaced);
    add("89_degrees", "as at any angle", "the ray crosses 290 texels",
        seen_from({{1, 33}, {1, 200}}), Expect::Yardstick);
    add("89_9_degrees", "as at any angle, as far as the steps reach",
        "the ray crosses 2900 texels; offsets of 46 tiles cost 6 bits of the coordinate",
        seen_from({{0.1, 33}}), Expect::Yardstick);
    add("beyond_89_94_degrees", "a point of the flattest ray, finite",
        "V.z below 1/1024: V.xy / V.z grows without bound", seen_from({{0.01, 33}, {0.001, 110}}),
        Expect::OnFlattest);
    add("at_the_horizon", "a point of the flattest ray, finite", "V.z = 0: V.xy / V.z is infinite",
        seen_from({{0, 0}, {0, 75}}), Expect::OnFlattest);
    add("below_the_horizon", "a point of the flattest ray, finite",
        "V.z < 0 by interpolation or on a back face: an unguarded ray climbs out of the relief",
        seen_from({{-30, 33}, {-89.9, 33}, {-90, 0}}), Expect::OnFlattest);
    add("axis_aligned", "as at any angle", "1 / V.x or 1 / V.y is infinite in a walk over texels",
        seen_from({{30, 0}, {30, 90}, {30, 180}, {30, 270}}), Expect::Yardstick);
    add("diagonal", "as at any angle", "both texel borders are crossed at once",
        seen_from({{30, 45}, {30, 135}, {30, 225}, {30, 315}}), Expect::Yardstick);
    add("through_corners", "as at any angle", "a diagonal through texel centres meets every corner",
        seen_from({{30, 45}, {30, 135}, {30, 225}, {30, 315}}), Expect::Yardstick, "corners");
    add("along_borders", "as at any angle", "an axis-aligned ray runs on the border of two cells",
        seen_from({{30, 0}, {30, 90}, {30, 180}, {30, 270}}), Expect::Yardstick, "corners");
}

void add_reliefs(std::vector<HardCase>& all) {
    const auto add = [&](std::string name, std::string map, std::string expectation,
                         std::string reason, Expect expect = Expect::Yardstick) {
        all.push_back({std::move(name), std::move(expectation), std::move(reason), std::move(map),
                       "general", seen_from({{45, 30}, {20, 200}}), usual_scale,
                       of_everything(expect)});
    };
    add("spikes", "spikes", "as on smooth relief; what is safe misses none",
        "a spike one texel wide lies between two steps");
    add("walls", "walls", "as on smooth relief; what is safe misses none",
        "a wall one texel wide is crossed within a step, and its secant spans a cliff");
    add("comb_at_nyquist", "comb_at_nyquist", "as on smooth relief; what is safe misses none",
        "teeth one texel wide, gaps of one");
    add("comb_above_nyquist", "comb_above_nyquist", "as on smooth relief; what is safe misses none",
        "a comb of period 1.5 texels, of which the map holds the alias");
    add("steps", "steps", "as on smooth relief", "plateaus: the secant's two heights are equal");
    add("flat_0", "flat0", "the end of the ray, at full depth",
        "the loop ends without a hit; the secant is 0 / 0", Expect::Within16th);
    add("flat_1", "flat1", "no displacement",
        "the first sample is inside; the secant is 0 / 0, a cone is 0 / 0", Expect::Within16th);
    add("map_1x1", "1x1", "as on any flat relief", "one texel, all neighbours itself",
        Expect::Within16th);
    add("map_1x64", "1x64", "as on any relief", "texels 64 times as wide as high");
    add("map_64x1", "64x1", "as on any relief", "texels 64 times as high as wide");
    add("map_16_bits", "16_bits", "as on any relief", "steps of 1/65535, filtered by the format");
}

void add_coordinates(std::vector<HardCase>& all) {
    for (const char* place : {"0", "1", "64", "1000", "100000"})
        all.push_back({fmt::format("uv_{}", place),
                       "the hit of the coordinate as the format holds it, within half a texel and "
                       "two units in its last place",
                       std::string(place) == "0"
                           ? "rays run to negative coordinates"
                           : "the coordinate's whole part takes bits from its fraction",
                       "smooth", fmt::format("uv_{}", place), usual, usual_scale,
                       of_searches(Expect::FormatsBest)});
    const auto scaled = [&](std::string name, float scale, std::string expectation,
                            std::string reason, Expect expect) {
        all.push_back({std::move(name), std::move(expectation), std::move(reason), "smooth",
                       "general", usual, scale, of_searches(expect)});
    };
    scaled("scale_0", 0, "the hit is the coordinate, to the bit", "the ray has no length",
           Expect::Undisplaced);
    scaled("scale_denormal", 1e-40f, "the hit is the coordinate, to the bit",
           "a denormal is 0 on some devices and not on others", Expect::Undisplaced);
    scaled("scale_1", 1, "as at any scale", "a relief as deep as wide: the ray crosses 83 texels",
           Expect::Yardstick);
}

void add_inputs(std::vector<HardCase>& all) {
    const auto add = [&](std::string name, std::string expectation, std::string reason,
                         std::array<float, 3> eye, std::array<float, 3> light, Expect expect) {
        all.push_back({std::move(name),
                       std::move(expectation),
                       std::move(reason),
                       "smooth",
                       "general",
                       {{eye, light}},
                       usual_scale,
                       {{HardPart::Search, expect},
                        {HardPart::Shadow, Expect::OwnFormula},
                        {HardPart::Colour, Expect::OwnFormula}}});
    };
    add("zero_vectors", "no displacement, to the bit, and no light",
        "an eye or a light on the surface: normalize(0) is NaN", {0, 0, 0}, {0, 0, 0},
        Expect::Undisplaced);
    add("denormal_vectors", "a point of the flattest ray, finite",
        "the squared length of a denormal is 0", {1e-40f, 2e-40f, 1e-40f}, {1e-40f, 0, 1e-40f},
        Expect::OnFlattest);
    add("tiny_vectors", "a point of the flattest ray, finite",
        "the squared length of 1e-10 is below the guard's 1e-18", {1e-10f, 2e-10f, 1e-10f},
        {1e-10f, 0, 1e-10f}, Expect::OnFlattest);
    add("long_vectors", "as at any length", "the squared length of 1e4 is no half",
        {1e4f, 2e4f, 2e4f}, {1e4f, 0, 1e4f}, Expect::Yardstick);
    add("huge_vectors", "a point of the flattest ray, finite",
        "the squared length of 1e20 overflows", {1e20f, 2e20f, 1e20f}, {1e20f, 0, 1e20f},
        Expect::OnFlattest);
}

void add_frames(std::vector<HardCase>& all) {
    all.push_back({"mirrored_uv", "the hit of the mirrored ray",
                   "a negative determinant turns the bitangent, and with it view and shadow",
                   "smooth", "mirrored", usual, usual_scale, of_everything(Expect::Yardstick)});
    const auto add = [&](std::string name, std::string reason) {
        all.push_back({name,
                       "a point of the flattest ray, finite",
                       std::move(reason),
                       "smooth",
                       name,
                       usual,
                       usual_scale,
                       {{HardPart::Search, Expect::OnFlattest},
                        {HardPart::Shadow, Expect::OwnFormula},
                        {HardPart::Colour, Expect::OwnFormula}}});
    };
    add("tangent_0", "degenerate uv give no tangent: normalize(0)");
    add("tangent_is_normal", "the bitangent is a cross product of parallel vectors");
    add("normal_0", "a collapsed normal: normalize(0), and V.z = 0");
    add("frame_0", "nothing of the frame is there");
}

void add_lights(std::vector<HardCase>& all) {
    const auto add = [&](std::string name, std::string expectation, std::string reason,
                         std::vector<std::array<float, 3>> lights, Expect expect) {
        all.push_back({std::move(name), std::move(expectation), std::move(reason), "smooth",
                       "general", lit_from(lights), usual_scale, of_lights(expect)});
    };
    add("light_overhead", "every point is lit", "L.xy = 0: normalize(L.xy) is 0 / 0", {{0, 0, 1}},
        Expect::Lit);
    add("light_axis_aligned", "the exact shadow", "1 / L.x is infinite in a walk over texels",
        {vector_of({20, 0}), vector_of({20, 90}), vector_of({20, 180}), vector_of({20, 270})},
        Expect::Shadow);
    add("light_diagonal", "the exact shadow", "both texel borders are crossed at once",
        {vector_of({20, 45}), vector_of({20, 225})}, Expect::Shadow);
    add("light_grazing", "the exact shadow", "the light ray crosses 300 texels",
        {vector_of({1, 33})}, Expect::Shadow);
    add("light_at_the_horizon", "no point is lit", "L.z = 0: L.xy / L.z is infinite",
        {{1, 0, 0}, vector_of({0, 75})}, Expect::Dark);
    add("light_below", "no point is lit", "L.z < 0: an unguarded ray runs into the ground",
        {vector_of({-20, 33}), {0, 0, -1}}, Expect::Dark);
}

HardRow search(const std::string& name, std::vector<std::pair<std::string, std::string>> knobs = {},
               HardYardstick yardstick = HardYardstick::FirstHit, bool safe = false,
               const std::string& title = {}) {
    // Steps a texel long promise the texel: up to its diagonal, and a little.
    const bool texel_steps = !knobs.empty() && knobs[0].first == "stride";
    return {title.empty() ? name : title,
            fmt::format("search={},output=displaced", name),
            std::move(knobs),
            HardPart::Search,
            yardstick,
            texel_steps ? 1.5 : 0.5,
            safe};
}
HardRow part(const std::string& kind, const std::string& name) {
    if (kind == "shadow")
        return {"shadow " + name,
                fmt::format("search=exact,shadow={},output=displaced", name),
                {},
                HardPart::Shadow,
                // Darkening with depth asks for no light.
                name == "fur_depth" ? HardYardstick::OwnFormula : HardYardstick::FirstHit};
    return {fmt::format("{} {}", kind, name),
            fmt::format("search=none,{}={}", kind, name),
            {},
            HardPart::Colour,
            HardYardstick::OwnFormula};
}

maps::Image heights_of(int width, int height, float (*at)(int x, int y)) {
    maps::Image image = maps::blank_image(width, height, 1, 16);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y) = at(x, y);
    return image;
}

// Our own tables cannot be wrong: a diagnostic here is a bug of ours.
MapSet must(Result<MapSet> set) {
    if (!set) {
        fmt::print(stderr, "{}\n", to_string(set.error()));
        std::abort();
    }
    return std::move(*set);
}

std::map<std::string, MapSet> made_maps() {
    std::map<std::string, MapSet> all;
    for (const char* maker : {"smooth", "spikes", "steps", "flat0", "flat1"})
        all.emplace(maker, must(make_map_set(maker, 64, 64, usual_scale)));
    const auto add = [&](const char* name, const maps::Image& heights) {
        all.emplace(name, must(map_set_from_heights(name, heights, usual_scale)));
    };
    add("walls",
        heights_of(64, 64, [](int x, int y) { return x % 16 == 5 || y % 32 == 11 ? 1.0f : 0.1f; }));
    add("comb_at_nyquist", heights_of(64, 64, [](int x, int) { return x % 2 == 0 ? 1.0f : 0.0f; }));
    // 1 in the first half of each period of 1.5 texels, at texels 0, 1, 2: 1, 0, 1.
    add("comb_above_nyquist",
        heights_of(48, 64, [](int x, int) { return x % 3 == 1 ? 0.0f : 1.0f; }));
    add("1x1", heights_of(1, 1, [](int, int) { return 0.375f; }));
    const maps::Image smooth = must(make_map_set("smooth", 64, 64, usual_scale)).heights;
    maps::Image column = maps::blank_image(1, 64, 1, 16), row = maps::blank_image(64, 1, 1, 16);
    for (int i = 0; i < 64; ++i) {
        column.at(0, i) = smooth.at(20, i);
        row.at(i, 0) = smooth.at(i, 20);
    }
    add("1x64", column);
    add("64x1", row);
    all.emplace("16_bits", must(make_map_set("noise", 64, 64, usual_scale)));
    return all;
}

}  // namespace

const std::vector<HardRow>& hard_rows() {
    using Y = HardYardstick;
    static const std::vector<HardRow> all = {
        search("none", {}, Y::OwnFormula),
        search("parallax", {}, Y::OwnFormula),
        search("parallax_limited", {{"normal_weight", "1"}}, Y::OwnFormula),
        search("parallax_iterative", {}, Y::OwnFormula),
        search("steep_parallax"),
        search("steep_parallax", {{"nyquist", "1"}}, Y::OwnFormula, false, "steep, nyquist"),
        search("steep_parallax", {{"stride", "1"}}, Y::FirstHit, false, "steep, stride 1"),
        search("steep_parallax", {{"stride", "2"}}, Y::FirstHit, false, "steep, stride 2"),
        search("steep_parallax", {{"stride", "3"}}, Y::OwnFormula, false, "steep, stride 3"),
        search("parallax_occlusion"),
        search("relief"),
        search("relief_secant"),
        search("contact_refinement"),
        search("distance"),
        search("cone", {}, Y::FirstHit, true),
        search("cone_relaxed", {}, Y::FirstHit, true),
        search("max_mip", {}, Y::FirstHit, true),
        search("view_dependent", {}, Y::OwnFormula),
        search("exact", {}, Y::FirstHit, true),
        search("exact", {{"max_cells", "3600"}, {"max_leaps", "0"}}, Y::FirstHit, true,
               "exact, 3600 cells, no leaps"),
        part("shadow", "march"),
        part("shadow", "soft"),
        part("shadow", "occlusion_profile"),
        part("shadow", "horizon"),
        part("shadow", "exact"),
        part("shadow", "fur_depth"),
        part("normal", "map"),
        part("normal", "blinn"),
        part("normal", "smoothed"),
        part("normal", "from_hit"),
        part("shading", "lambert"),
        part("shading", "phong_map"),
        part("shading", "emboss"),
        part("shading", "ambient_only"),
        part("output", "depth"),
    };
    return all;
}

const std::vector<HardPatch>& hard_patches() {
    // In general position: on no line between texels or texel centres.
    constexpr float u = 0.0137f, v = 0.0071f;
    static const std::vector<HardPatch> all = {
        {"general", {u, v}},
        {"corners", {0.5f / 64, 0.5f / 64}},
        {"uv_0", {0, 0}},
        {"uv_1", {1, 1}},
        {"uv_64", {64, 64}},
        {"uv_1000", {1000, 1000}},
        {"uv_100000", {100000, 100000}},
        {"mirrored", {u, v}, {0, 0, 1}, {1, 0, 0, -1}, true},
        {"tangent_0", {u, v}, {0, 0, 1}, {0, 0, 0, 1}},
        {"tangent_is_normal", {u, v}, {0, 0, 1}, {0, 0, 1, 1}},
        {"normal_0", {u, v}, {0, 0, 0}, {1, 0, 0, 1}},
        {"frame_0", {u, v}, {0, 0, 0}, {0, 0, 0, 0}},
    };
    return all;
}

vulkan::Vertex hard_vertex(int x, int y) {
    const auto index =
        static_cast<std::size_t>(y / patch_pixels * patches_across + x / patch_pixels);
    const HardPatch& patch = hard_patches()[std::min(index, hard_patches().size() - 1)];
    const auto inside = [](int pixel) {
        return (static_cast<float>(pixel % patch_pixels) + 0.5f) / patch_pixels;
    };
    const float down = patch.mirrored ? 1 - inside(y) : inside(y);
    return {{(static_cast<float>(x) + 0.5f) / hard_pixels,
             (static_cast<float>(y) + 0.5f) / hard_pixels, 0},
            patch.normal,
            patch.tangent,
            {patch.uv[0] + inside(x), patch.uv[1] + down}};
}

vulkan::Mesh hard_mesh() {
    vulkan::Mesh mesh;
    constexpr float side = 1.0f / patches_across;
    for (std::size_t i = 0; i < hard_patches().size(); ++i) {
        const HardPatch& patch = hard_patches()[i];
        const float left = static_cast<float>(i % patches_across) * side,
                    top = static_cast<float>(i / patches_across) * side;
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int corner = 0; corner < 4; ++corner) {
            const float x = static_cast<float>(corner % 2), y = static_cast<float>(corner / 2);
            mesh.vertices.push_back(
                {{left + x * side, top + y * side, 0},
                 patch.normal,
                 patch.tangent,
                 {patch.uv[0] + x, patch.uv[1] + (patch.mirrored ? 1 - y : y)}});
        }
        for (std::uint32_t offset : {0u, 1u, 3u, 0u, 3u, 2u})
            mesh.indices.push_back(first + offset);
    }
    return mesh;
}

const MapSet& hard_map(const std::string& name) {
    static const std::map<std::string, MapSet> all = made_maps();
    return all.at(name);
}

Filtering hard_filtering(const std::string& map) {
    return map == "16_bits" ? Filtering::Native : Filtering::Float;
}

const std::vector<HardCase>& hard_cases() {
    static const std::vector<HardCase> all = [] {
        std::vector<HardCase> cases;
        add_views(cases);
        add_reliefs(cases);
        add_coordinates(cases);
        add_inputs(cases);
        add_frames(cases);
        add_lights(cases);
        return cases;
    }();
    return all;
}

}  // namespace intaglio::measure

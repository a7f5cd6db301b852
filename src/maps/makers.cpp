// The table of makers, and the look-ups in it.
#include "src/maps/makers.h"

#include <algorithm>
#include <string>
#include <vector>

#include "generator/base/nearest.h"
#include "src/maps/patterns.h"

namespace intaglio::maps {
namespace {

using Colours = std::array<ColourStop, 4>;
constexpr Colours brick_red = {{{0.0f, {0.62f, 0.60f, 0.56f}},
                                {0.35f, {0.66f, 0.63f, 0.58f}},
                                {0.55f, {0.50f, 0.24f, 0.17f}},
                                {1.0f, {0.72f, 0.36f, 0.25f}}}};
constexpr Colours granite = {{{0.0f, {0.16f, 0.15f, 0.12f}},
                              {0.2f, {0.27f, 0.25f, 0.20f}},
                              {0.5f, {0.45f, 0.44f, 0.42f}},
                              {1.0f, {0.68f, 0.67f, 0.64f}}}};
constexpr Colours gilded = {{{0.0f, {0.14f, 0.18f, 0.26f}},
                             {0.3f, {0.17f, 0.22f, 0.32f}},
                             {0.6f, {0.66f, 0.50f, 0.20f}},
                             {1.0f, {0.86f, 0.70f, 0.34f}}}};
constexpr Colours sandstone = {{{0.0f, {0.45f, 0.34f, 0.22f}},
                                {0.4f, {0.60f, 0.48f, 0.32f}},
                                {0.8f, {0.74f, 0.63f, 0.44f}},
                                {1.0f, {0.82f, 0.72f, 0.54f}}}};
constexpr Colours fox = {{{0.0f, {0.18f, 0.10f, 0.05f}},
                          {0.3f, {0.36f, 0.19f, 0.08f}},
                          {0.7f, {0.62f, 0.36f, 0.16f}},
                          {1.0f, {0.84f, 0.66f, 0.44f}}}};
constexpr Colours steel = {{{0.0f, {0.30f, 0.33f, 0.36f}},
                            {0.3f, {0.36f, 0.40f, 0.43f}},
                            {0.7f, {0.50f, 0.54f, 0.57f}},
                            {1.0f, {0.66f, 0.70f, 0.72f}}}};
constexpr Colours moss = {{{0.0f, {0.18f, 0.15f, 0.10f}},
                           {0.4f, {0.29f, 0.31f, 0.16f}},
                           {0.6f, {0.38f, 0.43f, 0.21f}},
                           {1.0f, {0.60f, 0.62f, 0.40f}}}};

constexpr Maker table[] = {
    {"bricks", "a running bond of bricks, each a little tilted, over recessed mortar", bricks,
     brick_red},
    {"cobbles", "rounded stones of random outline with dark joints", cobbles, granite},
    {"text", "raised letters with narrow slopes; the seed rotates the lines", text, gilded},
    {"pyramids", "4 x 4 square pyramids whose slopes are planes; the seed changes nothing",
     pyramids, sandstone},
    {"fur", "dense hairs about 3 texels thick, of random length", fur, fox},
    {"spikes", "one-texel spikes of full height on a flat floor, one in each 8 x 8 texels", spikes,
     steel},
    {"steps", "a staircase of 8 steps along u with a wall of full height at the seam", steps,
     sandstone},
    {"noise", "value noise of four octaves", noise, moss},
    {"smooth", "a sum of four sine waves, without any detail", smooth, sandstone},
    {"flat0", "height 0 everywhere: the deepest floor", flat_0, steel},
    {"flat1", "height 1 everywhere: the polygon itself", flat_1, steel},
    {"ramp", "a plane rising along u with a wall of full height at the seam", ramp, sandstone},
};

Result<const Maker*> find_maker(std::string_view name) {
    std::vector<std::string> names;
    for (const Maker& maker : table) {
        if (maker.name == name) return &maker;
        names.emplace_back(maker.name);
    }
    return input_error("unknown-map", unknown_name_sentence("procedural map", name, names));
}

std::array<float, 3> colour_at(const Colours& colours, float height) {
    std::size_t upper = 1;
    while (upper + 1 < colours.size() && colours[upper].height < height) ++upper;
    const ColourStop& below = colours[upper - 1];
    const ColourStop& above = colours[upper];
    const float t = std::clamp((height - below.height) / (above.height - below.height), 0.0f, 1.0f);
    std::array<float, 3> colour{};
    for (std::size_t c = 0; c < 3; ++c) {
        colour[c] = below.rgb[c] + (above.rgb[c] - below.rgb[c]) * t;
    }
    return colour;
}

}  // namespace

std::span<const Maker> makers() { return table; }

Result<Image> make_height_map(std::string_view name, int width, int height, std::uint32_t seed) {
    const Result<const Maker*> maker = find_maker(name);
    if (!maker) return maker.error();
    if (Status size = check_size(width, height); !size) return size.error();
    return (*maker)->make(width, height, seed);
}

Result<Image> make_colour_map(std::string_view name, const Image& heights) {
    const Result<const Maker*> maker = find_maker(name);
    if (!maker) return maker.error();
    if (Status sound = check_image(heights); !sound) return sound.error();
    Image colours = blank_image(heights.width, heights.height, 3, 8);
    for (int y = 0; y < heights.height; ++y) {
        for (int x = 0; x < heights.width; ++x) {
            const std::array<float, 3> colour = colour_at((*maker)->colours, heights.at(x, y));
            const auto grain = static_cast<float>(0.05 * (random_unit(0, x, y, 1) - 0.5));
            for (int c = 0; c < 3; ++c) {
                colours.at(x, y, c) =
                    std::clamp(colour[static_cast<std::size_t>(c)] + grain, 0.0f, 1.0f);
            }
        }
    }
    return colours;
}

}  // namespace intaglio::maps

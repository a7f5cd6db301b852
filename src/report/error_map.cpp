// Hit errors as colours, with the scale.
#include <algorithm>
#include <cmath>

#include "src/report/font.h"
#include "src/report/picture.h"

namespace intaglio::report {
namespace {

// Nine stops of the colour map "inferno" (Smith and van der Walt, 2015; public domain), equally
// spaced.
constexpr std::array<Rgb, 9> stops = {{{0.001f, 0.000f, 0.014f},
                                       {0.122f, 0.048f, 0.282f},
                                       {0.342f, 0.062f, 0.429f},
                                       {0.535f, 0.135f, 0.415f},
                                       {0.736f, 0.216f, 0.330f},
                                       {0.893f, 0.349f, 0.194f},
                                       {0.978f, 0.558f, 0.035f},
                                       {0.974f, 0.798f, 0.206f},
                                       {0.988f, 1.000f, 0.645f}}};
constexpr Rgb paper = {0.11f, 0.11f, 0.12f}, ink = {0.92f, 0.92f, 0.92f};

void set(maps::Image& image, int x, int y, const Rgb& colour) {
    for (int c = 0; c < 3; ++c) image.at(x, y, c) = colour[static_cast<std::size_t>(c)];
}

void fill(maps::Image& image, int x, int y, int width, int height, const Rgb& colour) {
    for (int row = y; row < y + height; ++row)
        for (int column = x; column < x + width; ++column) set(image, column, row, colour);
}

// Where an error stands on a scale: 0 at its least, 1 at its most.
float place_on(const ErrorScale& scale, float error) {
    if (!(error > scale.least)) return 0;
    return std::min(1.0f, std::log(error / scale.least) / std::log(scale.most / scale.least));
}

Rgb colour_at(float place) {
    const float at = place * static_cast<float>(stops.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    const float share = at - static_cast<float>(below);
    Rgb colour;
    for (std::size_t c = 0; c < 3; ++c)
        colour[c] = stops[below][c] * (1 - share) + stops[below + 1][c] * share;
    return colour;
}

// A swatch and its word.
void draw_key(maps::Image& image, int x, int y, const Rgb& colour, const char* word) {
    fill(image, x, y, 10, 8, colour);
    draw_text(image, x + 14, y, word, ink, 1);
}

// Fills rows of `width` by calling colour_of(index).
template <typename ColourOf>
maps::Image pixels_of(std::size_t count, int width, const ColourOf& colour_of) {
    const int height = width > 0 ? static_cast<int>(count) / width : 0;
    maps::Image image = maps::blank_image(width, height, 3, 8);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            set(image, x, y, colour_of(static_cast<std::size_t>(y * width + x)));
    return image;
}

void copy_to(maps::Image& image, const maps::Image& part, int left) {
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            for (int c = 0; c < 3; ++c) image.at(left + x, y, c) = part.at(x, y, c);
}

}  // namespace

Rgb error_colour(float texels) { return colour_at(place_on(texel_scale, texels)); }

maps::Image error_pixels(const std::vector<measure::HitError>& errors, int width) {
    return pixels_of(errors.size(), width, [&](std::size_t pixel) {
        const measure::HitError& error = errors[pixel];
        return error.invalid  ? invalid_colour
               : error.missed ? missed_colour
                              : error_colour(error.texels);
    });
}

maps::Image error_pixels(const std::vector<float>& values, int width, const ErrorScale& scale) {
    return pixels_of(values.size(), width, [&](std::size_t pixel) {
        return std::isfinite(values[pixel]) ? colour_at(place_on(scale, values[pixel]))
                                            : invalid_colour;
    });
}

maps::Image error_strip(int height, const ErrorScale& scale, bool hits) {
    maps::Image image =
        maps::blank_image(error_strip_width, std::max(height, least_map_height), 3, 8);
    fill(image, 0, 0, image.width, image.height, paper);
    constexpr int x = 8;
    draw_text(image, x, 4, scale.unit, ink, 1);
    const int top = 19, bottom = image.height - 34;  // middle of the scale's first and last row
    for (int y = top; y <= bottom; ++y)
        fill(image, x, y, 14, 1,
             colour_at(static_cast<float>(bottom - y) / static_cast<float>(bottom - top)));
    for (const auto& [error, word] : scale.ticks) {
        const float down = (1 - place_on(scale, error)) * static_cast<float>(bottom - top);
        const int y = top + static_cast<int>(std::lround(down));
        fill(image, x + 14, y, 4, 1, ink);
        draw_text(image, x + 22, y - 3, word, ink, 1);
    }
    if (hits) draw_key(image, x, image.height - 24, missed_colour, "missed");
    draw_key(image, x, image.height - 12, invalid_colour, "NaN");
    return image;
}

maps::Image error_map(const std::vector<measure::HitError>& errors, int width) {
    const maps::Image pixels = error_pixels(errors, width), strip = error_strip(pixels.height);
    maps::Image image = maps::blank_image(width + strip.width, strip.height, 3, 8);
    fill(image, 0, 0, image.width, image.height, paper);
    copy_to(image, pixels, 0);
    copy_to(image, strip, width);
    return image;
}

}  // namespace intaglio::report

// Pictures for people: renders as a screen shows them, error maps with their scale beside them, and
// sheets that put many in one PNG.  All are RGB of 8 bits; row 0 is the top.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "generator/base/result.h"
#include "src/maps/image.h"
#include "src/measure/hits.h"
#include "src/vulkan/program.h"

namespace intaglio::report {

using Rgb = std::array<float, 3>;  // display-ready, 0 to 1

// NaN and Inf, wherever a picture has them.
inline constexpr Rgb invalid_colour = {1.0f, 0.0f, 1.0f};
// First hits that were missed, in error maps.
inline constexpr Rgb missed_colour = {0.35f, 0.85f, 1.0f};

// Linear light to the curve of sRGB (IEC 61966-2-1: 12.92 x below 0.0031308, else 1.055 x^(1/2.4) -
// 0.055), after clamping to [0, 1]; alpha is dropped.  A pixel with NaN or Inf in any of its four
// channels is invalid_colour.
maps::Image to_image(const vulkan::Picture& picture);

// The scale of error maps in texels; errors below and above it have the colours of its ends.
inline constexpr float least_error = 0.01f, most_error = 32.0f;
// The colour of an error, logarithmic on the scale: from black through purple and orange to pale
// yellow, brightness growing all the way, so that it reads without colour vision and in print.
Rgb error_colour(float texels);

// What a colour scale spans, logarithmically, and where it has its numbers.
struct ErrorScale {
    const char* unit;
    float least, most;
    std::array<std::pair<float, const char*>, 5> ticks;
};
inline constexpr ErrorScale texel_scale = {
    "texels",
    least_error,
    most_error,
    {{{32, "32"}, {10, "10"}, {1, "1"}, {0.1f, "0.1"}, {0.01f, "0.01"}}}};
// Differences of display-ready colours in steps of 8 bits.
inline constexpr ErrorScale level_scale = {
    "of 255", 1, 255, {{{255, "255"}, {64, "64"}, {16, "16"}, {4, "4"}, {1, "1"}}}};

// One pixel per error, rows of `width`.  Missed hits are missed_colour, whatever their error, and
// invalid pixels invalid_colour.
maps::Image error_pixels(const std::vector<measure::HitError>& errors, int width);
// The same of plain values; those not finite are invalid_colour.
maps::Image error_pixels(const std::vector<float>& values, int width, const ErrorScale& scale);
// A strip with the scale and, where `hits`, the colour of missed ones; the colour of what is
// invalid. At least `least_map_height` rows.
inline constexpr int error_strip_width = 76, least_map_height = 128;
maps::Image error_strip(int height, const ErrorScale& scale = texel_scale, bool hits = true);

// error_pixels at the left top, the strip at their right; at least `least_map_height` rows.
maps::Image error_map(const std::vector<measure::HitError>& errors, int width);

struct Tile {
    maps::Image image;    // any channels; gray is repeated, alpha dropped
    std::string caption;  // printable ASCII; '\n' breaks lines, long ones wrap
};

// The tiles of each row side by side, as wide as the widest of their column, captions below; a
// title above unless it is empty.  Small tiles are enlarged by whole factors, each texel a square,
// to at least 128 pixels.  Codes: "empty-sheet" where there is no tile; "image-malformed";
// "image-size".
Result<maps::Image> contact_sheet(const std::vector<std::vector<Tile>>& rows,
                                  const std::string& title = {});

}  // namespace intaglio::report

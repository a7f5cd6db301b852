// Procedural height maps for tests, examples and anyone without art: a table of named patterns,
// each with colours to match.  All tile with repeat wrapping, take any size that check_size
// accepts, and are the same on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "generator/base/result.h"
#include "src/maps/image.h"

namespace intaglio::maps {

// The colour (display-ready RGB in [0, 1]) of a height; between two stops, the blend of both.
struct ColourStop {
    float height;
    std::array<float, 3> rgb;
};

struct Maker {
    std::string_view name;
    std::string_view sentence;  // what it shows and what it is good for; no full stop
    // One channel of 16 bits with heights in [0, 1], 1 the polygon and 0 the deepest.
    Image (*make)(int width, int height, std::uint32_t seed);
    std::array<ColourStop, 4> colours;  // heights ascending from 0 to 1
};

std::span<const Maker> makers();

// The map of the maker of this name.  Codes: "unknown-map", with the nearest name; "image-size".
Result<Image> make_height_map(std::string_view name, int width, int height, std::uint32_t seed);

// RGB of 8 bits for a map of that maker: its colours by height, with a little grain.  Codes:
// "unknown-map", "image-malformed".
Result<Image> make_colour_map(std::string_view name, const Image& heights);

}  // namespace intaglio::maps

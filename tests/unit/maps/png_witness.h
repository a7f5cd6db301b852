// PNGs written and read by libpng, which shares no code with the library under test (that one uses
// libspng).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace intaglio::maps::witness {

// A PNG as its specification sees it: whole samples, `channels()` of them per texel, row by row.
struct Png {
    int width = 1;
    int height = 1;
    int colour_type = 0;  // 0 gray, 2 RGB, 3 palette, 4 gray and alpha, 6 RGBA
    int depth = 8;        // bits per sample
    bool interlaced = false;
    std::vector<std::uint16_t> samples;
    std::vector<std::uint8_t> palette;        // three per entry
    std::vector<std::uint8_t> palette_alpha;  // may be shorter than the palette
    std::vector<std::uint16_t> transparent;  // the gray or the RGB that is transparent; empty: none

    int channels() const;
};

std::vector<unsigned char> written(const Png& png);

// Only the signature and the header of a PNG of 8-bit gray: enough to claim any size.
std::vector<unsigned char> header_only(int width, int height);

// The samples of a PNG of 8 or 16 bits without palette, as stored; also sets what the header says.
Png read(std::span<const unsigned char> bytes);

}  // namespace intaglio::maps::witness

// A font of 5 x 8 dots for captions inside pictures: printable ASCII, seven rows above the baseline
// and one below.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/maps/image.h"
#include "src/report/picture.h"

namespace intaglio::report {

// Dots from one character and one line to the next.
inline constexpr int glyph_advance = 6, line_advance = 10;

// Dots of a single line, without the gap behind its last character; times `scale` in pixels.
int text_width(std::string_view text);

// Draws a line with its top left dot at (x, y), a dot being scale x scale pixels; what lies outside
// the image is cut.  A character that the font lacks is a full box.
void draw_text(maps::Image& image, int x, int y, std::string_view text, Rgb colour, int scale);

// Breaks at '\n', and so that no line has more than `most` characters: at a blank where there is
// one, else behind one of ",_=:/", else wherever the line is full.
std::vector<std::string> wrapped(std::string_view text, std::size_t most);

}  // namespace intaglio::report

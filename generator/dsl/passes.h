// A surface in several passes, for profiles that cannot hold it in one: the first passes write
// where the view ray met the relief into a picture, the last one shades from there (Brawley and
// Tatarchuk 2004, whose ps_2_0 version shades in a second pass); and the search itself in passes
// over sections of the height profile (the same chapter, on accuracy).
//
// Every pass is a program with both stages, so whatever takes a program takes it.  All draw the
// same geometry.  Each but the last writes a picture that the next reads as `displaced_map` at the
// pixel's own place:
//     xy  the offset from the pixel's uv to the hit, times offset_to_colour.x plus .y: small
//     numbers,
//         which survive formats of few bits
//     z   the height there; where nothing was found yet, that of the relief where the ray ends so
//     far w   visibility of the light after the shadow; between sections 1 if the relief was met,
//     else 0
// What offset_to_colour, colour_to_offset and pixel_place must be set to, by format and by graphics
// interface: docs/split.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/dsl/surface.h"

namespace intaglio::dsl {

// Where a surface is cut.
struct Split {
    int sections = 1;     // passes of the search, each over a slab of the relief, from the top down
    bool shadow = false;  // a pass begins with the shadow
    bool shading = false;  // a pass begins with the shading, or with the output if it needs none
    bool operator==(const Split&) const = default;

    static constexpr int most_sections = 64;
};

// "shading", "sections=3", "sections=2,shadow,shading".  Error "split-syntax".
Result<Split> parse_split(std::string_view text);
std::string to_string(const Split& split);

int pass_count(const Split& split);
// What pass number 1 to pass_count does: "section 2 of 3 of the search, shadow".
std::string pass_work(const Split& split, int pass);

// One pass, numbered from 1.  Errors: "split-pass" for a number out of range, "split-search" for
// sections of a search that cannot say what it found, "split-lights" for the shadows of several
// lights before a pass that shades (the picture between holds one), and those of record_surface.
Result<ir::Program> record_pass(const Surface& surface, const RecordOptions& options,
                                const Split& split, int pass);
// All of them, in order.
Result<std::vector<ir::Program>> record_passes(const Surface& surface, const RecordOptions& options,
                                               const Split& split);

}  // namespace intaglio::dsl

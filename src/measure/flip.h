// How different two pictures look, and how far apart their numbers are: FLIP and PSNR.
//
// FLIP is that of Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem and Fairchild, "FLIP: A
// Difference Evaluator for Alternating Images", HPG 2020, for pictures on a screen (LDR-FLIP), with
// its published constants: colours filtered by what the eye resolves, compared by the HyAB distance
// after the Hunt effect, and raised where edges or points differ.  Its code is not used.
#pragma once

#include <cstdint>
#include <vector>

#include "src/vulkan/program.h"

namespace intaglio::measure {

// A screen 0.7 m away, 0.7 m wide with 3840 pixels: the paper's viewing conditions.
inline constexpr double flip_pixels_per_degree = 67.02064327658226;

// The difference at each pixel, 0 (none) to 1.  Both pictures hold linear light, which is clamped
// to [0, 1] as a screen does; NaN and Inf count as the brightest magenta.  Sizes must agree.
std::vector<float> flip_map(const vulkan::Picture& reference, const vulkan::Picture& test,
                            double pixels_per_degree = flip_pixels_per_degree);

struct PictureError {
    double flip_mean = 0, flip_p95 = 0, flip_max = 0;
    int flip_worst_x = 0, flip_worst_y = 0;  // where flip_max is
    // Of red, green and blue on the curve of sRGB, of a peak of 1, in dB.  Infinite where nothing
    // differs.
    double psnr = 0;
    std::int64_t invalid = 0;  // pixels of `test` with NaN or Inf in any channel
};
PictureError compare_pictures(const vulkan::Picture& reference, const vulkan::Picture& test);

}  // namespace intaglio::measure

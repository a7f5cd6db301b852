// How wrong a picture of displaced coordinates is, pixel by pixel against the exact first hit.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "src/measure/view.h"
#include "src/vulkan/program.h"

namespace intaglio::measure {

// What the exact reference says of every pixel of a quad drawn over [0, 1]^2 at one view and light.
struct ExactPicture {
    int width = 0, height = 0;
    std::vector<reference::Hit> hits;
    std::vector<bool> lit;
};

// Pixel (x, y) looks at uv ((x + 0.5) / width, (y + 0.5) / height).  `scale` as the shader got it,
// in float.  `threads` as in rows.h.
ExactPicture trace_exact(const reference::HeightField& field, Direction view, Direction light,
                         float scale, int width, int height, int threads = 0);

// The error of one pixel.
struct HitError {
    float texels =
        0;  // distance of the reported coordinate from the exact one; infinite for NaN or Inf
    float height = 0;      // |reported height - exact height|
    bool missed = false;   // the ray left the relief again before the reported point: it went
                           // through a feature
    bool invalid = false;  // NaN or Inf in any of the four channels
    bool shadow_wrong =
        false;  // visibility judged otherwise than exact; only where the hit is within a texel
};

// One entry per pixel.  `displaced`: coordinate in xy, height in z, visibility in w.
std::vector<HitError> compare_hits(const vulkan::Picture& displaced, const ExactPicture& exact,
                                   const reference::HeightField& field, Direction view, float scale,
                                   int threads = 0);

struct HitStatistics {
    std::int64_t pixels = 0;
    double median = 0, p95 = 0, p99 = 0, max = 0;  // texels, of the pixels that are not invalid
    double height_median = 0, height_max = 0;
    std::int64_t missed = 0;   // first hits
    std::int64_t far = 0;      // more than two texels from the exact hit, or invalid
    std::int64_t invalid = 0;  // NaN or Inf
    std::int64_t shadow_wrong = 0;
    int worst_x = 0, worst_y = 0;  // where max is
};

HitStatistics summarize(const std::vector<HitError>& errors, int width);

}  // namespace intaglio::measure

// Images in memory: what every map is, whatever file or maker it came from.  Texels are floats so
// that 8-bit, 16-bit and computed maps look alike; `bits` remembers the precision of the source,
// which is the precision of writing.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::maps {

// The largest width or height that is read, made or written: the largest 2D texture of today's
// Vulkan devices.
inline constexpr int largest_side = 16384;
// The most texels of one image (8192 x 8192): bounds the memory that a small hostile file can ask
// for.
inline constexpr std::size_t largest_area = std::size_t{1} << 26;

// Row-major with interleaved channels.  Row 0 is the top row of the PNG and lies at v = 0, so v
// grows downwards; the centre of texel (x, y) is at u = (x + 0.5) / width, v = (y + 0.5) / height.
// Values are in [0, 1]: a stored integer divided by 2^bits - 1, without any gamma.  Channels: 1
// gray, 2 gray and alpha, 3 RGB, 4 RGBA.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits = 8;  // 8 or 16
    std::vector<float> texels;

    float& at(int x, int y, int channel = 0) { return texels[index(x, y, channel)]; }
    float at(int x, int y, int channel = 0) const { return texels[index(x, y, channel)]; }
    std::size_t index(int x, int y, int channel) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(channels) +
               static_cast<std::size_t>(channel);
    }
    bool operator==(const Image&) const = default;
};

// An image of zeros.  The size must be one that check_size accepts.
Image blank_image(int width, int height, int channels, int bits);

// The integer that a file of `bits` stores for a value: the nearest step, clamped; 0 for NaN.
unsigned stored_step(float value, int bits);

// Refuses, with the limit in the sentence, sizes below 1 x 1 and above the two limits (code
// "image-size").
Status check_size(long long width, long long height);

// Refuses an image whose fields contradict each other: a size that check_size refuses, channels
// outside 1..4, bits other than 8 and 16, or a number of texels that does not fit (code
// "image-malformed").
Status check_image(const Image& image);

// Which channel of an image is its height.  Automatic: alpha where the image has one that is not
// constant, else the first channel (red, or gray).  Luminance: Rec. 709 weights on the stored
// values; of a gray image, its gray.
enum class HeightSource { Automatic, Red, Alpha, Luminance };

// The heights as an image of one channel, with the precision of the source.  Alpha asked of an
// image that has none is an error (code "no-alpha").
Result<Image> heights_of(const Image& image, HeightSource source);

// The RGB of `normals` (3 or 4 channels; a former alpha is replaced) with the first channel of
// `heights` as alpha, in the finer of the two precisions.  Sizes must agree (codes
// "image-mismatch", "image-malformed").
Result<Image> with_height_in_alpha(const Image& normals, const Image& heights);

// The levels of a full chain, the image itself first and 1 x 1 last, each half the one before
// rounded down but not below 1, as Vulkan sizes them.  Each texel is the mean of the area it
// covers: 2 texels across at even sizes, 3 with fractional weights at odd ones, so the average of
// the image is kept at every size.  Values are averaged as they are stored: normals shorten,
// colours are not linearised.
std::vector<Image> mip_chain(const Image& image);

}  // namespace intaglio::maps

// PNG files in and out, by libspng: it reports errors as values and refuses what is damaged.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "generator/base/result.h"
#include "src/maps/image.h"

namespace intaglio::maps {

// Reads any PNG: gray of 1, 2, 4, 8 and 16 bits, gray and alpha, RGB, RGBA, palettes (which become
// RGB), each interlaced or not.  A transparent colour or a palette with transparency becomes an
// alpha channel.  Gamma, colour profiles and background are ignored: a map holds numbers, not
// light.  Fewer than 8 bits are spread over [0, 1] and count as 8.
//
// Each refusal sets `file`.  Codes: those of read_file; "file-empty"; "not-a-png" (with what it
// seems to be); "png-truncated"; "png-corrupt" (a checksum or content is wrong); "image-size" (the
// limits of check_size).
Result<Image> read_png(const std::filesystem::path& path);

// Writes gray, gray and alpha, RGB or RGBA by the number of channels, in image.bits, whole or not
// at all (see write_file).  Values are rounded to the nearest step; those outside [0, 1] are
// clamped and NaN becomes 0.  The same image always gives the same bytes.  Codes:
// "image-malformed", those of write_file.
Status write_png(const std::filesystem::path& path, const Image& image);

// The same on bytes in memory; errors have no `file`.
Result<Image> decode_png(std::span<const unsigned char> bytes);
Result<std::vector<unsigned char>> encode_png(const Image& image);

}  // namespace intaglio::maps

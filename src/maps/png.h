// PNG files in and out, by libspng: it reports errors as values and refuses what is damaged.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/maps/image.h"

namespace intaglio::maps {

// A text chunk: a keyword of 1 to 79 printable ASCII characters, and UTF-8, neither empty.
struct PngText {
    std::string keyword, text;
    bool operator==(const PngText&) const = default;
};

// Reads any PNG: gray of 1, 2, 4, 8 and 16 bits, gray and alpha, RGB, RGBA, palettes (which become
// RGB), each interlaced or not.  A transparent colour or a palette with transparency becomes an
// alpha channel.  Gamma, colour profiles and background are ignored: a map holds numbers, not
// light.  Fewer than 8 bits are spread over [0, 1] and count as 8.
//
// Each refusal sets `file`.  Codes: those of read_file; "file-empty"; "not-a-png" (with what it
// seems to be); "png-truncated"; "png-corrupt" (a checksum or content is wrong); "image-size" (the
// limits of check_size).
//
// `text`: where text chunks go, in the order of the file.
Result<Image> read_png(const std::filesystem::path& path, std::vector<PngText>* text = nullptr);

// Writes gray, gray and alpha, RGB or RGBA by the number of channels, in image.bits, whole or not
// at all (see write_file).  Values are rounded to the nearest step; those outside [0, 1] are
// clamped and NaN becomes 0.  The same image and text always give the same bytes.  Codes:
// "image-malformed", those of write_file.
Status write_png(const std::filesystem::path& path, const Image& image,
                 std::span<const PngText> text = {});

// The same on bytes in memory; errors have no `file`.
Result<Image> decode_png(std::span<const unsigned char> bytes,
                         std::vector<PngText>* text = nullptr);
Result<std::vector<unsigned char>> encode_png(const Image& image,
                                              std::span<const PngText> text = {});

}  // namespace intaglio::maps

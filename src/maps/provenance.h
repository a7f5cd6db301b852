// Where a baked map comes from, as text chunks of its PNG: which heights, which kind, which
// settings.  Beside another height map a bake is wrong without looking wrong, a cone that is not
// empty for instance, so whoever loads one asks here first.
//
// The chunks (docs/maps.md): intaglio.format, .kind, .settings, .filter, .heights, .texels,
// .source.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/maps/image.h"

namespace intaglio::maps {

// Of what the files hold; another number is refused.
inline constexpr int bake_format = 1;

// Size, precision and the XXH3 hash (128 bits) of the values as a file stores them:
// "512x512 8 bits 0f3a...".  Images that a PNG cannot tell apart have the same one.
std::string fingerprint(const Image& image);

// By name, as `intaglio bake` has them: {"azimuths", "8"}.
using BakeSettings = std::map<std::string, std::string>;
// "azimuths=8 size=64x64", and back; what has no "=" is left out.
std::string to_string(const BakeSettings& settings);
BakeSettings parse_settings(const std::string& text);

struct Provenance {
    std::string kind;               // of `intaglio bake`: "cone"
    BakeSettings settings = {};     // those that shape the map
    std::string filter = "linear";  // how the map is read: linear, nearest
    std::string heights = {};       // fingerprint; empty: made of no heights
    std::string source = {};        // what the heights were called when baked; said, not compared
    std::string format = std::to_string(bake_format);
};

// The map with where it comes from as the bytes of a file; codes of encode_png.
Result<std::vector<unsigned char>> encode_baked(const Image& map, const Provenance& from);
// Writes the same; codes of write_png.
Status write_baked(const std::filesystem::path& path, const Image& map, const Provenance& from);

struct BakedFile {
    std::filesystem::path path;
    Image map;
    std::optional<Provenance> from;  // nothing where the file does not say
    bool changed = false;            // since it was baked: the texels are not those it speaks of
};
// Codes of read_png.
Result<BakedFile> read_baked(const std::filesystem::path& path);

// What a bake has to be.
struct WantedBake {
    std::string kind;
    BakeSettings settings = {};  // of those it may have more
    std::string heights = {};    // fingerprint; empty: of no heights
    // What `intaglio bake` is given to find these heights: "wall.png", "--maker bricks"; quoted for
    // a shell.
    std::string source = {};
};
// Refuses a bake that is not that, with both files and the command that makes the right one.
// Codes: "bake-unknown" (the file says nothing of itself), "bake-format", "bake-kind",
// "bake-heights", "bake-settings", "bake-changed".
Status check_pairing(const BakedFile& baked, const WantedBake& wanted);

}  // namespace intaglio::maps

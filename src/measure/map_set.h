// The maps that a surface wears: heights, normals with heights in alpha, and colours, all from one
// source.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "generator/base/result.h"
#include "src/maps/image.h"
#include "src/maps/provenance.h"
#include "src/reference/height_field.h"
#include "src/vulkan/texture.h"

namespace intaglio::measure {

struct MapSet {
    std::string name;
    maps::Image heights;        // one channel
    maps::Image normal_height;  // normal in rgb, height in alpha
    maps::Image colour;         // three channels, display-ready
    // What `intaglio bake` is given to find the same heights, quoted for a shell: "wall.png".
    std::string source = {};
    // Maps that were baked to files, by kind; checked to be of these heights.
    std::map<std::string, maps::BakedFile> baked = {};

    reference::HeightField height_field(reference::FilterWeights weights) const;
};

// What of a map set is given as files; the rest is made: normals are baked from the heights with
// the relief's scale, colours are a grey shade of the heights.
struct MapFiles {
    std::filesystem::path
        height;  // any PNG; heights in alpha where it has one that varies, else in red or gray
    std::optional<std::filesystem::path> normal;
    std::optional<std::filesystem::path> colour;
    // Files of `intaglio bake`, by kind ("cone"); what is not given is baked when it is read.
    std::map<std::string, std::filesystem::path> baked = {};
};

// `scale`: depth of the relief in texture units, for baked normals.  Errors: those of
// maps::read_png, "map-sizes" where the normal map has another size than the height map; those of
// add_baked_files, and of maps::check_pairing for a normal map that says where it comes from.
Result<MapSet> load_map_set(const MapFiles& files, double scale);
// A procedural map by the name of its maker (maps::makers()).
Result<MapSet> make_map_set(const std::string& maker, int width, int height, double scale,
                            std::uint32_t seed = 1);
// The arguments of `intaglio bake` that stand for it.
std::string maker_arguments(const std::string& maker, int width, int height, std::uint32_t seed);

// Reads baked files for a map set, by kind; one of kind "normal" becomes its normal map.  Errors:
// "unknown-bake" (no such kind), those of maps::read_png and maps::check_pairing.
Status add_baked_files(MapSet& set, const std::map<std::string, std::filesystem::path>& files,
                       double scale);

// Any heights as a map set: normals baked from them, colours a grey shade of them.
Result<MapSet> map_set_from_heights(std::string name, const maps::Image& heights, double scale);

enum class Filtering {
    Float,   // texels as float32, filtered exactly: what is left is the technique's own error
    Native,  // as the file's precision: RGBA8 is filtered with 8-bit weights on lavapipe
};
// "float" or "native".
std::string_view name_of(Filtering filtering);

// Four floats a texel; missing colour channels repeat the first, missing alpha is 1.
std::vector<float> rgba_of(const maps::Image& image);
// The format that holds the image's precision, or float32.
vulkan::Texture::Format format_of(const maps::Image& image, Filtering filtering);

// Textures as the device takes them, with all mip levels.
vulkan::Texture height_texture(const MapSet& set, Filtering filtering);
vulkan::Texture normal_texture(const MapSet& set, Filtering filtering);
vulkan::Texture colour_texture(const MapSet& set);

}  // namespace intaglio::measure

// Loading, making and uploading map sets.
#include "src/measure/map_set.h"

#include <cmath>

#include <fmt/format.h>

#include "src/maps/bake.h"
#include "src/maps/files.h"
#include "src/maps/makers.h"
#include "src/maps/png.h"
#include "src/measure/baked_maps.h"

namespace intaglio::measure {
namespace {

maps::Image grey_of(const maps::Image& heights) {
    maps::Image grey = maps::blank_image(heights.width, heights.height, 3, 8);
    for (int y = 0; y < heights.height; ++y)
        for (int x = 0; x < heights.width; ++x)
            for (int c = 0; c < 3; ++c) grey.at(x, y, c) = 0.45f + 0.4f * heights.at(x, y);
    return grey;
}

Result<maps::Image> normals_with_heights(const maps::Image& heights, double scale) {
    const Result<maps::Image> normals =
        maps::bake_normal(heights, scale, maps::NormalKernel::Central, maps::Wrap::Repeat);
    if (!normals) return normals;
    return maps::with_height_in_alpha(*normals, heights);
}

vulkan::Texture texture_of(const maps::Image& image, vulkan::Texture::Format format) {
    vulkan::Texture texture;
    texture.width = image.width;
    texture.height = image.height;
    for (const maps::Image& level : maps::mip_chain(image))
        texture.levels.push_back(rgba_of(level));
    texture.format = format;
    return texture;
}

// What a baked normal map has to be; its heights are looked at by whoever needs them.
maps::WantedBake wanted_normals(const MapSet& set, double scale) {
    return {"normal",
            {{"scale", fmt::format("{}", scale)}},
            maps::fingerprint(set.heights),
            set.source};
}

// A normal map that a person drew says nothing of itself, and one that says it must be right.  What
// was changed since is the person's business.
Result<maps::Image> read_normals(const std::filesystem::path& path, const MapSet& set,
                                 double scale) {
    Result<maps::BakedFile> file = maps::read_baked(path);
    if (!file) return file.error();
    if (!file->from) return std::move(file->map);
    file->changed = false;
    if (Status pairing = maps::check_pairing(*file, wanted_normals(set, scale)); !pairing)
        return pairing.error();
    return std::move(file->map);
}

}  // namespace

std::string_view name_of(Filtering filtering) {
    return filtering == Filtering::Float ? "float" : "native";
}

std::vector<float> rgba_of(const maps::Image& image) {
    std::vector<float> texels;
    texels.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                   4);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 4; ++c) {
                const bool alpha = c == 3;
                if (alpha)
                    texels.push_back(image.channels == 4   ? image.at(x, y, 3)
                                     : image.channels == 2 ? image.at(x, y, 1)
                                                           : 1.0f);
                else
                    texels.push_back(image.at(x, y, image.channels >= 3 ? c : 0));
            }
    return texels;
}

vulkan::Texture::Format format_of(const maps::Image& image, Filtering filtering) {
    if (filtering == Filtering::Float) return vulkan::Texture::Format::Rgba32Float;
    return image.bits == 8 ? vulkan::Texture::Format::Rgba8Unorm
                           : vulkan::Texture::Format::Rgba16Unorm;
}

reference::HeightField MapSet::height_field(reference::FilterWeights weights) const {
    reference::HeightField field;
    field.width = heights.width;
    field.height = heights.height;
    field.heights.assign(heights.texels.begin(), heights.texels.end());
    field.weights = weights;
    return field;
}

Result<MapSet> load_map_set(const MapFiles& files, double scale) {
    MapSet set;
    set.name = files.height.stem().string();
    // Maps of one surface share a folder and are called after their role: the folder is the better
    // name.
    if (set.name == "height" || set.name == "normal_height")
        set.name = files.height.parent_path().filename().string();
    const Result<maps::Image> source = maps::read_png(files.height);
    if (!source) return source.error();
    Result<maps::Image> heights = maps::heights_of(*source, maps::HeightSource::Automatic);
    if (!heights) return heights.error();
    set.heights = std::move(*heights);
    set.source = maps::shell_quoted(files.height.string());

    const bool packed = source->channels == 4 && !files.normal;
    Result<maps::Image> normals =
        packed ? Result<maps::Image>(*source) : normals_with_heights(set.heights, scale);
    if (files.normal) {
        const Result<maps::Image> given = read_normals(*files.normal, set, scale);
        if (!given) return given.error();
        if (given->width != set.heights.width || given->height != set.heights.height)
            return input_error(
                "map-sizes",
                fmt::format("the normal map is {} x {}, the height map {} x {}", given->width,
                            given->height, set.heights.width, set.heights.height),
                files.normal->string());
        if (given->channels < 3)
            return input_error("map-channels", "a normal map needs three colour channels",
                               files.normal->string());
        normals = maps::with_height_in_alpha(*given, set.heights);
    }
    if (!normals) return normals.error();
    set.normal_height = std::move(*normals);

    set.colour = grey_of(set.heights);
    if (files.colour) {
        Result<maps::Image> colour = maps::read_png(*files.colour);
        if (!colour) return colour.error();
        set.colour = std::move(*colour);
    }
    if (Status status = add_baked_files(set, files.baked, scale); !status) return status.error();
    return set;
}

Result<MapSet> make_map_set(const std::string& maker, int width, int height, double scale,
                            std::uint32_t seed) {
    MapSet set;
    set.name = maker;
    Result<maps::Image> heights = maps::make_height_map(maker, width, height, seed);
    if (!heights) return heights.error();
    set.heights = std::move(*heights);
    set.source = maker_arguments(maker, width, height, seed);
    Result<maps::Image> normals = normals_with_heights(set.heights, scale);
    if (!normals) return normals.error();
    set.normal_height = std::move(*normals);
    Result<maps::Image> colour = maps::make_colour_map(maker, set.heights);
    if (!colour) return colour.error();
    set.colour = std::move(*colour);
    return set;
}

Result<MapSet> map_set_from_heights(std::string name, const maps::Image& heights, double scale) {
    Result<maps::Image> normals = normals_with_heights(heights, scale);
    if (!normals) return normals.error();
    return MapSet{std::move(name), heights, std::move(*normals), grey_of(heights)};
}

std::string maker_arguments(const std::string& maker, int width, int height, std::uint32_t seed) {
    const std::string rest = seed == 1 ? "" : fmt::format(" --seed {}", seed);
    return fmt::format("--maker {} --map-size {}x{}{}", maker, width, height, rest);
}

Status add_baked_files(MapSet& set, const std::map<std::string, std::filesystem::path>& files,
                       double scale) {
    const std::string fingerprint = files.empty() ? "" : maps::fingerprint(set.heights);
    for (const auto& [kind, path] : files) {
        Result<maps::WantedBake> wanted = kind == "normal"
                                              ? wanted_normals(set, scale)
                                              : wanted_bake(kind, fingerprint, set.source);
        if (!wanted) return wanted.error();
        Result<maps::BakedFile> file = maps::read_baked(path);
        if (!file) return file.error();
        if (Status pairing = maps::check_pairing(*file, *wanted); !pairing) return pairing;
        if (kind != "normal") {
            set.baked[kind] = std::move(*file);
            continue;
        }
        Result<maps::Image> normals = maps::with_height_in_alpha(file->map, set.heights);
        if (!normals) return normals.error();
        set.normal_height = std::move(*normals);
    }
    return Done{};
}

vulkan::Texture height_texture(const MapSet& set, Filtering filtering) {
    return texture_of(set.heights, format_of(set.heights, filtering));
}

vulkan::Texture normal_texture(const MapSet& set, Filtering filtering) {
    return texture_of(set.normal_height, format_of(set.normal_height, filtering));
}

// Albedo is shaded in linear light, so the map is linearised here, once, rather than per pixel.
vulkan::Texture colour_texture(const MapSet& set) {
    maps::Image linear = set.colour;
    for (float& value : linear.texels) value = std::pow(value, 2.2f);
    return texture_of(linear, vulkan::Texture::Format::Rgba8Unorm);
}

}  // namespace intaglio::measure

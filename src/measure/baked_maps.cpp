// One row for each map.  Its filter is not here: the sampler that reads it declares that.
#include "src/measure/baked_maps.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "src/maps/bake_cone.h"
#include "src/maps/bake_distance.h"
#include "src/maps/bake_horizon.h"
#include "src/maps/bake_max_mip.h"
#include "src/maps/bake_phong.h"
#include "src/maps/bake_summit.h"
#include "src/maps/bake_view_dependent.h"

namespace intaglio::measure {
namespace {

vulkan::Texture with_levels(const std::vector<maps::Image>& levels) {
    vulkan::Texture texture;
    texture.width = levels.front().width;
    texture.height = levels.front().height;
    for (const maps::Image& level : levels) texture.levels.push_back(rgba_of(level));
    return texture;
}

vulkan::Texture volume_texture(const maps::Image& slices, int depth) {
    vulkan::Texture texture = with_levels({slices});
    texture.height = slices.height / depth;
    texture.depth = depth;
    return texture;
}

// Rows and columns of an image from its upper left corner, or from the row `from`.
maps::Image part_of(const maps::Image& image, int from, int width, int height) {
    maps::Image part = maps::blank_image(width, height, image.channels, image.bits);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < image.channels; ++c) part.at(x, y, c) = image.at(x, from + y, c);
    return part;
}

Diagnostic wrong_size(const maps::Image& stored) {
    return input_error("bake-size", fmt::format("a baked map of {} x {} texels does not fit the "
                                                "height map it names",
                                                stored.width, stored.height));
}

Result<vulkan::Texture> unpack_plain(const maps::Image& stored, const maps::Image&) {
    return with_levels({stored});
}

// Images below each other, each as large as the heights.
template <int Which, int Of>
Result<vulkan::Texture> unpack_one_of(const maps::Image& stored, const maps::Image& heights) {
    if (stored.width != heights.width || stored.height != heights.height * Of)
        return wrong_size(stored);
    return with_levels({part_of(stored, heights.height * Which, heights.width, heights.height)});
}

template <int Depth>
Result<vulkan::Texture> unpack_volume(const maps::Image& stored, const maps::Image&) {
    if (stored.height % Depth != 0) return wrong_size(stored);
    return volume_texture(stored, Depth);
}

Result<vulkan::Texture> unpack_levels(const maps::Image& stored, const maps::Image& heights) {
    std::vector<maps::Image> levels;
    int width = heights.width, height = heights.height, from = 0;
    while (true) {
        if (stored.width < width || stored.height < from + height) return wrong_size(stored);
        levels.push_back(part_of(stored, from, width, height));
        if (width == 1 && height == 1) return with_levels(levels);
        from += height;
        width = std::max(1, width / 2);
        height = std::max(1, height / 2);
    }
}

// The same from a bake in memory.
Result<vulkan::Texture> plain(const Result<maps::Image>& image) {
    if (!image) return image.error();
    return with_levels({*image});
}

Result<vulkan::Texture> volume(const Result<maps::Volume>& volume) {
    if (!volume) return volume.error();
    return volume_texture(volume->slices, volume->depth);
}

using Heights = const maps::Image&;
using Settings = const maps::BakeSettings&;

constexpr int distance_slices = 32, views = 9, view_slices = (views - 1) * (views - 1);

struct Row {
    std::string_view name;        // of the sampler
    std::string kind;             // of `intaglio bake`
    maps::BakeSettings settings;  // that every technique expects
    Result<vulkan::Texture> (*bake)(Heights heights, Settings settings);
    Result<vulkan::Texture> (*unpack)(const maps::Image& stored, Heights heights);
    bool of_heights = true;
};

template <std::size_t Which>
Result<vulkan::Texture> bake_one_horizon(Heights heights, Settings) {
    const Result<std::vector<maps::Image>> images = maps::bake_horizon(heights, 8);
    if (!images) return images.error();
    return with_levels({(*images)[Which]});
}

template <Result<std::vector<maps::Image>> (*Bake)(const maps::Image&)>
Result<vulkan::Texture> bake_levels(Heights heights, Settings) {
    const Result<std::vector<maps::Image>> levels = Bake(heights);
    if (!levels) return levels.error();
    return with_levels(*levels);
}

const std::array rows = std::to_array<Row>({
    {"height_texels", "", {}, [](Heights h, Settings) { return plain(h); }, unpack_plain},
    {"cone_map",
     "cone",
     {},
     [](Heights h, Settings) { return plain(maps::bake_cone(h, maps::ConeKind::Empty)); },
     unpack_one_of<0, 1>},
    {"relaxed_cone_map",
     "relaxed-cone",
     {},
     [](Heights h, Settings) { return plain(maps::bake_cone(h, maps::ConeKind::Relaxed)); },
     unpack_one_of<0, 1>},
    {"max_mip_map", "max-mip", {}, bake_levels<maps::bake_max_mip>, unpack_levels},
    {"summit_map", "summit", {}, bake_levels<maps::bake_summit>, unpack_levels},
    {"patch_map",
     "patch",
     {},
     [](Heights h, Settings) { return plain(maps::bake_patch(h)); },
     unpack_one_of<0, 1>},
    {"horizon_map", "horizon", {{"azimuths", "8"}}, bake_one_horizon<0>, unpack_one_of<0, 2>},
    {"horizon_diagonal_map",
     "horizon",
     {{"azimuths", "8"}},
     bake_one_horizon<1>,
     unpack_one_of<1, 2>},
    {"distance_map",
     "distance",
     {{"slices", fmt::format("{}", distance_slices)}},
     [](Heights h, Settings) { return volume(maps::bake_distance(h)); },
     unpack_volume<distance_slices>},
    {"view_dependent_map",
     "view-dependent",
     {{"views", fmt::format("{}", views)}},
     [](Heights h, Settings) { return volume(maps::bake_view_dependent(h)); },
     unpack_volume<view_slices>},
    {"phong_map",
     "phong",
     {},
     [](Heights, Settings settings) {
         const auto shininess = settings.find("shininess");
         return plain(maps::bake_phong(
             shininess == settings.end() ? 32 : std::strtod(shininess->second.c_str(), nullptr)));
     },
     unpack_plain,
     false},
});

const Row* row_named(std::string_view name) {
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const Row& other) { return other.name == name; });
    return row == rows.end() ? nullptr : &*row;
}

}  // namespace

Result<maps::WantedBake> wanted_bake(const std::string& kind, const std::string& heights,
                                     const std::string& source) {
    std::vector<std::string> kinds = {"normal"};
    for (const Row& row : rows) {
        if (row.kind.empty()) continue;
        if (row.kind == kind)
            return maps::WantedBake{kind, row.settings, row.of_heights ? heights : "",
                                    row.of_heights ? source : ""};
        if (row.kind != kinds.back()) kinds.push_back(row.kind);
    }
    return input_error("unknown-bake", unknown_name_sentence("kind of baked map", kind, kinds));
}

std::optional<BakeBehind> bake_behind(std::string_view sampler) {
    const Row* row = row_named(sampler);
    if (row == nullptr) return std::nullopt;
    return BakeBehind{row->kind, row->settings};
}

BakedMaps::BakedMaps(const MapSet& set, Filtering filtering)
    : heights_(set.heights), files_(set.baked), source_(set.source), filtering_(filtering) {}

std::vector<std::string_view> BakedMaps::names() {
    std::vector<std::string_view> all;
    for (const Row& row : rows) all.push_back(row.name);
    return all;
}

Result<vulkan::Texture> BakedMaps::made(std::string_view name, const maps::BakeSettings& settings) {
    const Row& row = *row_named(name);
    const auto file = files_.find(row.kind);
    if (file == files_.end()) return row.bake(heights_, settings);
    // Kind and heights were checked when the file was read; what the sampler wants is known now.
    Result<maps::WantedBake> wanted = wanted_bake(row.kind, file->second.from->heights, source_);
    if (!wanted) return wanted.error();
    wanted->settings.insert(settings.begin(), settings.end());
    if (Status pairing = maps::check_pairing(file->second, *wanted); !pairing)
        return pairing.error();
    read_.insert(row.kind);
    Result<vulkan::Texture> texture = row.unpack(file->second.map, heights_);
    if (texture) return texture;
    Diagnostic error = texture.error();
    error.file = file->second.path.string();
    return error;
}

Result<const vulkan::Texture*> BakedMaps::texture(const std::string& name,
                                                  const std::string& settings) {
    if (row_named(name) == nullptr) return nullptr;
    const std::lock_guard lock(mutex_);
    std::unique_ptr<vulkan::Texture>& kept = baked_[name + ' ' + settings];
    if (!kept) {
        Result<vulkan::Texture> texture = made(name, maps::parse_settings(settings));
        if (!texture) return texture.error();
        kept = std::make_unique<vulkan::Texture>(std::move(*texture));
        kept->format = format_of(heights_, filtering_);
    }
    return kept.get();
}

Status BakedMaps::check_all_read() {
    const std::lock_guard lock(mutex_);
    for (const auto& [kind, file] : files_)
        if (!read_.contains(kind))
            return input_error(
                "bake-unread",
                fmt::format("nothing of what is drawn reads a {} map: leave it out", kind),
                file.path.string());
    return Done{};
}

}  // namespace intaglio::measure

// One row for each map.  Its filter is not here: the sampler that reads it declares that.
#include "src/measure/baked_maps.h"

#include <algorithm>
#include <array>

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

Result<vulkan::Texture> one_level(const Result<maps::Image>& image) {
    if (!image) return image.error();
    return with_levels({*image});
}

Result<vulkan::Texture> all_levels(const Result<std::vector<maps::Image>>& levels) {
    if (!levels) return levels.error();
    return with_levels(*levels);
}

Result<vulkan::Texture> volume_texture(const Result<maps::Volume>& volume) {
    if (!volume) return volume.error();
    vulkan::Texture texture = with_levels({volume->slices});
    texture.height = volume->height();
    texture.depth = volume->depth;
    return texture;
}

Result<vulkan::Texture> horizon_texture(const maps::Image& heights, std::size_t which) {
    const Result<std::vector<maps::Image>> images = maps::bake_horizon(heights, 8);
    if (!images) return images.error();
    return with_levels({(*images)[which]});
}

struct Row {
    std::string_view name;
    Result<vulkan::Texture> (*bake)(const maps::Image& heights);
};

const std::array rows = std::to_array<Row>({
    {"height_texels", [](const maps::Image& h) { return one_level(h); }},
    {"cone_map",
     [](const maps::Image& h) { return one_level(maps::bake_cone(h, maps::ConeKind::Empty)); }},
    {"relaxed_cone_map",
     [](const maps::Image& h) { return one_level(maps::bake_cone(h, maps::ConeKind::Relaxed)); }},
    {"max_mip_map", [](const maps::Image& h) { return all_levels(maps::bake_max_mip(h)); }},
    {"summit_map", [](const maps::Image& h) { return all_levels(maps::bake_summit(h)); }},
    {"patch_map", [](const maps::Image& h) { return one_level(maps::bake_patch(h)); }},
    {"horizon_map", [](const maps::Image& h) { return horizon_texture(h, 0); }},
    {"horizon_diagonal_map", [](const maps::Image& h) { return horizon_texture(h, 1); }},
    {"distance_map", [](const maps::Image& h) { return volume_texture(maps::bake_distance(h)); }},
    {"view_dependent_map",
     [](const maps::Image& h) { return volume_texture(maps::bake_view_dependent(h)); }},
    {"phong_map", [](const maps::Image&) { return one_level(maps::bake_phong()); }},
});

}  // namespace

BakedMaps::BakedMaps(maps::Image heights, Filtering filtering)
    : heights_(std::move(heights)), filtering_(filtering) {}

std::vector<std::string_view> BakedMaps::names() {
    std::vector<std::string_view> all;
    for (const Row& row : rows) all.push_back(row.name);
    return all;
}

Result<const vulkan::Texture*> BakedMaps::texture(const std::string& name) {
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const Row& other) { return other.name == name; });
    if (row == rows.end()) return nullptr;
    const std::lock_guard lock(mutex_);
    std::unique_ptr<vulkan::Texture>& kept = baked_[name];
    if (!kept) {
        Result<vulkan::Texture> made = row->bake(heights_);
        if (!made) return made.error();
        kept = std::make_unique<vulkan::Texture>(std::move(*made));
        kept->format = format_of(heights_, filtering_);
    }
    return kept.get();
}

}  // namespace intaglio::measure

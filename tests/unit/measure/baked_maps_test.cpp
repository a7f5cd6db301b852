// Baked maps by the names of their samplers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/measure/baked_maps.h"

namespace intaglio::measure {
namespace {

TEST(BakedMaps, GiveATextureForEachNameAndBakeItOnce) {
    for (const auto& [width, height] : {std::pair{16, 8}, {1, 1}, {1, 12}, {5, 7}}) {
        const Result<MapSet> set = make_map_set("bricks", width, height, 0.1);
        ASSERT_TRUE(set.ok());
        BakedMaps maps(set->heights, Filtering::Float);
        EXPECT_THAT(BakedMaps::names(), testing::Contains("cone_map"));
        for (const std::string_view name : BakedMaps::names()) {
            const auto texture = maps.texture(std::string(name));
            ASSERT_TRUE(texture.ok()) << to_string(texture.error());
            ASSERT_NE(*texture, nullptr) << name;
            const Status sound = vulkan::validate(**texture, std::string(name));
            EXPECT_TRUE(sound.ok()) << to_string(sound.error());
            EXPECT_EQ(*maps.texture(std::string(name)), *texture) << name << " was baked again";
            const bool volume = name == "distance_map" || name == "view_dependent_map";
            EXPECT_EQ((*texture)->depth > 0, volume) << name;
        }
        EXPECT_EQ(*maps.texture("colour_map"), nullptr);
    }
}

TEST(BakedMaps, KeepThePrecisionOfTheHeights) {
    const Result<MapSet> set = make_map_set("smooth", 8, 8, 0.1);
    ASSERT_TRUE(set.ok());
    BakedMaps exact(set->heights, Filtering::Float), stored(set->heights, Filtering::Native);
    EXPECT_EQ((*exact.texture("cone_map"))->format, vulkan::Texture::Format::Rgba32Float);
    EXPECT_EQ((*stored.texture("cone_map"))->format, vulkan::Texture::Format::Rgba16Unorm);
    EXPECT_EQ((*exact.texture("cone_map"))->levels[0][4 * 19], set->heights.at(3, 2));
    EXPECT_EQ((*exact.texture("max_mip_map"))->levels.size(), 4u);
}

}  // namespace
}  // namespace intaglio::measure

// Baked maps by the names of their samplers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>

#include <fmt/format.h>

#include "src/maps/bake.h"
#include "src/maps/bake_cone.h"
#include "src/maps/bake_distance.h"
#include "src/maps/bake_horizon.h"
#include "src/maps/bake_max_mip.h"
#include "src/maps/bake_phong.h"
#include "src/maps/bake_view_dependent.h"
#include "src/maps/makers.h"
#include "src/maps/png.h"
#include "src/measure/baked_maps.h"

namespace intaglio::measure {
namespace {

TEST(BakedMaps, GiveATextureForEachNameAndBakeItOnce) {
    for (const auto& [width, height] : {std::pair{16, 8}, {1, 1}, {1, 12}, {5, 7}}) {
        const Result<MapSet> set = make_map_set("bricks", width, height, 0.1);
        ASSERT_TRUE(set.ok());
        BakedMaps maps(*set, Filtering::Float);
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
    BakedMaps exact(*set, Filtering::Float), stored(*set, Filtering::Native);
    EXPECT_EQ((*exact.texture("cone_map"))->format, vulkan::Texture::Format::Rgba32Float);
    EXPECT_EQ((*stored.texture("cone_map"))->format, vulkan::Texture::Format::Rgba16Unorm);
    EXPECT_EQ((*exact.texture("cone_map"))->levels[0][4 * 19], set->heights.at(3, 2));
    EXPECT_EQ((*exact.texture("max_mip_map"))->levels.size(), 4u);
}

// A height map, and bakes of it, in files.
class BakedFiles : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("intaglio baked ") + std::to_string(getpid()) +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder_);
        heights_ = maps::make_height_map("cobbles", 24, 16, 1).value();
        ASSERT_TRUE(maps::write_png(path("wall.png"), heights_).ok());
        heights_ = maps::read_png(path("wall.png")).value();
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path path(const std::string& name) const { return folder_ / name; }
    void write(const std::string& kind, const maps::Image& map, maps::BakeSettings settings) {
        const std::string of = kind == "phong" ? "" : maps::fingerprint(heights_);
        ASSERT_TRUE(
            maps::write_baked(path(kind), map, {kind, settings, "linear", of, "wall.png"}).ok());
    }
    // As `intaglio bake` writes them.
    void write_all() {
        const maps::Image& h = heights_;
        write("cone", *maps::bake_cone(h, maps::ConeKind::Empty), {});
        write("relaxed-cone", *maps::bake_cone(h, maps::ConeKind::Relaxed), {});
        write("max-mip", *maps::stacked(*maps::bake_max_mip(h)), {});
        write("horizon", *maps::stacked(*maps::bake_horizon(h, 8)), {{"azimuths", "8"}});
        write("distance", maps::bake_distance(h)->slices, {{"slices", "32"}, {"size", "256x256"}});
        write("view-dependent", maps::bake_view_dependent(h)->slices, {{"views", "9"}});
        write("phong", *maps::bake_phong(50), {{"shininess", "50"}});
    }
    Result<MapSet> load(const std::vector<std::string>& kinds) const {
        MapFiles files{path("wall.png"), {}, {}, {}};
        for (const std::string& kind : kinds) files.baked[kind] = path(kind);
        return load_map_set(files, 0.08);
    }

    std::filesystem::path folder_;
    maps::Image heights_;
};

const std::vector<std::string> all_kinds = {"cone",     "relaxed-cone",   "max-mip", "horizon",
                                            "distance", "view-dependent", "phong"};

TEST_F(BakedFiles, GiveTheVeryTexturesThatAreBakedInMemory) {
    write_all();
    const Result<MapSet> plain = load({}), given = load(all_kinds);
    ASSERT_TRUE(plain.ok());
    ASSERT_TRUE(given.ok()) << to_string(given.error());
    for (const Filtering filtering : {Filtering::Float, Filtering::Native}) {
        BakedMaps in_memory(*plain, filtering), from_files(*given, filtering);
        EXPECT_EQ(from_files.check_all_read().error().code, "bake-unread");
        for (const std::string_view view : BakedMaps::names()) {
            const std::string name(view), settings = name == "phong_map" ? "shininess=50" : "";
            const auto a = in_memory.texture(name, settings),
                       b = from_files.texture(name, settings);
            ASSERT_TRUE(a.ok() && b.ok()) << name << (b.ok() ? "" : to_string(b.error()));
            EXPECT_EQ((*a)->levels, (*b)->levels) << name;
            EXPECT_EQ((*a)->width, (*b)->width) << name;
            EXPECT_EQ((*a)->height, (*b)->height) << name;
            EXPECT_EQ((*a)->depth, (*b)->depth) << name;
            EXPECT_EQ((*a)->format, (*b)->format) << name;
        }
        EXPECT_TRUE(from_files.check_all_read().ok());
        EXPECT_EQ(from_files.texture("phong_map", "shininess=32").error().code, "bake-settings");
    }
    // In memory the settings reach the bake.
    BakedMaps baked(*plain, Filtering::Float);
    EXPECT_NE((*baked.texture("phong_map", "shininess=8"))->levels,
              (*baked.texture("phong_map", "shininess=64"))->levels);
}

TEST_F(BakedFiles, AreRefusedBesideWhatTheyWereNotBakedFor) {
    write_all();
    const auto code = [&](const std::vector<std::string>& kinds) {
        const Result<MapSet> set = load(kinds);
        return set ? "fine" : set.error().code;
    };
    EXPECT_EQ(code(all_kinds), "fine");
    std::filesystem::rename(path("relaxed-cone"), path("cone"));
    EXPECT_EQ(code({"cone"}), "bake-kind");
    EXPECT_EQ(code({"cones"}), "unknown-bake");
    EXPECT_EQ(code({"relaxed-cone"}), "file-missing");
    write("horizon", *maps::stacked(*maps::bake_horizon(heights_, 16)), {{"azimuths", "16"}});
    EXPECT_EQ(code({"horizon"}), "bake-settings");
    // Another height map; what was made of no heights stays.
    heights_.at(5, 5) = heights_.at(5, 5) < 0.5f ? 1.0f : 0.0f;
    ASSERT_TRUE(maps::write_png(path("wall.png"), heights_).ok());
    EXPECT_EQ(code({"max-mip"}), "bake-heights");
    EXPECT_EQ(code({"phong"}), "fine");
}

TEST_F(BakedFiles, NormalsAreBoundToTheirScaleToo) {
    const auto write_normals = [&](double scale) {
        const maps::Image normals =
            *maps::bake_normal(heights_, scale, maps::NormalKernel::Central, maps::Wrap::Repeat);
        write("normal", normals, {{"scale", fmt::format("{}", scale)}});
        return normals;
    };
    write_normals(0.05);
    EXPECT_EQ(load({"normal"}).error().code, "bake-settings");
    // A normal map given by hand is looked at as well where it says what it is of.
    const MapFiles by_hand{path("wall.png"), path("normal"), {}, {}};
    EXPECT_EQ(load_map_set(by_hand, 0.08).error().code, "bake-settings");
    EXPECT_TRUE(load_map_set(by_hand, 0.05).ok());
    const maps::Image normals = write_normals(0.08);
    const Result<MapSet> given = load({"normal"}), plain = load({});
    ASSERT_TRUE(given.ok()) << to_string(given.error());
    // Half a step of the file's precision; the other half is what floats round.
    const float step = heights_.bits == 8 ? 1.0f / 255 : 1.0f / 65535;
    for (std::size_t i = 0; i < plain->normal_height.texels.size(); ++i)
        ASSERT_NEAR(plain->normal_height.texels[i], given->normal_height.texels[i], 0.51f * step);
    ASSERT_TRUE(maps::write_png(path("normal"), normals).ok());
    EXPECT_EQ(load({"normal"}).error().code, "bake-unknown");
    EXPECT_TRUE(load_map_set(by_hand, 0.3).ok()) << "whoever drew it knows what it is of";
}

}  // namespace
}  // namespace intaglio::measure

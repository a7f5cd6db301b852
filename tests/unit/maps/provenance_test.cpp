// What a bake says of itself, and every way not to belong to a height map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "src/maps/bake_cone.h"
#include "src/maps/bake_distance.h"
#include "src/maps/bake_horizon.h"
#include "src/maps/bake_view_dependent.h"
#include "src/maps/makers.h"
#include "src/maps/png.h"
#include "src/maps/provenance.h"
#include "tests/unit/maps/png_witness.h"

namespace intaglio::maps {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

Image map_of(const char* maker, int side = 16) { return *make_height_map(maker, side, side, 1); }

class ProvenanceTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  fmt::format("intaglio provenance {} {}", getpid(),
                              testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path path(const char* name) const { return folder_ / name; }
    BakedFile written(const Image& map, const Provenance& from) const {
        EXPECT_TRUE(write_baked(path("cone.png"), map, from).ok());
        const Result<BakedFile> read = read_baked(path("cone.png"));
        EXPECT_TRUE(read.ok());
        return *read;
    }

    fs::path folder_;
};

const Image bricks = map_of("bricks"), noise = map_of("noise");
const Provenance cone_of_bricks{
    "cone", {{"size", "16x16"}, {"slices", "8"}}, "nearest", fingerprint(bricks), "Mäuer 1.png"};
const WantedBake wanted{"cone", {{"slices", "8"}}, fingerprint(bricks), "bricks.png"};

TEST_F(ProvenanceTest, IsReadBackAsItWasWritten) {
    const Image map = *bake_cone(bricks, ConeKind::Empty);
    const BakedFile read = written(map, cone_of_bricks);
    ASSERT_TRUE(read.from.has_value());
    EXPECT_EQ(read.from->kind, "cone");
    EXPECT_EQ(read.from->settings, cone_of_bricks.settings);
    EXPECT_EQ(read.from->filter, "nearest");
    EXPECT_EQ(read.from->heights, fingerprint(bricks));
    EXPECT_EQ(read.from->source, "Mäuer 1.png");
    EXPECT_FALSE(read.changed);
    EXPECT_TRUE(check_pairing(read, wanted).ok());
    // The text changes no texel, for libpng either.
    const std::vector<PngText> text = {{"intaglio.kind", "cone"}, {"intaglio.source", "Mäuer"}};
    EXPECT_EQ(read.map, *decode_png(*encode_png(map)));
    EXPECT_EQ(witness::read(*encode_png(map, text)).samples,
              witness::read(*encode_png(map)).samples);
}

TEST_F(ProvenanceTest, RefusesEveryOtherPairingWithTheCommandThatMakesTheRightOne) {
    const Image map = *bake_cone(bricks, ConeKind::Empty);
    const auto refused = [&](const BakedFile& file, const WantedBake& wish, const char* code,
                             const char* says) {
        const Status pairing = check_pairing(file, wish);
        ASSERT_FALSE(pairing.ok()) << code;
        EXPECT_EQ(pairing.error().code, code);
        EXPECT_EQ(pairing.error().file, path("cone.png").string());
        EXPECT_THAT(pairing.error().message,
                    AllOf(HasSubstr(says), HasSubstr("bricks.png"),
                          HasSubstr("run: intaglio bake cone bricks.png --slices 8 -o '" +
                                    path("cone.png").string() + "'")));
    };
    const auto with = [&](auto change) {
        Provenance from = cone_of_bricks;
        change(from);
        return written(map, from);
    };
    refused(with([](Provenance& from) { from.heights = fingerprint(noise); }), wanted,
            "bake-heights", "was baked from Mäuer 1.png");
    refused(with([](Provenance& from) { from.kind = "relaxed-cone"; }), wanted, "bake-kind",
            "this is a relaxed-cone map, baked from Mäuer 1.png,");
    refused(with([](Provenance& from) { from.settings["slices"] = "9"; }), wanted, "bake-settings",
            "slices = 9 where 8 is needed of bricks.png");
    refused(with([](Provenance& from) { from.settings.clear(); }), wanted, "bake-settings",
            "slices = none");
    refused(with([](Provenance& from) { from.format = "2"; }), wanted, "bake-format", "format 2");

    EXPECT_TRUE(write_png(path("cone.png"), map).ok());
    refused(*read_baked(path("cone.png")), wanted, "bake-unknown", "does not say");

    // The text of one bake around the texels of another.
    std::vector<PngText> text;
    EXPECT_TRUE(write_baked(path("cone.png"), map, cone_of_bricks).ok());
    EXPECT_TRUE(read_png(path("cone.png"), &text).ok());
    Image other = map;
    other.at(3, 2, 1) += 2.0f / 255;
    EXPECT_TRUE(write_png(path("cone.png"), other, text).ok());
    refused(*read_baked(path("cone.png")), wanted, "bake-changed", "was changed");
}

TEST_F(ProvenanceTest, FingerprintsTellMapsApartAsFilesDo) {
    EXPECT_EQ(fingerprint(bricks), fingerprint(*decode_png(*encode_png(bricks))));
    EXPECT_NE(fingerprint(bricks), fingerprint(noise));
    Image changed = bricks;
    float& value = changed.at(7, 7);
    value += value < 0.5f ? 1.0f / 255 : -1.0f / 255;
    EXPECT_NE(fingerprint(bricks), fingerprint(changed));
    // The same values in another shape, and with another precision.
    const Image tall = blank_image(2, 8, 1, 8), wide = blank_image(8, 2, 1, 8);
    EXPECT_NE(fingerprint(tall), fingerprint(wide));
    EXPECT_NE(fingerprint(tall), fingerprint(blank_image(2, 8, 1, 16)));
    EXPECT_NE(fingerprint(blank_image(2, 4, 2, 8)), fingerprint(blank_image(2, 4, 4, 8)));
}

TEST(Bakes, AreTheSameWithAnyNumberOfThreadsAndSayHowFarTheyAre) {
    const Image heights = map_of("cobbles", 24);
    std::vector<int> steps;
    int all = 0;
    const auto told = [&](int done, int of) {
        steps.push_back(done);
        all = of;
    };
    const auto same = [&](const auto& bake) {
        steps.clear();
        const auto one = bake(Work{1, told});
        EXPECT_EQ(one, bake(Work{3, {}}));
        ASSERT_EQ(static_cast<int>(steps.size()), all);
        EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end()));
        EXPECT_EQ(steps.back(), all);
    };
    same([&](const Work& work) { return *bake_cone(heights, ConeKind::Empty, work); });
    same([&](const Work& work) { return *bake_horizon(heights, 8, work); });
    same([&](const Work& work) { return bake_distance(heights, 12, 24, 7, work)->slices; });
    same([&](const Work& work) { return bake_view_dependent(heights, 8, 8, 5, work)->slices; });
}

}  // namespace
}  // namespace intaglio::maps

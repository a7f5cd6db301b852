// The live part as text: whole programs, whole maps, nothing that a page would have to fetch.
#include "src/report/live.h"

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/measure/baked_maps.h"
#include "src/report/base64.h"
#include "src/report/live_data.h"
#include "templates/all_techniques.h"

namespace intaglio::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

LiveOptions options_with(int map_side, int side) {
    LiveOptions options;
    options.maps.push_back(
        {*measure::make_map_set("text", map_side, map_side, 0.1), {"--maker", "a b"}});
    options.side = side;
    options.shadows = {"none"};
    return options;
}

const dsl::Catalogue& catalogue() {
    static const dsl::Catalogue all = templates::all_techniques();
    return all;
}

TEST(Base64, PadsAsTheStandardsExamplesDo) {
    const auto of = [](const std::string& text) {
        return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
    };
    EXPECT_EQ(of(""), "");
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("fo"), "Zm8=");
    EXPECT_EQ(of("foo"), "Zm9v");
    EXPECT_EQ(of("foob\xff"), "Zm9vYv8=");
}

TEST(Live, ProgramsAreTheEmittedTexts) {
    const LiveOptions options = options_with(16, 16);
    const Result<std::string> data = live_data(catalogue(), options);
    ASSERT_TRUE(data) << to_string(data.error());
    const nlohmann::json json = nlohmann::json::parse(*data);
    const Result<std::vector<LiveVariant>> variants = live_variants(catalogue(), options);
    ASSERT_TRUE(variants);
    EXPECT_EQ(json["programs"].size(), variants->size());
    for (const LiveVariant& wanted : *variants) {
        const auto& program =
            json["programs"][wanted.search + "|" + wanted.steps + "|" + wanted.shadow];
        std::string text;
        for (const std::size_t line : program["pixel"])
            text += std::string(json["lines"][line]) + "\n";
        const Result<Variant> variant = make_variant(catalogue(), wanted.request);
        ASSERT_TRUE(variant);
        EXPECT_EQ(text, variant->pixel.text) << wanted.search;
    }
    EXPECT_EQ(json["maps"][0]["run"], " --maker 'a b'");
}

TEST(Live, StepsAreAroundTheDefaultAndTheReferenceHasMany) {
    const Result<std::vector<LiveVariant>> variants =
        live_variants(catalogue(), options_with(16, 16));
    ASSERT_TRUE(variants);
    std::map<std::string, std::vector<std::string>> steps;
    for (const LiveVariant& variant : *variants) steps[variant.search].push_back(variant.steps);
    EXPECT_THAT(steps["parallax_occlusion"], ::testing::ElementsAre("4", "8", "16", "32"));
    EXPECT_THAT(steps["none"], ::testing::ElementsAre(""));
    EXPECT_THAT(steps["view_dependent"], ::testing::ElementsAre(""));
    EXPECT_EQ(variants->back().search, "reference");
    EXPECT_THAT(variants->back().request.knobs,
                ::testing::ElementsAre(::testing::Pair("max_cells", "1920")));
}

TEST(Live, LargeMapsAreHalvedAndRoundedToBytes) {
    const LiveOptions options = options_with(64, 16);
    const measure::MapSet map = live_map(options.maps[0].set, options.side);
    EXPECT_EQ(map.heights.width, 16);
    EXPECT_EQ(map.normal_height.width, 16);
    double mean = 0, whole = 0;
    for (const float height : map.heights.texels) {
        EXPECT_FLOAT_EQ(height * 255, std::round(height * 255));
        mean += static_cast<double>(height) / 256;
    }
    for (const float height : options.maps[0].set.heights.texels)
        whole += static_cast<double>(height) / 4096;
    EXPECT_NEAR(mean, whole, 1.0 / 255) << "levels keep the mean";
}

TEST(Live, WhatIsLeftOutCannotBeChosen) {
    LiveOptions options = options_with(16, 16);
    options.left_out = {"view_dependent_map"};
    const Result<std::vector<LiveVariant>> variants = live_variants(catalogue(), options);
    ASSERT_TRUE(variants);
    for (const LiveVariant& variant : *variants) EXPECT_NE(variant.search, "view_dependent");
}

// Whatever the map, and read as every baked map is: it says what it was made of.
TEST(Live, TheVolumeOfViewsIsSmall) {
    const LiveOptions options = options_with(64, 64);
    const measure::MapSet map = live_map(options.maps[0].set, options.side);
    measure::BakedMaps baked(map, measure::Filtering::Native);
    const Result<const vulkan::Texture*> volume = baked.texture("view_dependent_map");
    ASSERT_TRUE(volume) << to_string(volume.error());
    EXPECT_EQ((*volume)->width, live_view_side);
    EXPECT_EQ((*volume)->height, live_view_side);
    EXPECT_LT((*volume)->levels[0].size() * 4 / 3, 400000u) << "bytes in base64";
}

TEST(Live, ThePageFetchesNothing) {
    const Result<std::string> section = live_section(catalogue(), options_with(16, 16));
    ASSERT_TRUE(section) << to_string(section.error());
    const std::string page = live_page(*section);
    EXPECT_THAT(page, HasSubstr(*section));
    for (const char* foreign : {"http:", "https:", "src=", "@import", "url("})
        EXPECT_THAT(page, Not(HasSubstr(foreign)));
}

TEST(Live, RefusesNoMapsAndUnknownShadows) {
    LiveOptions options = options_with(16, 16);
    options.shadows = {"marsh"};
    const Result<std::string> unknown = live_section(catalogue(), options);
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().code, "unknown-technique");
    options.maps.clear();
    const Result<std::string> none = live_section(catalogue(), options);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, "live-maps");
}

}  // namespace
}  // namespace intaglio::report

// Sheets of pictures: sizes, places, captions.
#include <gmock/gmock.h>

#include "src/report/font.h"
#include "src/report/picture.h"

namespace intaglio::report {
namespace {

using ::testing::ElementsAre;

maps::Image plain(int width, int height, float grey, int channels = 3) {
    maps::Image image = maps::blank_image(width, height, channels, 8);
    for (float& texel : image.texels) texel = grey;
    return image;
}

int count_of(const maps::Image& image, float grey) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            count +=
                image.at(x, y, 0) == grey && image.at(x, y, 1) == grey && image.at(x, y, 2) == grey;
    return count;
}

TEST(ContactSheet, IsAsLargeAsItsTilesAndMargins) {
    const auto sheet = contact_sheet({{{plain(256, 200, 0.3f), ""}, {plain(300, 256, 0.4f), ""}},
                                      {{plain(260, 256, 0.6f), ""}}});
    ASSERT_TRUE(sheet.ok());
    EXPECT_EQ(sheet->width, 16 + 260 + 16 + 300 + 16);
    EXPECT_EQ(sheet->height, 16 + 256 + 16 + 256 + 16);
}

TEST(ContactSheet, ShowsEveryTexelOfEveryTile) {
    const auto sheet =
        contact_sheet({{{plain(256, 200, 0.25f), "caption"}, {plain(300, 256, 0.5f), ""}},
                       {{plain(130, 140, 0.75f), "x"}}},
                      "A title");
    ASSERT_TRUE(sheet.ok());
    EXPECT_EQ(count_of(*sheet, 0.25f), 256 * 200);
    EXPECT_EQ(count_of(*sheet, 0.5f), 300 * 256);
    EXPECT_EQ(count_of(*sheet, 0.75f), 130 * 140);
}

TEST(ContactSheet, EnlargesSmallTilesByWholeFactors) {
    const auto sheet = contact_sheet({{{plain(32, 16, 0.25f), ""}}});
    ASSERT_TRUE(sheet.ok());
    EXPECT_EQ(count_of(*sheet, 0.25f), 128 * 64);
}

TEST(ContactSheet, TakesAnyChannels) {
    for (int channels = 1; channels <= 4; ++channels) {
        const auto sheet = contact_sheet({{{plain(128, 128, 0.25f, channels), ""}}});
        ASSERT_TRUE(sheet.ok());
        EXPECT_EQ(count_of(*sheet, 0.25f), 128 * 128) << channels;
    }
}

TEST(ContactSheet, GrowsByTheLinesOfItsLongestCaption) {
    const Tile bare{plain(128, 128, 0.25f), ""}, one{plain(128, 128, 0.25f), "one"},
        three{plain(128, 128, 0.25f), "one\ntwo\nthree"};
    const int none = contact_sheet({{bare}})->height;
    EXPECT_EQ(contact_sheet({{one}})->height, none + 8 + 10);
    EXPECT_EQ(contact_sheet({{one, three}})->height, none + 8 + 3 * 10);
    // 128 pixels hold 21 letters of 6; 192 hold 16 of 12.
    EXPECT_EQ(contact_sheet({{{plain(128, 128, 0.25f), std::string(21, 'x')}}})->height,
              none + 8 + 10);
    EXPECT_EQ(contact_sheet({{{plain(128, 128, 0.25f), std::string(22, 'x')}}})->height,
              none + 8 + 20);
    EXPECT_EQ(contact_sheet({{{plain(192, 128, 0.25f), std::string(16, 'x')}}})->height,
              none + 8 + 20);
    EXPECT_EQ(contact_sheet({{{plain(192, 128, 0.25f), std::string(17, 'x')}}})->height,
              none + 8 + 40);
}

TEST(ContactSheet, RefusesNothingAndTooMuch) {
    EXPECT_EQ(contact_sheet({}).error().code, "empty-sheet");
    EXPECT_EQ(contact_sheet({{}, {}}).error().code, "empty-sheet");
    EXPECT_EQ(contact_sheet({{{maps::Image{}, "nothing"}}}).error().code, "image-malformed");
    const std::vector<std::vector<Tile>> rows(70, {{plain(256, 256, 0), ""}});
    EXPECT_EQ(contact_sheet(rows).error().code, "image-size");
}

TEST(Font, EveryCharacterIsDrawnAndDifferent) {
    std::vector<maps::Image> drawn;
    for (char letter = '!'; letter <= '~'; ++letter) {
        maps::Image image = plain(5, 8, 0);
        draw_text(image, 0, 0, std::string(1, letter), {1, 1, 1}, 1);
        EXPECT_GT(count_of(image, 1), 0) << letter;
        for (const maps::Image& other : drawn) EXPECT_NE(image, other) << letter;
        drawn.push_back(image);
    }
}

TEST(Font, WhatLiesOutsideIsCut) {
    maps::Image image = plain(20, 20, 0);
    draw_text(image, -7, -3, "WWW", {1, 1, 1}, 2);
    draw_text(image, 15, 15, "WWW", {1, 1, 1}, 2);
    draw_text(image, 100, 100, "W", {1, 1, 1}, 3);
    EXPECT_GT(count_of(image, 1), 0);
}

TEST(Font, ScalesByWholeDots) {
    maps::Image small = plain(text_width("Ag"), 8, 0), large = plain(3 * text_width("Ag"), 24, 0);
    draw_text(small, 0, 0, "Ag", {1, 1, 1}, 1);
    draw_text(large, 0, 0, "Ag", {1, 1, 1}, 3);
    for (int y = 0; y < large.height; ++y)
        for (int x = 0; x < large.width; ++x) EXPECT_EQ(large.at(x, y), small.at(x / 3, y / 3));
}

TEST(Font, WrapsAtBlanksAndCutsWhatHasNone) {
    EXPECT_THAT(wrapped("one two three", 7), ElementsAre("one two", "three"));
    EXPECT_THAT(wrapped("parallax_occlusion taps=8", 12),
                ElementsAre("parallax_", "occlusion", "taps=8"));
    EXPECT_THAT(wrapped("abcdefgh", 3), ElementsAre("abc", "def", "gh"));
    EXPECT_THAT(wrapped("a\n\nb", 3), ElementsAre("a", "", "b"));
    EXPECT_THAT(wrapped("", 3), ElementsAre(""));
    for (const std::string& line : wrapped("steep_parallax,shadow=march max_steps=32 p95 0.4", 12))
        EXPECT_LE(line.size(), 12u);
}

}  // namespace
}  // namespace intaglio::report

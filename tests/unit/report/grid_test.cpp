// Sheets with titles at the edges, reliefs as the eye sees them, and blocks of pages.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "src/report/cost_table.h"
#include "src/report/font.h"
#include "src/report/grid_sheet.h"
#include "src/report/page_block.h"
#include "src/report/wall.h"

namespace intaglio::report {
namespace {

maps::Image filled(int width, int height, const Rgb& colour) {
    maps::Image image = maps::blank_image(width, height, 3, 8);
    for (std::size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = colour[i % 3];
    return image;
}

Rgb at(const maps::Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

int pixels_of(const maps::Image& image, const Rgb& colour) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) count += at(image, x, y) == colour ? 1 : 0;
    return count;
}

constexpr Rgb red = {1, 0, 0}, green = {0, 1, 0}, blue = {0, 0, 1};

TEST(GridSheet, ShowsEveryPictureWholeAndEveryTitle) {
    Grid grid;
    grid.column_titles = {"one", "two"};
    grid.rows = {{"first", {{filled(40, 30, red), ""}, {filled(20, 50, green), "caption"}}},
                 {"second row", {{filled(33, 10, blue), ""}}}};
    const Result<maps::Image> bare = grid_sheet(grid);
    ASSERT_TRUE(bare.ok());
    EXPECT_EQ(pixels_of(*bare, red), 40 * 30);
    EXPECT_EQ(pixels_of(*bare, green), 20 * 50);
    EXPECT_EQ(pixels_of(*bare, blue), 33 * 10);
    // Letters are drawn somewhere on the paper: without them the sheet differs.
    const Rgb ink = {0.10f, 0.10f, 0.11f};
    const int letters = pixels_of(*bare, ink);
    for (std::string* text :
         {&grid.column_titles[1], &grid.rows[1].title, &grid.rows[0].cells[1].caption}) {
        Grid less = grid;
        const std::string kept = *text;
        text->assign(kept.size(), ' ');
        const Result<maps::Image> sheet = grid_sheet(grid);
        ASSERT_TRUE(sheet.ok());
        EXPECT_EQ(sheet->width, bare->width);
        EXPECT_LT(pixels_of(*sheet, ink), letters) << kept;
        *text = kept;
    }
}

TEST(GridSheet, ATitleLongerThanTheSheetBreaks) {
    Grid grid;
    grid.rows = {{"", {{filled(60, 20, red), ""}}}};
    const Result<maps::Image> narrow = grid_sheet(grid);
    grid.title = "a title of many words that no line of this sheet can hold";
    const Result<maps::Image> titled = grid_sheet(grid);
    ASSERT_TRUE(narrow.ok() && titled.ok());
    EXPECT_EQ(titled->width, narrow->width);
    EXPECT_GT(titled->height, narrow->height + 4 * line_advance);
}

TEST(GridSheet, WithoutPicturesIsRefused) { EXPECT_EQ(grid_sheet({}).error().code, "empty-sheet"); }

// A map of four quarters, seen from straight above with v downwards: the map itself.
TEST(Wall, FromAboveAtAzimuth90IsTheMap) {
    maps::Image map = filled(8, 8, {0, 0, 0});
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            map.at(x, y, 0) = static_cast<float>(x) / 7;
            map.at(x, y, 1) = static_cast<float>(y) / 7;
        }
    const WallView wall{{90, 90}, 8, 8, 1, {}};
    EXPECT_EQ(wall_picture(map, wall, Footprint::Nearest), map);
    const maps::Image mean = wall_picture(map, wall, Footprint::Mean);
    for (std::size_t i = 0; i < map.texels.size(); ++i)
        EXPECT_NEAR(mean.texels[i], map.texels[i], 1e-6f);
}

// At 30 degrees twice as much of the map fits along the eye's direction: a stripe is half as high.
TEST(Wall, ForeshortensByTheSineOfTheElevation) {
    maps::Image map = filled(64, 64, {0, 0, 0});
    for (int y = 24; y < 40; ++y)
        for (int x = 0; x < 64; ++x) map.at(x, y, 0) = 1;
    for (double elevation : {90.0, 30.0}) {
        const maps::Image seen =
            wall_picture(map, {{elevation, 90}, 64, 64, 0.5, {}}, Footprint::Nearest);
        int rows = 0;
        for (int y = 0; y < 64; ++y) rows += seen.at(32, y, 0) > 0.5f ? 1 : 0;
        // 16 texels of 64 are 32 pixels where 64 pixels show half the map; at 30 degrees the map
        // repeats every 64 pixels.
        EXPECT_EQ(rows, elevation == 90 ? 32 : 16) << elevation;
    }
}

TEST(Wall, ShowsWhatIsOutsideOnlyWhereAsked) {
    const maps::Image map = filled(16, 16, red);
    const WallView repeated{{45, 20}, 32, 32, 2, {}};
    EXPECT_EQ(pixels_of(wall_picture(map, repeated, Footprint::Nearest), red), 32 * 32);
    WallView once = repeated;
    once.outside = blue;
    const maps::Image seen = wall_picture(map, once, Footprint::Nearest);
    // A unit square of which a pixel covers 1/16 by 1/16 / sin(45) units.
    EXPECT_NEAR(pixels_of(seen, red), 256 * std::sin(std::acos(-1.0) / 4), 12);
    EXPECT_EQ(pixels_of(seen, red) + pixels_of(seen, blue), 32 * 32);
}

TEST(ErrorPixels, SayWhatIsNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const maps::Image image = error_pixels(std::vector<float>{0, nan, 255}, 3, level_scale);
    EXPECT_EQ(at(image, 1, 0), invalid_colour);
    EXPECT_LT(at(image, 0, 0)[0], at(image, 2, 0)[0]);
}

const std::string page =
    "# relief\n\ntext\n<!-- intaglio pages search=relief -->\nold\n"
    "<!-- end of what intaglio pages wrote -->\nmore\n"
    "<!-- intaglio pages fur -->\n<!-- end of what intaglio pages wrote -->\n";

TEST(Page, BlocksAreReplacedAndNothingElse) {
    EXPECT_EQ(blocks_of(page), (std::vector<std::string>{"search=relief", "fur"}));
    EXPECT_EQ(block_text(page, "search=relief"), "old\n");
    const Result<std::string> written = with_block(page, "fur", "hair\n", "page.md");
    ASSERT_TRUE(written.ok());
    EXPECT_EQ(block_text(*written, "fur"), "hair\n");
    EXPECT_EQ(block_text(*written, "search=relief"), "old\n");
    const Result<std::string> back = with_block(*written, "fur", "", "page.md");
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(*back, page);
}

TEST(Page, ABlockThatIsMissingOrOpenIsRefused) {
    EXPECT_EQ(with_block(page, "search=cone", "x\n", "page.md").error().code, "page-block");
    std::string open = page;
    open.erase(open.find("<!-- end"),
               std::string("<!-- end of what intaglio pages wrote -->").size());
    const Result<std::string> refused = with_block(open, "search=relief", "x\n", "page.md");
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().file, "page.md");
    EXPECT_EQ(block_text(open, "search=relief"), "");
}

TEST(CostTable, PutsWhatIsTheSameIntoOneLine) {
    const std::string text = cost_table({{"alone",
                                          {{"ps_2_0", "", "too long"},
                                           {"ps_2_a", "41 + 9", ""},
                                           {"ps_2_b", "41 + 9", ""},
                                           {"ps_3_0", "34 + 2", ""}}},
                                         {"shaded",
                                          {{"ps_2_0", "", "too long"},
                                           {"ps_2_a", "72 + 11", ""},
                                           {"ps_2_b", "72 + 11", ""},
                                           {"ps_3_0", "", "no"}}}});
    EXPECT_EQ(text,
              "| target | alone | shaded |\n|---|---|---|\n"
              "| ps_2_0 | *refused* (1) | *refused* (1) |\n"
              "| ps_2_a, ps_2_b | 41 + 9 | 72 + 11 |\n"
              "| ps_3_0 | 34 + 2 | *refused* (2) |\n"
              "\n1. too long\n2. no\n");
}

}  // namespace
}  // namespace intaglio::report

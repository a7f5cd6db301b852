// Many pictures in one.
#include <algorithm>

#include "src/report/font.h"
#include "src/report/picture.h"

namespace intaglio::report {
namespace {

constexpr Rgb paper = {0.97f, 0.97f, 0.97f}, ink = {0.10f, 0.10f, 0.11f};
constexpr int margin = 16;        // around the sheet and between tiles
constexpr int caption_gap = 8;    // between a tile and its caption
constexpr int least_side = 128;   // tiles below are enlarged
constexpr int wide_column = 192;  // narrower columns have letters of half the size

// RGB, enlarged by a whole factor.
maps::Image prepared(const maps::Image& image) {
    const int longer = std::max(image.width, image.height);
    const int factor = (least_side + longer - 1) / longer;
    maps::Image result = maps::blank_image(image.width * factor, image.height * factor, 3, 8);
    for (int y = 0; y < result.height; ++y)
        for (int x = 0; x < result.width; ++x)
            for (int c = 0; c < 3; ++c)
                result.at(x, y, c) = image.at(x / factor, y / factor, image.channels >= 3 ? c : 0);
    return result;
}

void paste(maps::Image& sheet, const maps::Image& tile, int x, int y) {
    for (int row = 0; row < tile.height; ++row)
        std::copy_n(tile.texels.begin() + static_cast<std::ptrdiff_t>(tile.index(0, row, 0)),
                    tile.width * 3,
                    sheet.texels.begin() + static_cast<std::ptrdiff_t>(sheet.index(x, y + row, 0)));
}

std::size_t characters_in(int pixels, int scale) {
    return static_cast<std::size_t>(std::max(1, (pixels / scale + 1) / glyph_advance));
}

void draw_lines(maps::Image& sheet, int x, int y, const std::vector<std::string>& lines,
                int scale) {
    for (const std::string& line : lines) {
        draw_text(sheet, x, y, line, ink, scale);
        y += line_advance * scale;
    }
}

// Tiles ready to paste and where they go.
struct Layout {
    std::vector<std::vector<maps::Image>> tiles;
    std::vector<std::vector<std::vector<std::string>>> captions;
    std::vector<long long> widths;   // of columns
    std::vector<long long> heights;  // of the tiles of each row
    std::vector<long long> lines;    // of the captions of each row
    int scale = 1;                   // of captions, one more for the title
};

Layout lay_out(const std::vector<std::vector<Tile>>& rows) {
    Layout layout;
    for (const std::vector<Tile>& row : rows) {
        layout.tiles.emplace_back();
        layout.heights.push_back(0);
        for (std::size_t column = 0; column < row.size(); ++column) {
            maps::Image tile = prepared(row[column].image);
            if (column == layout.widths.size()) layout.widths.push_back(0);
            layout.widths[column] = std::max<long long>(layout.widths[column], tile.width);
            layout.heights.back() = std::max<long long>(layout.heights.back(), tile.height);
            layout.tiles.back().push_back(std::move(tile));
        }
    }
    const auto narrowest = std::min_element(layout.widths.begin(), layout.widths.end());
    layout.scale = *narrowest < wide_column ? 1 : 2;
    for (const std::vector<Tile>& row : rows) {
        layout.captions.emplace_back();
        layout.lines.push_back(0);
        for (std::size_t column = 0; column < row.size(); ++column) {
            const std::size_t most =
                characters_in(static_cast<int>(layout.widths[column]), layout.scale);
            layout.captions.back().push_back(row[column].caption.empty()
                                                 ? std::vector<std::string>{}
                                                 : wrapped(row[column].caption, most));
            layout.lines.back() = std::max(
                layout.lines.back(), static_cast<long long>(layout.captions.back().back().size()));
        }
    }
    return layout;
}

Status check_tiles(const std::vector<std::vector<Tile>>& rows) {
    bool any = false;
    for (const std::vector<Tile>& row : rows) {
        for (const Tile& tile : row) {
            any = true;
            if (Status status = maps::check_image(tile.image); !status) return status;
        }
    }
    if (!any) return internal_error("empty-sheet", "a contact sheet needs at least one picture");
    return Done{};
}

}  // namespace

Result<maps::Image> contact_sheet(const std::vector<std::vector<Tile>>& rows,
                                  const std::string& title) {
    if (Status status = check_tiles(rows); !status) return status.error();
    const Layout layout = lay_out(rows);
    const int title_scale = layout.scale + 1;
    long long width = margin;
    for (long long column : layout.widths) width += column + margin;
    const std::vector<std::string> title_lines =
        title.empty()
            ? std::vector<std::string>{}
            : wrapped(title, characters_in(static_cast<int>(width - 2 * margin), title_scale));
    const long long title_height =
        title.empty()
            ? 0
            : static_cast<long long>(title_lines.size()) * line_advance * title_scale + margin / 2;
    const auto caption_height = [&](std::size_t row) {
        return layout.lines[row] == 0
                   ? 0
                   : caption_gap + layout.lines[row] * line_advance * layout.scale;
    };
    long long height = margin + title_height;
    for (std::size_t row = 0; row < rows.size(); ++row)
        height += layout.heights[row] + caption_height(row) + margin;
    if (Status status = maps::check_size(width, height); !status) return status.error();

    maps::Image sheet = maps::blank_image(static_cast<int>(width), static_cast<int>(height), 3, 8);
    for (std::size_t i = 0; i < sheet.texels.size(); ++i) sheet.texels[i] = paper[i % 3];
    draw_lines(sheet, margin, margin, title_lines, title_scale);
    int y = margin + static_cast<int>(title_height);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        int x = margin;
        for (std::size_t column = 0; column < rows[row].size(); ++column) {
            paste(sheet, layout.tiles[row][column], x, y);
            draw_lines(sheet, x, y + static_cast<int>(layout.heights[row]) + caption_gap,
                       layout.captions[row][column], layout.scale);
            x += static_cast<int>(layout.widths[column]) + margin;
        }
        y += static_cast<int>(layout.heights[row] + caption_height(row)) + margin;
    }
    return sheet;
}

}  // namespace intaglio::report

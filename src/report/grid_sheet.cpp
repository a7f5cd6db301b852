// Places first, then letters and pictures.
#include "src/report/grid_sheet.h"

#include <algorithm>

#include "src/report/font.h"

namespace intaglio::report {
namespace {

constexpr Rgb paper = {0.97f, 0.97f, 0.97f}, ink = {0.10f, 0.10f, 0.11f};
constexpr int margin = 8, gap = 4;

// Left edges of columns and top edges of rows, in pixels; the last entry is where the next would
// be.
struct Layout {
    std::vector<std::string> title_lines;
    std::vector<int> x, y;
    int first_row = 0;  // top of the column titles
    int scale_x = 0, width = 0, height = 0;
};

int line_height(int letters) { return line_advance * letters; }

bool has_captions(const GridRow& row) {
    return std::any_of(row.cells.begin(), row.cells.end(),
                       [](const Tile& tile) { return !tile.caption.empty(); });
}

Layout lay_out(const Grid& grid) {
    Layout layout;
    int row_titles = 0;
    std::vector<int> widths;
    for (const GridRow& row : grid.rows) {
        row_titles = std::max(row_titles, text_width(row.title) * grid.letters);
        widths.resize(std::max(widths.size(), row.cells.size()));
        for (std::size_t i = 0; i < row.cells.size(); ++i)
            widths[i] = std::max(widths[i], row.cells[i].image.width);
    }
    layout.x.push_back(margin + (row_titles > 0 ? row_titles + margin : 0));
    for (int width : widths) layout.x.push_back(layout.x.back() + width + margin);
    layout.scale_x = layout.x.back();
    layout.width = layout.scale_x + (grid.scale ? grid.scale->width + margin : 0);
    int y = margin;
    if (!grid.title.empty()) {
        const int most = (layout.width - 2 * margin) / (glyph_advance * (grid.letters + 1));
        layout.title_lines = wrapped(grid.title, static_cast<std::size_t>(std::max(most, 1)));
        y += static_cast<int>(layout.title_lines.size()) * line_height(grid.letters + 1) + gap;
    }
    layout.first_row = y;
    if (!grid.column_titles.empty()) y += line_height(grid.letters) + gap;
    for (const GridRow& row : grid.rows) {
        layout.y.push_back(y);
        int tallest = line_height(grid.letters);
        for (const Tile& tile : row.cells) tallest = std::max(tallest, tile.image.height);
        y += tallest + (has_captions(row) ? gap + line_height(grid.letters) : 0) + margin;
    }
    if (grid.scale && !layout.y.empty())
        y = std::max(y, layout.y.front() + grid.scale->height + margin);
    layout.height = y;
    return layout;
}

void paste(maps::Image& sheet, const maps::Image& tile, int left, int top) {
    for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x)
            for (int c = 0; c < 3; ++c)
                sheet.at(left + x, top + y, c) = tile.at(x, y, tile.channels >= 3 ? c : 0);
}

Status check(const Grid& grid) {
    bool any = false;
    for (const GridRow& row : grid.rows)
        for (const Tile& tile : row.cells) {
            any = true;
            if (Status status = maps::check_image(tile.image); !status) return status;
        }
    if (!any) return internal_error("empty-sheet", "a sheet needs at least one picture");
    return grid.scale ? maps::check_image(*grid.scale) : Status(Done{});
}

}  // namespace

Result<maps::Image> grid_sheet(const Grid& grid) {
    if (Status status = check(grid); !status) return status.error();
    const Layout layout = lay_out(grid);
    if (Status status = maps::check_size(layout.width, layout.height); !status)
        return status.error();
    maps::Image sheet = maps::blank_image(layout.width, layout.height, 3, 8);
    for (std::size_t i = 0; i < sheet.texels.size(); ++i) sheet.texels[i] = paper[i % 3];
    int y = margin;
    for (const std::string& line : layout.title_lines) {
        draw_text(sheet, margin, y, line, ink, grid.letters + 1);
        y += line_height(grid.letters + 1);
    }
    for (std::size_t i = 0; i < grid.column_titles.size(); ++i)
        draw_text(sheet, layout.x[i], layout.first_row, grid.column_titles[i], ink, grid.letters);
    for (std::size_t r = 0; r < grid.rows.size(); ++r) {
        const GridRow& row = grid.rows[r];
        draw_text(sheet, margin, layout.y[r], row.title, ink, grid.letters);
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            const Tile& tile = row.cells[i];
            paste(sheet, tile.image, layout.x[i], layout.y[r]);
            const auto most =
                static_cast<std::size_t>(tile.image.width / (glyph_advance * grid.letters));
            draw_text(sheet, layout.x[i], layout.y[r] + tile.image.height + gap,
                      tile.caption.substr(0, most), ink, grid.letters);
        }
    }
    if (grid.scale) paste(sheet, *grid.scale, layout.scale_x, layout.y.front());
    return sheet;
}

}  // namespace intaglio::report

// Many pictures in rows and columns with titles at the edges, and a scale that they share: what one
// reads across to compare.  contact_sheet is for pictures with words of their own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/report/picture.h"

namespace intaglio::report {

struct GridRow {
    std::string title;        // at the left; printable ASCII, one line
    std::vector<Tile> cells;  // captions of one line, cut at the picture's width; pictures as large
                              // as they are
};

struct Grid {
    std::string title;                       // above all; empty: none; breaks at '\n'
    std::vector<std::string> column_titles;  // none, or one for each column
    std::vector<GridRow> rows;
    std::optional<maps::Image> scale;  // at the right of the first row
    int letters = 1;                   // size of captions and titles; of `title` one more
};

// Codes: "empty-sheet", "image-malformed", "image-size".
Result<maps::Image> grid_sheet(const Grid& grid);

}  // namespace intaglio::report

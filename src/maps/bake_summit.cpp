// Maxima of squares: along rows, then along columns.
#include "src/maps/bake_summit.h"

#include <algorithm>

#include "src/maps/bake_grid.h"

namespace intaglio::maps {
namespace {

// One channel of `image` becomes the maximum of `source` over `reach` values on both sides, along
// rows where `along_rows`, else along columns; both repeat.
void widen(Image& image, int channel, const Image& source, int source_channel, int reach,
           bool along_rows) {
    for_each_row(image.height, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            float highest = 0;
            for (int step = -reach; step <= reach; ++step)
                highest = std::max(
                    highest, along_rows ? source.at(Grid::wrapped(x + step, image.width), y,
                                                    source_channel)
                                        : source.at(x, Grid::wrapped(y + step, image.height),
                                                    source_channel));
            image.at(x, y, channel) = highest;
        }
    });
}

// The next level of a chain: of every channel the maximum of the texels that each one touches.
Image halved(const Image& fine) {
    Image coarse = blank_image(std::max(1, fine.width / 2), std::max(1, fine.height / 2),
                               fine.channels, fine.bits);
    for (int y = 0; y < coarse.height; ++y)
        for (int x = 0; x < coarse.width; ++x) {
            const Children columns = children_of(x, fine.width, coarse.width);
            const Children rows = children_of(y, fine.height, coarse.height);
            for (int c = 0; c < fine.channels; ++c)
                for (int j = rows.first; j < rows.end; ++j)
                    for (int i = columns.first; i < columns.end; ++i)
                        coarse.at(x, y, c) = std::max(coarse.at(x, y, c), fine.at(i, j, c));
        }
    return coarse;
}

}  // namespace

Result<Image> bake_patch(const Image& heights) {
    if (Status sound = check_image(heights); !sound) return sound.error();
    const Grid grid(heights);
    Image patches = blank_image(heights.width, heights.height, 4, heights.bits);
    for (int j = 0; j < heights.height; ++j)
        for (int i = 0; i < heights.width; ++i) {
            const std::array<double, 4> corners = grid.wrapped_corners(i, j);
            for (int c = 0; c < 4; ++c)
                patches.at(i, j, c) = static_cast<float>(corners[static_cast<std::size_t>(c)]);
        }
    return patches;
}

Result<std::vector<Image>> bake_summit(const Image& heights) {
    const Result<Image> patches = bake_patch(heights);
    if (!patches) return patches.error();
    Image summits = blank_image(heights.width, heights.height, 4, heights.bits);
    for (int j = 0; j < heights.height; ++j)
        for (int i = 0; i < heights.width; ++i)
            summits.at(i, j, 0) = std::max({patches->at(i, j, 0), patches->at(i, j, 1),
                                            patches->at(i, j, 2), patches->at(i, j, 3)});
    // A square of reach r is the one before, widened by the difference of their reaches.
    Image rows = blank_image(heights.width, heights.height, 1, heights.bits);
    for (int c = 1; c < 4; ++c) {
        const int reach = summit_reach[static_cast<std::size_t>(c)] -
                          summit_reach[static_cast<std::size_t>(c - 1)];
        widen(rows, 0, summits, c - 1, reach, true);
        widen(summits, c, rows, 0, reach, false);
    }
    std::vector<Image> levels = {std::move(summits)};
    while (levels.back().width > 1 || levels.back().height > 1)
        levels.push_back(halved(levels.back()));
    return levels;
}

}  // namespace intaglio::maps

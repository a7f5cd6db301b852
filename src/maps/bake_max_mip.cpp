// Level 0 from the corners of each patch, each further level from the nodes that it touches.
#include "src/maps/bake_max_mip.h"

#include <algorithm>

#include "src/maps/bake_grid.h"

namespace intaglio::maps {
namespace {

Image halved(const Image& fine) {
    Image coarse =
        blank_image(std::max(1, fine.width / 2), std::max(1, fine.height / 2), 2, fine.bits);
    for (int y = 0; y < coarse.height; ++y)
        for (int x = 0; x < coarse.width; ++x) {
            const Children columns = children_of(x, fine.width, coarse.width);
            const Children rows = children_of(y, fine.height, coarse.height);
            float high = 0, low = 1;
            for (int j = rows.first; j < rows.end; ++j)
                for (int i = columns.first; i < columns.end; ++i) {
                    high = std::max(high, fine.at(i, j, 0));
                    low = std::min(low, fine.at(i, j, 1));
                }
            coarse.at(x, y, 0) = high;
            coarse.at(x, y, 1) = low;
        }
    return coarse;
}

}  // namespace

Result<std::vector<Image>> bake_max_mip(const Image& heights) {
    if (Status sound = check_image(heights); !sound) return sound.error();
    const Grid grid(heights);
    std::vector<Image> levels = {blank_image(heights.width, heights.height, 2, heights.bits)};
    for (int j = 0; j < heights.height; ++j)
        for (int i = 0; i < heights.width; ++i) {
            const std::array<double, 4> h = grid.corners(i, j);
            levels[0].at(i, j, 0) = static_cast<float>(*std::max_element(h.begin(), h.end()));
            levels[0].at(i, j, 1) = static_cast<float>(*std::min_element(h.begin(), h.end()));
        }
    while (levels.back().width > 1 || levels.back().height > 1)
        levels.push_back(halved(levels.back()));
    return levels;
}

Result<Image> stacked(const std::vector<Image>& levels) {
    int height = 0;
    for (const Image& level : levels) height += level.height;
    if (Status fits = check_size(levels.front().width, height); !fits) return fits.error();
    Image whole =
        blank_image(levels.front().width, height, levels.front().channels, levels.front().bits);
    int top = 0;
    for (const Image& level : levels) {
        for (int y = 0; y < level.height; ++y)
            for (int x = 0; x < level.width; ++x)
                for (int c = 0; c < level.channels; ++c)
                    whole.at(x, top + y, c) = level.at(x, y, c);
        top += level.height;
    }
    return whole;
}

}  // namespace intaglio::maps

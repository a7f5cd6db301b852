// The relief is taken as columns, each as high as the highest point of the surface over a voxel;
// the squared distance to them separates into height, u and v (Felzenszwalb and Huttenlocher,
// 2004).
#include "src/maps/bake_distance.h"

#include <algorithm>

#include <fmt/format.h>

#include "src/maps/bake_grid.h"

namespace intaglio::maps {
namespace {

// The highest point of the surface over each voxel's column of texture space.
std::vector<double> column_heights(const Grid& grid, int columns, int rows) {
    // In texels the voxel is [x, x + 1] * size / count - 0.5: the corners of all patches that it
    // touches are the texels from floor of the first to ceil of the last.
    const auto first = [](int at, int size, int count) {
        return static_cast<int>(std::floor(static_cast<double>(at) * size / count - 0.5));
    };
    const auto last = [](int at, int size, int count) {
        return static_cast<int>(std::ceil((at + 1.0) * size / count - 0.5));
    };
    std::vector<double> highest;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            double top = 0;
            for (int j = first(y, grid.height(), rows); j <= last(y, grid.height(), rows); ++j)
                for (int i = first(x, grid.width(), columns); i <= last(x, grid.width(), columns);
                     ++i)
                    top = std::max(top, grid.at(i, j));
            highest.push_back(top);
        }
    return highest;
}

// The least of from(i) + (gap between voxels 0 and i - at, squared) over all i of a repeating line:
// voxels next to each other touch.
template <typename From>
double nearest(int at, int count, const From& from) {
    double best = from(at);
    for (int away = 1; away <= count / 2 + 1; ++away) {
        const double gap = (away - 1.0) / count;
        if (gap * gap >= best) break;
        const double least =
            std::min(from(Grid::wrapped(at + away, count)), from(Grid::wrapped(at - away, count)));
        best = std::min(best, gap * gap + least);
    }
    return best;
}

void fill_slice(Volume& volume, int slice, const std::vector<double>& highest, int rows) {
    const int columns = volume.slices.width;
    const auto index = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(x);
    };
    const double low = std::max(0.0, (slice - 0.5) / (volume.depth - 1));
    std::vector<double> above(highest.size()), along_u(highest.size());
    for (std::size_t i = 0; i < highest.size(); ++i) {
        const double gap = std::max(0.0, low - highest[i]) * distance_depth;
        above[i] = gap * gap;
    }
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            along_u[index(x, y)] = nearest(x, columns, [&](int i) { return above[index(i, y)]; });
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const double squared = nearest(y, rows, [&](int j) { return along_u[index(x, j)]; });
            volume.at(x, y, slice) =
                rounded_down(std::sqrt(squared) / distance_depth * (1 - 1e-9), volume.slices.bits);
        }
}

}  // namespace

Result<Volume> bake_distance(const Image& heights, int columns, int rows, int slices,
                             const Work& work) {
    if (Status sound = check_image(heights); !sound) return sound.error();
    if (slices < 2 || slices > 256)
        return input_error("slices-range",
                           fmt::format("a distance map has 2 to 256 slices, not {}", slices));
    columns = std::clamp(columns, 1, heights.width);
    rows = std::clamp(rows, 1, heights.height);
    if (Status fits = check_size(columns, static_cast<long long>(rows) * slices); !fits)
        return fits.error();
    const Grid grid(heights);
    const std::vector<double> highest = column_heights(grid, columns, rows);
    Volume volume{slices, blank_image(columns, rows * slices, 1, heights.bits)};
    for_each_row(
        slices, [&](int slice) { fill_slice(volume, slice, highest, rows); }, work);
    return volume;
}

}  // namespace intaglio::maps

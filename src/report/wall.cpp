// Parallel rays from a picture's pixels to the polygon.
#include "src/report/wall.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace intaglio::report {
namespace {

// The steps over the polygon, in texture units, that one pixel to the right and one down make.
struct Steps {
    double right_u, right_v, down_u, down_v;
};

Steps steps_of(const WallView& wall) {
    const double azimuth = wall.view.azimuth * std::numbers::pi / 180;
    const double elevation = wall.view.elevation * std::numbers::pi / 180;
    const double pixel = wall.across / wall.width;
    const double towards = pixel / std::max(std::sin(elevation), 1e-3);
    return {pixel * std::sin(azimuth), -pixel * std::cos(azimuth), towards * std::cos(azimuth),
            towards * std::sin(azimuth)};
}

int wrapped_index(double at, int size) {
    const int index = static_cast<int>(std::floor(at * size)) % size;
    return index < 0 ? index + size : index;
}

// Enough samples a pixel, along both axes, that no straight pixel is left out.
int samples_along(double u, double v, const maps::Image& straight) {
    const double pixels = std::hypot(u * straight.width, v * straight.height);
    return std::clamp(static_cast<int>(std::ceil(pixels * 2)), 2, 32);
}

}  // namespace

maps::Image wall_picture(const maps::Image& straight, const WallView& wall, Footprint footprint) {
    const Steps steps = steps_of(wall);
    const bool mean = footprint == Footprint::Mean;
    const int across = mean ? samples_along(steps.right_u, steps.right_v, straight) : 1;
    const int down = mean ? samples_along(steps.down_u, steps.down_v, straight) : 1;
    maps::Image picture = maps::blank_image(wall.width, wall.height, 3, 8);
    const auto add_sample = [&](int x, int y, double dx, double dy, Rgb& sum) {
        const double right = x + dx - wall.width / 2.0, below = y + dy - wall.height / 2.0;
        const double u = 0.5 + right * steps.right_u + below * steps.down_u;
        const double v = 0.5 + right * steps.right_v + below * steps.down_v;
        const bool inside = u >= 0 && u < 1 && v >= 0 && v < 1;
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += !inside && wall.outside
                          ? (*wall.outside)[c]
                          : straight.at(wrapped_index(u, straight.width),
                                        wrapped_index(v, straight.height), static_cast<int>(c));
    };
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            Rgb sum = {0, 0, 0};
            for (int j = 0; j < down; ++j)
                for (int i = 0; i < across; ++i)
                    add_sample(x, y, (i + 0.5) / across, (j + 0.5) / down, sum);
            for (int c = 0; c < 3; ++c)
                picture.at(x, y, c) =
                    sum[static_cast<std::size_t>(c)] / static_cast<float>(across * down);
        }
    return picture;
}

}  // namespace intaglio::report

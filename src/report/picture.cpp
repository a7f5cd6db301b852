// Renders to display-ready pictures.
#include "src/report/picture.h"

#include <algorithm>
#include <cmath>

namespace intaglio::report {
namespace {

float display_of(float linear) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

}  // namespace

maps::Image to_image(const vulkan::Picture& picture) {
    maps::Image image = maps::blank_image(picture.width, picture.height, 3, 8);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const std::array<float, 4>& pixel = picture.at(x, y);
            const bool valid =
                std::all_of(pixel.begin(), pixel.end(), [](float c) { return std::isfinite(c); });
            for (std::size_t c = 0; c < 3; ++c)
                image.at(x, y, static_cast<int>(c)) =
                    valid ? display_of(pixel[c]) : invalid_colour[c];
        }
    }
    return image;
}

}  // namespace intaglio::report

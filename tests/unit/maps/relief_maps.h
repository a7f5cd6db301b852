// Small height maps for the tests of the bakes: every awkward size, and the reference as a witness.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "src/maps/makers.h"
#include "src/reference/trace.h"

namespace intaglio::maps {

struct ReliefMap {
    std::string name;
    Image heights;
};

// Noise in 8 or 16 bits; `sparse`: most texels 0, a few high.
inline Image random_heights(int width, int height, int bits, bool sparse, std::mt19937& random) {
    Image image = blank_image(width, height, 1, bits);
    const int top = bits == 8 ? 255 : 65535;
    std::uniform_int_distribution<int> step(0, top), chance(0, 99);
    for (float& texel : image.texels)
        if (!sparse || chance(random) < 8)
            texel = static_cast<float>(step(random)) / static_cast<float>(top);
    return image;
}

inline std::vector<ReliefMap> relief_maps(std::mt19937& random) {
    std::vector<ReliefMap> maps;
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {2, 2}, {3, 5}, {16, 4}, {13, 17}})
        for (const bool sparse : {false, true})
            maps.push_back({std::to_string(width) + "x" + std::to_string(height) +
                                (sparse ? " sparse" : " noise"),
                            random_heights(width, height, width % 2 ? 16 : 8, sparse, random)});
    for (const char* maker : {"bricks", "spikes", "smooth", "steps", "ramp", "flat0", "flat1"}) {
        const Result<Image> made = make_height_map(maker, 24, 32, 1);
        if (made) maps.push_back({maker, *made});
    }
    return maps;
}

inline reference::HeightField field_of(const Image& heights) {
    reference::HeightField field;
    field.width = heights.width;
    field.height = heights.height;
    field.heights.assign(heights.texels.begin(), heights.texels.end());
    return field;
}

// A channel as a sampler reads it, linearly and repeating.
inline double linear_read(const Image& image, int channel, double u, double v) {
    const double x = u * image.width - 0.5, y = v * image.height - 0.5;
    const double i = std::floor(x), j = std::floor(y), fx = x - i, fy = y - j;
    const auto texel = [&](double column, double row) {
        const int w = image.width, h = image.height;
        const int a = ((static_cast<int>(column) % w) + w) % w,
                  b = ((static_cast<int>(row) % h) + h) % h;
        return static_cast<double>(image.at(a, b, channel));
    };
    const double upper = texel(i, j) * (1 - fx) + texel(i + 1, j) * fx;
    const double lower = texel(i, j + 1) * (1 - fx) + texel(i + 1, j + 1) * fx;
    return upper * (1 - fy) + lower * fy;
}

}  // namespace intaglio::maps

// What does not depend on a file format: checks, the choice of the height channel, mip levels.
#include "src/maps/image.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace intaglio::maps {
namespace {

std::size_t texel_count(const Image& image) {
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

bool alpha_varies(const Image& image) {
    if (image.channels != 2 && image.channels != 4) return false;
    const auto step = static_cast<std::size_t>(image.channels);
    for (std::size_t i = step - 1; i < image.texels.size(); i += step) {
        if (image.texels[i] != image.texels[step - 1]) return true;
    }
    return false;
}

float luminance(const float* rgb) {
    return static_cast<float>(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
}

// The share of one coarser texel that each finer texel has: its first index and its weights, which
// sum to 1.
struct Footprint {
    int first = 0;
    std::vector<double> weights;
};

// Texel i of `coarse` covers [i, i + 1) * fine / coarse of the finer row.
std::vector<Footprint> footprints(int fine, int coarse) {
    std::vector<Footprint> result(static_cast<std::size_t>(coarse));
    const double ratio = static_cast<double>(fine) / coarse;
    for (int i = 0; i < coarse; ++i) {
        Footprint& footprint = result[static_cast<std::size_t>(i)];
        // In integers: the borders i * fine / coarse, so that rounding cannot add an empty texel.
        const long long begin = static_cast<long long>(i) * fine;
        const long long end = begin + fine;
        footprint.first = static_cast<int>(begin / coarse);
        for (long long texel = footprint.first; texel * coarse < end; ++texel) {
            const long long overlap =
                std::min(end, (texel + 1) * coarse) - std::max(begin, texel * coarse);
            footprint.weights.push_back(static_cast<double>(overlap) / coarse / ratio);
        }
    }
    return result;
}

Image half_size(const Image& fine) {
    Image coarse = blank_image(std::max(1, fine.width / 2), std::max(1, fine.height / 2),
                               fine.channels, fine.bits);
    const std::vector<Footprint> columns = footprints(fine.width, coarse.width);
    const std::vector<Footprint> rows = footprints(fine.height, coarse.height);
    for (int y = 0; y < coarse.height; ++y) {
        const Footprint& row = rows[static_cast<std::size_t>(y)];
        for (int x = 0; x < coarse.width; ++x) {
            const Footprint& column = columns[static_cast<std::size_t>(x)];
            for (int c = 0; c < fine.channels; ++c) {
                double sum = 0;
                for (std::size_t j = 0; j < row.weights.size(); ++j) {
                    for (std::size_t i = 0; i < column.weights.size(); ++i) {
                        sum += row.weights[j] * column.weights[i] *
                               fine.at(column.first + static_cast<int>(i),
                                       row.first + static_cast<int>(j), c);
                    }
                }
                coarse.at(x, y, c) = static_cast<float>(sum);
            }
        }
    }
    return coarse;
}

}  // namespace

Image blank_image(int width, int height, int channels, int bits) {
    Image image{width, height, channels, bits, {}};
    image.texels.resize(texel_count(image) * static_cast<std::size_t>(channels));
    return image;
}

Status check_size(long long width, long long height) {
    if (width < 1 || height < 1) {
        return input_error(
            "image-size",
            fmt::format("an image of {} x {} texels is empty; the least is 1 x 1", width, height));
    }
    if (width > largest_side || height > largest_side) {
        return input_error(
            "image-size",
            fmt::format("an image of {} x {} texels is too large; a side has at most {}", width,
                        height, largest_side));
    }
    if (static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > largest_area) {
        return input_error(
            "image-size",
            fmt::format("an image of {} x {} texels is too large; it may have at most {} "
                        "texels, as 8192 x 8192 has",
                        width, height, largest_area));
    }
    return Done{};
}

Status check_image(const Image& image) {
    if (const Status size = check_size(image.width, image.height); !size) {
        return input_error("image-malformed", size.error().message);
    }
    if (image.channels < 1 || image.channels > 4) {
        return input_error("image-malformed",
                           fmt::format("an image has 1 to 4 channels, not {}", image.channels));
    }
    if (image.bits != 8 && image.bits != 16) {
        return input_error(
            "image-malformed",
            fmt::format("an image has 8 or 16 bits per channel, not {}", image.bits));
    }
    const std::size_t expected = texel_count(image) * static_cast<std::size_t>(image.channels);
    if (image.texels.size() != expected) {
        return input_error(
            "image-malformed",
            fmt::format("an image of {} x {} texels with {} channels has {} values, not {}",
                        image.width, image.height, image.channels, expected, image.texels.size()));
    }
    return Done{};
}

unsigned stored_step(float value, int bits) {
    if (!(value > 0.0f)) return 0;  // also NaN
    return static_cast<unsigned>(
        std::lround(std::min(value, 1.0f) * (bits == 8 ? 255.0f : 65535.0f)));
}

Result<Image> heights_of(const Image& image, HeightSource source) {
    if (Status sound = check_image(image); !sound) return sound.error();
    const bool has_alpha = image.channels == 2 || image.channels == 4;
    if (source == HeightSource::Alpha && !has_alpha) {
        return input_error(
            "no-alpha",
            fmt::format("the height was asked from alpha, but the image has {} and no alpha",
                        image.channels == 1 ? "gray" : "RGB"));
    }
    if (source == HeightSource::Automatic) {
        source = alpha_varies(image) ? HeightSource::Alpha : HeightSource::Red;
    }
    Image heights = blank_image(image.width, image.height, 1, image.bits);
    const auto step = static_cast<std::size_t>(image.channels);
    const bool weighted = source == HeightSource::Luminance && image.channels >= 3;
    const std::size_t channel = source == HeightSource::Alpha ? step - 1 : 0;
    for (std::size_t i = 0; i < heights.texels.size(); ++i) {
        const float* texel = &image.texels[i * step];
        heights.texels[i] = weighted ? luminance(texel) : texel[channel];
    }
    return heights;
}

Result<Image> with_height_in_alpha(const Image& normals, const Image& heights) {
    if (Status sound = check_image(normals); !sound) return sound.error();
    if (Status sound = check_image(heights); !sound) return sound.error();
    if (normals.channels < 3) {
        return input_error("image-mismatch", fmt::format("a normal map has 3 or 4 channels, not {}",
                                                         normals.channels));
    }
    if (normals.width != heights.width || normals.height != heights.height) {
        return input_error(
            "image-mismatch",
            fmt::format("the normal map has {} x {} texels, but the height map {} x {}",
                        normals.width, normals.height, heights.width, heights.height));
    }
    Image combined =
        blank_image(normals.width, normals.height, 4, std::max(normals.bits, heights.bits));
    for (int y = 0; y < combined.height; ++y) {
        for (int x = 0; x < combined.width; ++x) {
            for (int c = 0; c < 3; ++c) combined.at(x, y, c) = normals.at(x, y, c);
            combined.at(x, y, 3) = heights.at(x, y);
        }
    }
    return combined;
}

std::vector<Image> mip_chain(const Image& image) {
    std::vector<Image> levels;
    if (!check_image(image)) return levels;
    levels.push_back(image);
    while (levels.back().width > 1 || levels.back().height > 1) {
        levels.push_back(half_size(levels.back()));
    }
    return levels;
}

}  // namespace intaglio::maps

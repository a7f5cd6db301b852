// The patterns.  Most are functions of (u, v) sampled at texel centres, periodic in both; fur and
// spikes are laid out in texels, because a hair or a spike is as thin as a texel at any size.
#include "src/maps/patterns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace intaglio::maps {
namespace {

// Multiply and shift; the constants are those of lowbias32 (Chris Wellons, "Prospecting for Hash
// Functions", 2018).
std::uint32_t mixed(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ (x >> 16);
}

int wrapped(int i, int period) { return ((i % period) + period) % period; }

double clamped(double x) { return std::clamp(x, 0.0, 1.0); }

double smooth_step(double x) {
    x = clamped(x);
    return x * x * (3 - 2 * x);
}

double blend(double a, double b, double t) { return a + (b - a) * t; }

// The sine of a number of turns, to 1e-13: folded to a quarter turn, then its Taylor series.
double sine_of_turns(double turns) {
    turns -= std::floor(turns + 0.5);
    if (turns > 0.25) turns = 0.5 - turns;
    if (turns < -0.25) turns = -0.5 - turns;
    const double x = turns * 6.283185307179586;
    double sum = 1;
    for (int n = 18; n >= 2; n -= 2) sum = 1 - sum * x * x / (n * (n + 1));
    return x * sum;
}

// Heights are whole steps of 1/65535, so that they pass through a 16-bit PNG unchanged.
float stored(double height) {
    return static_cast<float>(std::floor(clamped(height) * 65535.0 + 0.5)) / 65535.0f;
}

template <typename Height>
Image by_texel(int width, int height, const Height& height_at) {
    Image image = blank_image(width, height, 1, 16);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) image.at(x, y) = stored(height_at(x, y));
    }
    return image;
}

template <typename Height>
Image by_position(int width, int height, const Height& height_at) {
    return by_texel(width, height,
                    [&](int x, int y) { return height_at((x + 0.5) / width, (y + 0.5) / height); });
}

// Value noise: random heights on a lattice of cells x cells, blended by the quintic of Perlin's
// "Improving Noise" (2002).
double value_noise(double u, double v, int cells, std::uint32_t seed) {
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const int x = static_cast<int>(std::floor(u * cells));
    const int y = static_cast<int>(std::floor(v * cells));
    const double s = fade(u * cells - x);
    const double t = fade(v * cells - y);
    const auto corner = [&](int i, int j) {
        return random_unit(seed, wrapped(x + i, cells), wrapped(y + j, cells),
                           static_cast<std::uint32_t>(cells));
    };
    return blend(blend(corner(0, 0), corner(1, 0), s), blend(corner(0, 1), corner(1, 1), s), t);
}

// Four octaves, each twice as fine and half as high.
double fractal_noise(double u, double v, int cells, std::uint32_t seed) {
    double sum = 0;
    double weight = 8.0 / 15;
    for (int octave = 0; octave < 4; ++octave, cells *= 2, weight /= 2) {
        sum += weight * value_noise(u, v, cells, seed + static_cast<std::uint32_t>(octave));
    }
    return sum;
}

// Worley's cellular texture (SIGGRAPH 1996): distances to the nearest two of one random point per
// cell.
struct Cells {
    double nearest = 1e9;
    double second = 1e9;
    double tone = 0;  // of the nearest point, in [0, 1)
};

Cells cells_at(double u, double v, int cells, std::uint32_t seed) {
    Cells found;
    const int column = static_cast<int>(std::floor(u * cells));
    const int row = static_cast<int>(std::floor(v * cells));
    for (int y = row - 1; y <= row + 1; ++y) {
        for (int x = column - 1; x <= column + 1; ++x) {
            const int wx = wrapped(x, cells);
            const int wy = wrapped(y, cells);
            const double dx = x + 0.2 + 0.6 * random_unit(seed, wx, wy, 1) - u * cells;
            const double dy = y + 0.2 + 0.6 * random_unit(seed, wx, wy, 2) - v * cells;
            const double distance = std::sqrt(dx * dx + dy * dy);
            if (distance < found.nearest) {
                found.second = found.nearest;
                found.nearest = distance;
                found.tone = random_unit(seed, wx, wy, 3);
            } else {
                found.second = std::min(found.second, distance);
            }
        }
    }
    return found;
}

// Glyphs of 5 x 7: seven rows from the top, five bits each, the left column the highest bit.
struct Glyph {
    char letter;
    std::array<std::uint8_t, 7> rows;
};
constexpr Glyph glyphs[] = {
    {'A', {0x0e, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11}},
    {'C', {0x0e, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0e}},
    {'E', {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x1f}},
    {'F', {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x10}},
    {'G', {0x0e, 0x11, 0x10, 0x17, 0x11, 0x11, 0x0f}},
    {'I', {0x0e, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'L', {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1f}},
    {'N', {0x11, 0x19, 0x15, 0x13, 0x11, 0x11, 0x11}},
    {'O', {0x0e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e}},
    {'R', {0x1e, 0x11, 0x11, 0x1e, 0x14, 0x12, 0x11}},
    {'S', {0x0f, 0x10, 0x10, 0x0e, 0x01, 0x01, 0x1e}},
    {'T', {0x1f, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}},
    {'U', {0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e}},
    {'V', {0x11, 0x11, 0x11, 0x11, 0x11, 0x0a, 0x04}},
};
// Eight letters to a line, six columns and eight rows of dots to a letter: 48 x 48 square dots in
// all.
constexpr std::array<std::string_view, 6> lines = {"INTAGLIO", "RELIEF  ", "SURFACES",
                                                   "  CARVE ", "INTAGLIO", " FUR ART"};
constexpr int dots = 48;

bool dot_is_set(int x, int y, std::uint32_t seed) {
    const auto line = (static_cast<std::uint32_t>(y / 8) + seed) % lines.size();
    const char letter = lines[line][static_cast<std::size_t>(x / 6)];
    if (x % 6 == 5 || y % 8 == 7) return false;
    for (const Glyph& glyph : glyphs) {
        if (glyph.letter != letter) continue;
        return ((glyph.rows[static_cast<std::size_t>(y % 8)] >> (4 - x % 6)) & 1) != 0;
    }
    return false;
}

}  // namespace

double random_unit(std::uint32_t seed, int x, int y, std::uint32_t purpose) {
    std::uint32_t hash = mixed(seed ^ 0x9e3779b9U);
    hash = mixed(hash ^ static_cast<std::uint32_t>(x));
    hash = mixed(hash + 0x85ebca6bU + static_cast<std::uint32_t>(y));
    hash = mixed(hash ^ (purpose * 0xc2b2ae35U));
    return static_cast<double>(hash >> 8) / 16777216.0;
}

Image bricks(int width, int height, std::uint32_t seed) {
    constexpr int columns = 4;
    constexpr int rows = 8;
    return by_position(width, height, [seed](double u, double v) {
        const int row = static_cast<int>(v * rows);
        const double along = u * columns + (row % 2 == 0 ? 0.0 : 0.5);
        const int column = static_cast<int>(along);
        const double s = along - column;
        const double t = v * rows - row;
        // In texture units, so that joints are as wide across as along.
        const double from_edge = std::min(std::min(s, 1 - s) / columns, std::min(t, 1 - t) / rows);
        const int brick = column % columns;
        const auto random = [&](std::uint32_t purpose) {
            return random_unit(seed, brick, row, purpose) - 0.5;
        };
        const double grain = fractal_noise(u, v, 16, seed) - 0.5;
        const double face = 0.84 + 0.16 * random(1) + 0.1 * random(2) * (s - 0.5) +
                            0.1 * random(3) * (t - 0.5) + 0.08 * grain;
        const double mortar = 0.2 + 0.1 * grain;
        return blend(mortar, face, smooth_step((from_edge - 0.007) / 0.011));
    });
}

Image cobbles(int width, int height, std::uint32_t seed) {
    return by_position(width, height, [seed](double u, double v) {
        const Cells cells = cells_at(u, v, 7, seed);
        const double edge = smooth_step((cells.second - cells.nearest) / 0.35);
        const double dome = 1 - 0.6 * cells.nearest * cells.nearest;
        const double grain = 0.06 * (fractal_noise(u, v, 16, seed) - 0.5);
        return 0.06 + edge * dome * (0.76 + 0.16 * cells.tone) + grain;
    });
}

Image text(int width, int height, std::uint32_t seed) {
    return by_position(width, height, [seed](double u, double v) {
        // Bilinear between dots, then steepened: raised letters with narrow slopes instead of sheer
        // walls.
        const double x = u * dots - 0.5;
        const double y = v * dots - 0.5;
        const int column = static_cast<int>(std::floor(x));
        const int row = static_cast<int>(std::floor(y));
        const auto dot = [&](int i, int j) {
            return dot_is_set(wrapped(column + i, dots), wrapped(row + j, dots), seed) ? 1.0 : 0.0;
        };
        const double s = x - column;
        const double cover =
            blend(blend(dot(0, 0), dot(1, 0), s), blend(dot(0, 1), dot(1, 1), s), y - row);
        return blend(0.15, 0.95, smooth_step((cover - 0.3) / 0.4));
    });
}

Image pyramids(int width, int height, std::uint32_t) {
    constexpr int across = 4;
    return by_position(width, height, [](double u, double v) {
        const double s = u * across - std::floor(u * across);
        const double t = v * across - std::floor(v * across);
        return 1 - std::max(std::abs(2 * s - 1), std::abs(2 * t - 1));
    });
}

Image fur(int width, int height, std::uint32_t seed) {
    const int columns = std::max(1, width / 4);
    const int rows = std::max(1, height / 4);
    constexpr double radius = 0.4;  // of a cell of about 4 texels
    return by_position(width, height, [=](double u, double v) {
        const int column = static_cast<int>(u * columns);
        const int row = static_cast<int>(v * rows);
        double highest = 0;
        for (int y = row - 1; y <= row + 1; ++y) {
            for (int x = column - 1; x <= column + 1; ++x) {
                const int wx = wrapped(x, columns);
                const int wy = wrapped(y, rows);
                const double dx = x + random_unit(seed, wx, wy, 1) - u * columns;
                const double dy = y + random_unit(seed, wx, wy, 2) - v * rows;
                const double length = 0.4 + 0.6 * random_unit(seed, wx, wy, 3);
                const double inside = 1 - (dx * dx + dy * dy) / (radius * radius);
                highest = std::max(highest, length * inside);
            }
        }
        return highest;
    });
}

Image spikes(int width, int height, std::uint32_t seed) {
    constexpr int block = 8;
    const int columns = std::max(1, width / block);
    const int rows = std::max(1, height / block);
    Image image = blank_image(width, height, 1, 16);
    const auto start = [](int i, int count, int size) {
        return static_cast<int>(static_cast<long long>(i) * size / count);
    };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const int x0 = start(column, columns, width);
            const int y0 = start(row, rows, height);
            const int dx = start(column + 1, columns, width) - x0;
            const int dy = start(row + 1, rows, height) - y0;
            const int x = x0 + static_cast<int>(random_unit(seed, column, row, 1) * dx);
            const int y = y0 + static_cast<int>(random_unit(seed, column, row, 2) * dy);
            image.at(x, y) = 1.0f;
        }
    }
    return image;
}

Image steps(int width, int height, std::uint32_t) {
    constexpr int count = 8;
    return by_position(width, height, [](double u, double) {
        return std::min(std::floor(u * count), count - 1.0) / (count - 1);
    });
}

Image noise(int width, int height, std::uint32_t seed) {
    return by_position(width, height,
                       [seed](double u, double v) { return fractal_noise(u, v, 4, seed); });
}

Image smooth(int width, int height, std::uint32_t seed) {
    return by_position(width, height, [seed](double u, double v) {
        const auto wave = [&](double turns, std::uint32_t purpose) {
            return sine_of_turns(turns + random_unit(seed, 0, 0, purpose));
        };
        return 0.5 + 0.16 * wave(u, 1) + 0.16 * wave(v, 2) + 0.1 * wave(u + 2 * v, 3) +
               0.07 * wave(2 * u - v, 4);
    });
}

Image flat_0(int width, int height, std::uint32_t) {
    return by_texel(width, height, [](int, int) { return 0.0; });
}

Image flat_1(int width, int height, std::uint32_t) {
    return by_texel(width, height, [](int, int) { return 1.0; });
}

Image ramp(int width, int height, std::uint32_t) {
    return by_position(width, height, [](double u, double) { return u; });
}

}  // namespace intaglio::maps

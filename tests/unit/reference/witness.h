// What the reference is judged by: its own sampling of the map, written from the definition of
// bilinear filtering and sharing no code with src/reference, and random maps and rays of the kinds
// that break searches.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "src/reference/trace.h"

namespace intaglio::reference::witness {

inline constexpr double pi = 3.14159265358979323846;

// The seed of a random test, printed; INTAGLIO_SEED=n runs another one.
inline std::uint64_t seed() {
    const char* given = std::getenv("INTAGLIO_SEED");
    const std::uint64_t value = given ? std::strtoull(given, nullptr, 10) : 20040601;
    std::cout << "seed " << value << "\n";
    return value;
}

class Random {
  public:
    explicit Random(std::uint64_t from) : engine_(from) {}
    double real(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    int integer(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
    }
    bool chance(double p) { return real(0, 1) < p; }

  private:
    std::mt19937_64 engine_;
};

inline double texel(const HeightField& field, long x, long y) {
    const long w = field.width, h = field.height;
    if (field.wrap == Wrap::Repeat) {
        x = ((x % w) + w) % w;
        y = ((y % h) + h) % h;
    } else {
        x = std::min(std::max(x, 0L), w - 1);
        y = std::min(std::max(y, 0L), h - 1);
    }
    return field.heights[static_cast<std::size_t>(y * w + x)];
}

inline double bilinear(const HeightField& field, double u, double v) {
    const double x = u * field.width - 0.5, y = v * field.height - 0.5;
    const long i = std::lround(std::floor(x)), j = std::lround(std::floor(y));
    double a = x - std::floor(x), b = y - std::floor(y);
    if (field.weights == FilterWeights::EightBit) {
        a = std::round(a * 256) / 256;
        b = std::round(b * 256) / 256;
    }
    return (1 - b) * ((1 - a) * texel(field, i, j) + a * texel(field, i + 1, j)) +
           b * ((1 - a) * texel(field, i, j + 1) + a * texel(field, i + 1, j + 1));
}

// A map, a start, a direction (to the eye or to the light) and a depth.
struct Case {
    HeightField field;
    Vec2 uv;
    Vec3 direction;
    double scale;

    Vec2 move() const {
        return {direction.x / direction.z * scale, direction.y / direction.z * scale};
    }
    // The length of the path in texels; and with it the size of the coordinates, which rounding
    // grows with.
    double texels() const {
        return std::abs(move().x) * field.width + std::abs(move().y) * field.height;
    }
    double extent() const {
        return texels() + (std::abs(uv.x) + 1) * field.width + (std::abs(uv.y) + 1) * field.height;
    }
};

inline std::string describe(const Case& c) {
    std::ostringstream text;
    text.precision(17);
    text << c.field.width << "x" << c.field.height
         << (c.field.wrap == Wrap::Repeat ? " repeat" : " clamp")
         << (c.field.weights == FilterWeights::Exact ? " exact" : " 8-bit") << ", uv " << c.uv.x
         << " " << c.uv.y << ", direction " << c.direction.x << " " << c.direction.y << " "
         << c.direction.z << ", scale " << c.scale << ", heights";
    for (const double h : c.field.heights) text << " " << h;
    return text.str();
}

enum class Relief { Noise, Bytes, Binary, Spikes, Pits, Hills, Flat };

inline HeightField random_field(Random& random, int largest) {
    HeightField field;
    field.width = random.integer(1, largest);
    field.height = random.integer(1, largest);
    field.wrap = random.chance(0.5) ? Wrap::Repeat : Wrap::Clamp;
    const auto relief = static_cast<Relief>(random.integer(0, 6));
    const double level = random.integer(0, 4) / 4.0, phase = random.real(0, 6);
    for (int y = 0; y < field.height; ++y) {
        for (int x = 0; x < field.width; ++x) {
            double h = level;
            if (relief == Relief::Noise) h = random.real(0, 1);
            if (relief == Relief::Bytes) h = random.integer(0, 255) / 255.0;
            if (relief == Relief::Binary) h = random.integer(0, 1);
            if (relief == Relief::Spikes) h = random.chance(0.1) ? 1 : 0;
            if (relief == Relief::Pits) h = random.chance(0.1) ? 0 : 1;
            if (relief == Relief::Hills)
                h = 0.5 + 0.5 * std::sin(x * 0.9 + phase) * std::cos(y * 0.7);
            field.heights.push_back(h);
        }
    }
    return field;
}

// Up to `steepest` degrees from the normal; every third along an axis or a diagonal, every third
// through texel centres or the corners between texels.
inline Case random_case(Random& random, int largest, double steepest) {
    Case c{random_field(random, largest), {}, {}, random.chance(0.05) ? 0 : random.real(0.01, 0.6)};
    c.uv = {random.real(-2, 3), random.real(-2, 3)};
    if (random.chance(1.0 / 3)) {
        c.uv = {random.integer(-4, 20) * 0.5 / c.field.width,
                random.integer(-4, 20) * 0.5 / c.field.height};
    }
    const double angle = random.chance(0.05) ? 0 : random.real(0, steepest) * pi / 180;
    const double azimuth = random.real(0, 2 * pi);
    c.direction = {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
                   std::cos(angle)};
    if (random.chance(1.0 / 3)) {
        const double z = random.chance(0.5) ? 0.25 * random.integer(1, 8) : random.real(0.05, 2);
        c.direction = {double(random.integer(-1, 1)), double(random.integer(-1, 1)), z};
        if (random.chance(0.5)) c.scale = 0.125 * random.integer(1, 4);
    }
    return c;
}

// A path over the map: uv + move * t, at height start + rise * t, for t in [0, end].
struct Path {
    Vec2 uv, move;
    double start, rise, end;

    double gap(const HeightField& field, double t) const {  // of the surface above the path
        return bilinear(field, uv.x + move.x * t, uv.y + move.y * t) - (start + rise * t);
    }
};

// The limits, sorted, of the stretches on which the surface is one formula: a quadratic, or with
// 8-bit weights a constant.
inline std::vector<double> stretches(const HeightField& field, const Path& path) {
    const bool steps = field.weights == FilterWeights::EightBit;
    const double per_texel = steps ? 256 : 1, shift = steps ? 0.5 : 0;
    std::vector<double> limits{0, path.end};
    const auto add = [&](double start, double step) {
        if (step == 0) return;
        const double last = start + step * path.end;
        for (double edge = std::ceil(std::min(start, last)); edge <= std::max(start, last);
             ++edge) {
            limits.push_back(std::clamp((edge - start) / step, 0.0, path.end));
        }
    };
    add((path.uv.x * field.width - 0.5) * per_texel + shift, path.move.x * field.width * per_texel);
    add((path.uv.y * field.height - 0.5) * per_texel + shift,
        path.move.y * field.height * per_texel);
    std::sort(limits.begin(), limits.end());
    return limits;
}

// The greatest gap on the path, for exact weights: in each cell, of the parabola through three
// samples.
inline double greatest_gap(const HeightField& field, const Path& path) {
    const std::vector<double> limits = stretches(field, path);
    double greatest = path.gap(field, 0);
    for (std::size_t k = 0; k + 1 < limits.size(); ++k) {
        const double a = limits[k], b = limits[k + 1];
        const double first = path.gap(field, a), middle = path.gap(field, (a + b) / 2),
                     last = path.gap(field, b);
        greatest = std::max({greatest, first, middle, last});
        const double slope = 4 * middle - 3 * first - last, bend = 2 * (first - 2 * middle + last);
        const double summit = -slope / (2 * bend);
        if (bend < 0 && summit > 0 && summit < 1)
            greatest = std::max(greatest, first + slope * summit / 2);
    }
    return greatest;
}

}  // namespace intaglio::reference::witness

// Texture reads: choose levels, then texels and weights along each axis, then mix.
#include "generator/ir/texture.h"

#include <algorithm>
#include <cmath>

namespace intaglio::ir {
namespace {

int level_size(int size, std::size_t level) { return level < 31 ? std::max(1, size >> level) : 1; }

// Two texel indexes along one axis, and how much of the second.
template <typename T>
struct Tap {
    int first = 0;
    int second = 0;
    T weight = 0;
};

// The index of a texel in [-1, size] after wrapping.
int wrapped(int index, int size, Texture::Wrap wrap) {
    if (wrap == Texture::Wrap::Clamp) return std::clamp(index, 0, size - 1);
    return index < 0 ? index + size : index >= size ? index - size : index;
}

template <typename T>
Tap<T> tap(const Texture& texture, Texture::Filter filter, T coordinate, int size) {
    // Repeating takes the fraction first, so that far from the origin no precision goes to the
    // multiplication.
    T scaled =
        texture.wrap == Texture::Wrap::Repeat ? coordinate - std::floor(coordinate) : coordinate;
    scaled *= static_cast<T>(size);
    if (std::isnan(scaled)) scaled = 0;
    scaled = std::clamp(scaled, T(-1), static_cast<T>(size) + T(1));
    if (filter == Texture::Filter::Nearest) {
        const int index = wrapped(static_cast<int>(std::floor(scaled)), size, texture.wrap);
        return {index, index, T(0)};
    }
    T position = scaled - T(0.5);
    if (texture.weights == Texture::Weights::EightBit)
        position = std::floor(position * T(256) + T(0.5)) / T(256);
    const T below = std::floor(position);
    const int index = static_cast<int>(below);
    return {wrapped(index, size, texture.wrap), wrapped(index + 1, size, texture.wrap),
            position - below};
}

template <typename T>
std::array<T, 4> mix(const std::array<T, 4>& a, const std::array<T, 4>& b, T weight) {
    std::array<T, 4> result;
    for (std::size_t i = 0; i < 4; ++i) result[i] = a[i] + (b[i] - a[i]) * weight;
    return result;
}

template <typename T>
std::array<T, 4> sample_one_level(const Texture& texture, Texture::Filter filter,
                                  const std::array<T, 3>& coordinate, std::size_t level) {
    const int width = level_size(texture.width, level);
    const int height = level_size(texture.height, level);
    const int depth = level_size(texture.depth, level);
    const std::vector<float>& texels = texture.levels[level];
    const Tap<T> x = tap(texture, filter, coordinate[0], width);
    const Tap<T> y = tap(texture, filter, coordinate[1], height);
    const Tap<T> z = texture.depth > 1 ? tap(texture, filter, coordinate[2], depth) : Tap<T>{};
    const auto texel = [&](int column, int row, int slice) {
        const auto index = ((static_cast<std::size_t>(slice) * static_cast<std::size_t>(height) +
                             static_cast<std::size_t>(row)) *
                                static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(column)) *
                           4;
        std::array<T, 4> result{};
        if (index + 4 <= texels.size())
            for (std::size_t i = 0; i < 4; ++i) result[i] = static_cast<T>(texels[index + i]);
        return result;
    };
    // A weight of 0 does not read the second texel: an infinite one would make the result NaN.
    const auto row = [&](int r, int slice) {
        const auto left = texel(x.first, r, slice);
        return x.weight == 0 ? left : mix(left, texel(x.second, r, slice), x.weight);
    };
    const auto slice = [&](int s) {
        const auto top = row(y.first, s);
        return y.weight == 0 ? top : mix(top, row(y.second, s), y.weight);
    };
    const auto front = slice(z.first);
    return z.weight == 0 ? front : mix(front, slice(z.second), z.weight);
}

// A level within the chain; NaN is 0.
template <typename T>
T clamped_level(const Texture& texture, T level) {
    const T last = static_cast<T>(texture.levels.size() - 1);
    return std::isnan(level) ? T(0) : std::clamp(level, T(0), last);
}

template <typename T>
std::size_t nearest_level(const Texture& texture, T level) {
    const T rounded = std::ceil(clamped_level(texture, level) + T(0.5)) - T(1);
    return static_cast<std::size_t>(clamped_level(texture, rounded));
}

}  // namespace

bool Texture::is_complete() const {
    if (levels.empty() || width < 1 || height < 1 || depth < 1) return false;
    for (std::size_t level = 0; level < levels.size(); ++level) {
        const auto texels = static_cast<std::size_t>(level_size(width, level)) *
                            static_cast<std::size_t>(level_size(height, level)) *
                            static_cast<std::size_t>(level_size(depth, level));
        if (levels[level].size() != texels * 4) return false;
    }
    return true;
}

template <typename T>
std::array<T, 4> sample_level(const Texture& texture, const std::array<T, 3>& coordinate, T level) {
    if (texture.levels.empty()) return {};
    if (texture.mip_filter == Texture::Filter::Nearest)
        return sample_one_level(texture, texture.filter, coordinate,
                                nearest_level(texture, level));
    const T clamped = clamped_level(texture, level);
    const T below = std::floor(clamped);
    const auto index = static_cast<std::size_t>(below);
    const auto fine = sample_one_level(texture, texture.filter, coordinate, index);
    if (clamped == below) return fine;
    return mix(fine, sample_one_level(texture, texture.filter, coordinate, index + 1),
               clamped - below);
}

template <typename T>
std::array<T, 4> sample_nearest(const Texture& texture, const std::array<T, 3>& coordinate,
                                T level) {
    if (texture.levels.empty()) return {};
    return sample_one_level(texture, Texture::Filter::Nearest, coordinate,
                            nearest_level(texture, level));
}

template <typename T>
T level_of_gradients(const Texture& texture, const std::array<T, 3>& dx,
                     const std::array<T, 3>& dy) {
    const std::array<T, 3> size = {static_cast<T>(texture.width), static_cast<T>(texture.height),
                                   texture.depth > 1 ? static_cast<T>(texture.depth) : T(0)};
    const auto squared_length = [&](const std::array<T, 3>& gradient) {
        T sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            if (size[i] > 0) sum += gradient[i] * size[i] * (gradient[i] * size[i]);
        return sum;
    };
    const T x = squared_length(dx), y = squared_length(dy);
    return T(0.5) * std::log2(x > y ? x : y);
}

template std::array<float, 4> sample_level(const Texture&, const std::array<float, 3>&, float);
template std::array<double, 4> sample_level(const Texture&, const std::array<double, 3>&, double);
template std::array<float, 4> sample_nearest(const Texture&, const std::array<float, 3>&, float);
template std::array<double, 4> sample_nearest(const Texture&, const std::array<double, 3>&, double);
template float level_of_gradients(const Texture&, const std::array<float, 3>&,
                                  const std::array<float, 3>&);
template double level_of_gradients(const Texture&, const std::array<double, 3>&,
                                   const std::array<double, 3>&);

}  // namespace intaglio::ir

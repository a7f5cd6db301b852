// Checks of a texture's sizes, and the encoding of its texels.
#include "src/vulkan/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

namespace intaglio::vulkan {
namespace {

template <typename Integer>
std::vector<std::byte> encode_unorm(const std::vector<float>& level) {
    constexpr double top = static_cast<Integer>(~Integer{0});
    std::vector<std::byte> bytes(level.size() * sizeof(Integer));
    for (std::size_t i = 0; i < level.size(); ++i) {
        const double clamped = level[i] > 0 ? std::min(1.0, static_cast<double>(level[i])) : 0.0;
        const auto step = static_cast<Integer>(std::floor(clamped * top + 0.5));
        std::memcpy(&bytes[i * sizeof(Integer)], &step, sizeof(Integer));
    }
    return bytes;
}

template <typename Integer>
std::vector<float> decode_unorm(std::span<const std::byte> bytes) {
    constexpr double top = static_cast<Integer>(~Integer{0});
    std::vector<float> level(bytes.size() / sizeof(Integer));
    for (std::size_t i = 0; i < level.size(); ++i) {
        Integer step{};
        std::memcpy(&step, &bytes[i * sizeof(Integer)], sizeof(Integer));
        level[i] = static_cast<float>(step / top);
    }
    return level;
}

// IEEE 754 binary16: one sign, five exponent and ten fraction bits, with denormals.
std::uint16_t half_of(float value) {
    const auto sign =
        static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(value) >> 16 & 0x8000);
    if (std::isnan(value)) return sign | 0x7e00;
    const double magnitude = std::fabs(static_cast<double>(value));
    if (magnitude >= 65520) return sign | 0x7c00;  // halfway from the greatest to the next power
    const int exponent = std::max(-14, magnitude > 0 ? std::ilogb(magnitude) : -14);
    // Steps of this exponent, to the nearest even; 1024 and more carry into the exponent field.
    const double steps = std::nearbyint(std::ldexp(magnitude, 10 - exponent));
    const int field = exponent + 14;  // that of a denormal is the same as of the least normal
    return static_cast<std::uint16_t>(sign + field * 1024 + static_cast<int>(steps));
}

float float_of(std::uint16_t half) {
    const int exponent = half >> 10 & 31, fraction = half & 1023;
    float magnitude = exponent == 31 && fraction == 0 ? INFINITY : NAN;
    if (exponent < 31)
        magnitude = exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                  : std::ldexp(static_cast<float>(1024 + fraction), exponent - 25);
    return half & 0x8000 ? -magnitude : magnitude;
}

std::vector<std::byte> encode_half(const std::vector<float>& level) {
    std::vector<std::byte> bytes(level.size() * sizeof(std::uint16_t));
    for (std::size_t i = 0; i < level.size(); ++i) {
        const std::uint16_t half = half_of(level[i]);
        std::memcpy(&bytes[i * sizeof half], &half, sizeof half);
    }
    return bytes;
}

std::vector<float> decode_half(std::span<const std::byte> bytes) {
    std::vector<float> level(bytes.size() / sizeof(std::uint16_t));
    for (std::size_t i = 0; i < level.size(); ++i) {
        std::uint16_t half = 0;
        std::memcpy(&half, &bytes[i * sizeof half], sizeof half);
        level[i] = float_of(half);
    }
    return level;
}

}  // namespace

Status validate(const Texture& texture, const std::string& name) {
    if (texture.width < 1 || texture.height < 1 || texture.depth < 0 || texture.levels.empty()) {
        return input_error(
            "bad-texture",
            fmt::format("texture '{}' is {} by {} texels with {} levels, and needs at "
                        "least one texel and one level",
                        name, texture.width, texture.height, texture.levels.size()));
    }
    for (std::size_t l = 0; l < texture.levels.size(); ++l) {
        const int shift = static_cast<int>(std::min<std::size_t>(l, 30));
        if (l > 0 && (texture.width >> (shift - 1)) <= 1 && (texture.height >> (shift - 1)) <= 1 &&
            (texture.depth >> (shift - 1)) <= 1) {
            return input_error(
                "bad-texture",
                fmt::format(
                    "texture '{}' has {} levels, but level {} is a single texel and the last", name,
                    texture.levels.size(), l - 1));
        }
        const int width = std::max(1, texture.width >> shift),
                  height = std::max(1, texture.height >> shift),
                  depth = std::max(1, texture.depth >> shift);
        const std::size_t expected = 4 * static_cast<std::size_t>(width) *
                                     static_cast<std::size_t>(height) *
                                     static_cast<std::size_t>(depth);
        if (texture.levels[l].size() != expected) {
            const std::string slices =
                texture.depth > 0 ? fmt::format(" by {} slices", depth) : std::string();
            return input_error(
                "bad-texture",
                fmt::format(
                    "level {} of texture '{}' is {} by {} texels{} and needs {} floats, not {}", l,
                    name, width, height, slices, expected, texture.levels[l].size()));
        }
        // The unorm formats store NaN as 0 and Inf as 1.
        const bool is_float = texture.format == Texture::Format::Rgba16Float ||
                              texture.format == Texture::Format::Rgba32Float;
        const auto odd = std::find_if(texture.levels[l].begin(), texture.levels[l].end(),
                                      [](float value) { return !std::isfinite(value); });
        if (is_float && odd != texture.levels[l].end())
            return input_error(
                "bad-texture",
                fmt::format("texture '{}' holds {} at float {} of level {}, which is not a number",
                            name, *odd, odd - texture.levels[l].begin(), l));
    }
    return Done{};
}

std::vector<std::byte> encode(const std::vector<float>& level, Texture::Format format) {
    switch (format) {
        case Texture::Format::Rgba16Float: return encode_half(level);
        case Texture::Format::Rgba8Unorm: return encode_unorm<std::uint8_t>(level);
        case Texture::Format::Rgba16Unorm: return encode_unorm<std::uint16_t>(level);
        case Texture::Format::Rgba32Float: break;
    }
    std::vector<std::byte> bytes(level.size() * sizeof(float));
    std::memcpy(bytes.data(), level.data(), bytes.size());
    return bytes;
}

std::vector<float> decode(std::span<const std::byte> bytes, Texture::Format format) {
    switch (format) {
        case Texture::Format::Rgba8Unorm: return decode_unorm<std::uint8_t>(bytes);
        case Texture::Format::Rgba16Unorm: return decode_unorm<std::uint16_t>(bytes);
        case Texture::Format::Rgba16Float: return decode_half(bytes);
        case Texture::Format::Rgba32Float: break;
    }
    std::vector<float> level(bytes.size() / sizeof(float));
    std::memcpy(level.data(), bytes.data(), level.size() * sizeof(float));
    return level;
}

std::size_t bytes_per_texel(Texture::Format format) {
    switch (format) {
        case Texture::Format::Rgba8Unorm: return 4;
        case Texture::Format::Rgba16Unorm:
        case Texture::Format::Rgba16Float: return 8;
        case Texture::Format::Rgba32Float: break;
    }
    return 16;
}

const char* name_of(Texture::Format format) {
    switch (format) {
        case Texture::Format::Rgba8Unorm: return "RGBA8";
        case Texture::Format::Rgba16Unorm: return "RGBA16";
        case Texture::Format::Rgba16Float: return "RGBA16F";
        case Texture::Format::Rgba32Float: break;
    }
    return "RGBA32F";
}

}  // namespace intaglio::vulkan

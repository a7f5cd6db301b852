// Checks of a texture's sizes, and the encoding of its texels.
#include "src/vulkan/texture.h"

#include <algorithm>
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
    }
    return Done{};
}

std::vector<std::byte> encode(const std::vector<float>& level, Texture::Format format) {
    switch (format) {
        case Texture::Format::Rgba8Unorm: return encode_unorm<std::uint8_t>(level);
        case Texture::Format::Rgba16Unorm: return encode_unorm<std::uint16_t>(level);
        case Texture::Format::Rgba32Float: break;
    }
    std::vector<std::byte> bytes(level.size() * sizeof(float));
    std::memcpy(bytes.data(), level.data(), bytes.size());
    return bytes;
}

}  // namespace intaglio::vulkan

// The three steps of reading: is this a PNG at all, which layout shall libspng deliver, integers to
// floats. Source: PNG specification, second edition (ISO/IEC 15948); https://libspng.org/docs for
// the formats.
#include "src/maps/png.h"

#include <spng.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "src/maps/files.h"

namespace intaglio::maps {
namespace {

using namespace std::string_view_literals;

// No PNG of at most largest_area RGBA texels of 16 bits needs more, even stored without
// compression.
constexpr std::size_t largest_file = std::size_t{1} << 30;
// Text, profiles and other chunks that no map needs: bounded, because they may unpack to any size.
constexpr std::size_t largest_chunk = std::size_t{1} << 26;

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n"sv;
// The last chunk of every PNG, with its length before and its checksum after the name.
constexpr std::string_view png_end = "\0\0\0\0IEND\xae\x42\x60\x82"sv;

struct FreeContext {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, FreeContext>;

struct FreeBuffer {
    void operator()(void* buffer) const { std::free(buffer); }
};

struct KnownStart {
    std::string_view bytes;
    std::string_view name;
};
constexpr KnownStart known_starts[] = {
    {"\xff\xd8\xff"sv, "a JPEG"},   {"GIF8"sv, "a GIF"},       {"BM"sv, "a BMP"},
    {"DDS "sv, "a DDS texture"},    {"II*\0"sv, "a TIFF"},     {"MM\0*"sv, "a TIFF"},
    {"RIFF"sv, "a WebP"},           {"8BPS"sv, "a Photoshop"}, {"\x76\x2f\x31\x01"sv, "an OpenEXR"},
    {"#?RADIANCE"sv, "a Radiance"}, {"\xabKTX"sv, "a KTX"},    {"PK\x03\x04"sv, "a zip"},
    {"\x1f\x8b"sv, "a gzip"},       {"%PDF"sv, "a PDF"},       {"<svg"sv, "an SVG"},
};

bool looks_like_text(std::string_view start) {
    return std::all_of(start.begin(), start.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (byte >= 0x20 && byte != 0x7f) || "\t\r\n\f\v"sv.find(c) != std::string_view::npos;
    });
}

std::string what_it_seems(std::string_view start) {
    const bool text = looks_like_text(start);
    for (const KnownStart& known : known_starts) {
        // Two letters alone may begin a sentence.
        if (text && known.bytes.size() <= 2) continue;
        if (start.substr(0, known.bytes.size()) == known.bytes) {
            return fmt::format("it seems to be {} file", known.name);
        }
    }
    return text ? "it seems to be a text file" : "its first bytes are not those of any known image";
}

Status check_signature(std::span<const unsigned char> bytes) {
    if (bytes.empty()) return input_error("file-empty", "this file is empty");
    const std::string_view start(reinterpret_cast<const char*>(bytes.data()),
                                 std::min<std::size_t>(bytes.size(), 512));
    if (start.substr(0, png_signature.size()) == png_signature) return Done{};
    if (png_signature.substr(0, start.size()) == start) {
        return input_error("png-truncated",
                           fmt::format("this PNG is cut off after {} bytes", start.size()));
    }
    return input_error("not-a-png",
                       fmt::format("this file is not a PNG: {}", what_it_seems(start)));
}

Diagnostic decoding_error(int error) {
    switch (error) {
        case SPNG_IO_EOF:
        case SPNG_EOF:
        case SPNG_EIDAT_TOO_SHORT:
            return input_error("png-truncated", "this PNG is cut off before its end");
        case SPNG_ECHUNK_CRC:
            return input_error("png-corrupt", "this PNG is damaged: a checksum does not match");
        case SPNG_EMEM: return input_error("image-size", "there is not enough memory for this PNG");
        default:
            return input_error("png-corrupt",
                               fmt::format("this PNG is damaged: {}", spng_strerror(error)));
    }
}

// What libspng shall deliver, and which of the delivered channels make the image.
struct Layout {
    int format = SPNG_FMT_PNG;
    int bits = 8;
    std::vector<int> channels;  // of those delivered
    int delivered = 1;
};

// libspng has no gray-with-transparent-colour output for every depth, so those come as RGBA and
// keep red and alpha.
Layout layout_of(const spng_ihdr& header, bool transparent) {
    Layout layout;
    layout.bits = header.bit_depth == 16 ? 16 : 8;
    const int rgba = layout.bits == 16 ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8;
    switch (header.color_type) {
        case SPNG_COLOR_TYPE_GRAYSCALE:
            if (transparent) return {rgba, layout.bits, {0, 3}, 4};
            return {layout.bits == 16 ? SPNG_FMT_PNG : SPNG_FMT_G8, layout.bits, {0}, 1};
        case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA: return {SPNG_FMT_PNG, layout.bits, {0, 1}, 2};
        case SPNG_COLOR_TYPE_INDEXED:
            if (!transparent) return {SPNG_FMT_RGB8, 8, {0, 1, 2}, 3};
            break;
        case SPNG_COLOR_TYPE_TRUECOLOR:
            if (!transparent) return {SPNG_FMT_PNG, layout.bits, {0, 1, 2}, 3};
            break;
        default: break;
    }
    return {rgba, layout.bits, {0, 1, 2, 3}, 4};
}

float texel_value(const unsigned char* raw, std::size_t index, int bits) {
    if (bits == 8) return static_cast<float>(raw[index]) / 255.0f;
    std::uint16_t value = 0;
    std::memcpy(&value, raw + 2 * index, sizeof value);  // libspng: 16 bits in host order
    return static_cast<float>(value) / 65535.0f;
}

Result<Image> decode(spng_ctx* context) {
    spng_ihdr header{};
    if (const int error = spng_get_ihdr(context, &header)) return decoding_error(error);
    if (Status size = check_size(header.width, header.height); !size) return size.error();
    // A chunk that comes too late or not at all is not an error here; a damaged one shows again
    // below.
    spng_trns transparency{};
    const int found = spng_get_trns(context, &transparency);
    if (found != 0 && found != SPNG_ECHUNKAVAIL) return decoding_error(found);

    const Layout layout = layout_of(header, found == 0);
    std::size_t size = 0;
    if (const int error = spng_decoded_image_size(context, layout.format, &size)) {
        return decoding_error(error);
    }
    std::vector<unsigned char> raw(size);
    const int flags = found == 0 ? SPNG_DECODE_TRNS : 0;
    if (const int error = spng_decode_image(context, raw.data(), size, layout.format, flags)) {
        return decoding_error(error);
    }
    if (const int error = spng_decode_chunks(context)) return decoding_error(error);

    Image image = blank_image(static_cast<int>(header.width), static_cast<int>(header.height),
                              static_cast<int>(layout.channels.size()), layout.bits);
    const std::size_t count = image.texels.size() / layout.channels.size();
    float* texel = image.texels.data();
    for (std::size_t i = 0; i < count; ++i) {
        for (const int channel : layout.channels) {
            *texel++ = texel_value(
                raw.data(),
                i * static_cast<std::size_t>(layout.delivered) + static_cast<std::size_t>(channel),
                layout.bits);
        }
    }
    return image;
}

Result<std::vector<PngText>> text_of(spng_ctx* context) {
    std::uint32_t count = 0;
    int error = spng_get_text(context, nullptr, &count);
    std::vector<spng_text> chunks(error == 0 ? count : 0);
    if (error == 0) error = spng_get_text(context, chunks.data(), &count);
    if (error == SPNG_ECHUNKAVAIL) return std::vector<PngText>{};
    if (error != 0) return decoding_error(error);
    std::vector<PngText> text;
    for (const spng_text& chunk : chunks)
        text.push_back({chunk.keyword, std::string(chunk.text, chunk.length)});
    return text;
}

// International text, because names of files are not Latin.  libspng keeps the pointers until it
// has encoded.
int set_text(spng_ctx* context, std::span<const PngText> text) {
    std::vector<spng_text> chunks;
    static char nothing[] = "";
    for (const PngText& entry : text) {
        spng_text& chunk = chunks.emplace_back();
        entry.keyword.copy(chunk.keyword, sizeof chunk.keyword - 1);
        chunk.type = SPNG_ITXT;
        chunk.length = entry.text.size();
        chunk.text = const_cast<char*>(entry.text.c_str());  // only read
        chunk.language_tag = chunk.translated_keyword = nothing;
    }
    if (chunks.empty()) return 0;
    return spng_set_text(context, chunks.data(), static_cast<std::uint32_t>(chunks.size()));
}

std::vector<unsigned char> integers_of(const Image& image) {
    std::vector<unsigned char> raw;
    raw.reserve(image.texels.size() * static_cast<std::size_t>(image.bits / 8));
    for (const float value : image.texels) {
        if (image.bits == 8) {
            raw.push_back(static_cast<unsigned char>(stored_step(value, 8)));
            continue;
        }
        const auto wide = static_cast<std::uint16_t>(stored_step(value, 16));
        std::array<unsigned char, sizeof wide> halves;
        std::memcpy(halves.data(), &wide, sizeof wide);  // libspng: 16 bits in host order
        raw.insert(raw.end(), halves.begin(), halves.end());
    }
    return raw;
}

Diagnostic in_file(Diagnostic error, const std::filesystem::path& path) {
    error.file = path.string();
    return error;
}

}  // namespace

Result<Image> decode_png(std::span<const unsigned char> bytes, std::vector<PngText>* text) {
    if (Status signature = check_signature(bytes); !signature) return signature.error();
    const Context context(spng_ctx_new(0));
    if (!context) return internal_error("png-library", "the PNG library could not be started");
    // libspng's default silently drops an ancillary chunk with a wrong checksum: with tRNS, the
    // heights would go.
    spng_set_crc_action(context.get(), SPNG_CRC_ERROR, SPNG_CRC_ERROR);
    spng_set_chunk_limits(context.get(), largest_chunk, largest_chunk);
    spng_set_png_buffer(context.get(), bytes.data(), bytes.size());
    try {
        Result<Image> image = decode(context.get());
        // libspng lets the last checksum be missing; whoever copies a file wants to know that it
        // was cut.
        const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        if (image.ok() && content.rfind(png_end) == std::string_view::npos) {
            return decoding_error(SPNG_EOF);
        }
        if (image.ok() && text != nullptr) {
            Result<std::vector<PngText>> found = text_of(context.get());
            if (!found) return found.error();
            *text = std::move(*found);
        }
        return image;
    } catch (const std::bad_alloc&) {
        return decoding_error(SPNG_EMEM);
    }
}

Result<std::vector<unsigned char>> encode_png(const Image& image, std::span<const PngText> text) {
    if (Status sound = check_image(image); !sound) return sound.error();
    constexpr std::array<std::uint8_t, 5> colour_types = {
        0, SPNG_COLOR_TYPE_GRAYSCALE, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA, SPNG_COLOR_TYPE_TRUECOLOR,
        SPNG_COLOR_TYPE_TRUECOLOR_ALPHA};
    spng_ihdr header{};
    header.width = static_cast<std::uint32_t>(image.width);
    header.height = static_cast<std::uint32_t>(image.height);
    header.bit_depth = static_cast<std::uint8_t>(image.bits);
    header.color_type = colour_types[static_cast<std::size_t>(image.channels)];

    const Context context(spng_ctx_new(SPNG_CTX_ENCODER));
    if (!context) return internal_error("png-library", "the PNG library could not be started");
    const std::vector<unsigned char> raw = integers_of(image);
    spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
    int error = spng_set_ihdr(context.get(), &header);
    if (error == 0) error = set_text(context.get(), text);
    if (error == 0) {
        error = spng_encode_image(context.get(), raw.data(), raw.size(), SPNG_FMT_PNG,
                                  SPNG_ENCODE_FINALIZE);
    }
    std::size_t size = 0;
    std::unique_ptr<void, FreeBuffer> buffer;
    if (error == 0) buffer.reset(spng_get_png_buffer(context.get(), &size, &error));
    if (error != 0 || !buffer) {
        return internal_error(
            "png-library",
            fmt::format("the PNG library could not write this image: {}", spng_strerror(error)));
    }
    const auto* first = static_cast<const unsigned char*>(buffer.get());
    return std::vector<unsigned char>(first, first + size);
}

Result<Image> read_png(const std::filesystem::path& path, std::vector<PngText>* text) {
    const auto bytes = read_file(path, largest_file);
    if (!bytes) return bytes.error();
    Result<Image> image = decode_png(*bytes, text);
    if (!image) return in_file(image.error(), path);
    return image;
}

Status write_png(const std::filesystem::path& path, const Image& image,
                 std::span<const PngText> text) {
    const auto bytes = encode_png(image, text);
    if (!bytes) return in_file(bytes.error(), path);
    return write_file(path, *bytes);
}

}  // namespace intaglio::maps

// libpng's row interface.  An error in here is a bug of the tests: libpng then prints it and
// aborts.
#include "tests/unit/maps/png_witness.h"

#include <png.h>

#include <bit>
#include <cstring>

namespace intaglio::maps::witness {
namespace {

void append(png_structp png, png_bytep data, png_size_t size) {
    auto& bytes = *static_cast<std::vector<unsigned char>*>(png_get_io_ptr(png));
    bytes.insert(bytes.end(), data, data + size);
}

void consume(png_structp png, png_bytep data, png_size_t size) {
    auto& rest = *static_cast<std::span<const unsigned char>*>(png_get_io_ptr(png));
    if (rest.size() < size) png_error(png, "the witness was given a PNG that ends early");
    std::memcpy(data, rest.data(), size);
    rest = rest.subspan(size);
}

void set_transparency(png_structp png, png_infop info, const Png& source) {
    if (!source.palette_alpha.empty()) {
        png_set_tRNS(png, info, source.palette_alpha.data(),
                     static_cast<int>(source.palette_alpha.size()), nullptr);
    }
    if (source.transparent.empty()) return;
    png_color_16 colour{};
    colour.gray = source.transparent[0];
    if (source.transparent.size() == 3) {
        colour.red = source.transparent[0];
        colour.green = source.transparent[1];
        colour.blue = source.transparent[2];
    }
    png_set_tRNS(png, info, nullptr, 0, &colour);
}

}  // namespace

int Png::channels() const {
    switch (colour_type) {
        case PNG_COLOR_TYPE_RGB: return 3;
        case PNG_COLOR_TYPE_GRAY_ALPHA: return 2;
        case PNG_COLOR_TYPE_RGB_ALPHA: return 4;
        default: return 1;
    }
}

std::vector<unsigned char> written(const Png& source) {
    std::vector<unsigned char> bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &bytes, append, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(source.width),
                 static_cast<png_uint_32>(source.height), source.depth, source.colour_type,
                 source.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    std::vector<png_color> palette(source.palette.size() / 3);
    for (std::size_t i = 0; i < palette.size(); ++i) {
        palette[i] = {source.palette[3 * i], source.palette[3 * i + 1], source.palette[3 * i + 2]};
    }
    if (!palette.empty()) {
        png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    }
    set_transparency(png, info, source);
    png_write_info(png, info);
    if (source.depth < 8) png_set_packing(png);  // one sample per byte in the rows below
    if (source.depth == 16 && std::endian::native == std::endian::little) png_set_swap(png);

    const auto width = static_cast<std::size_t>(source.width * source.channels());
    const auto sample_size = static_cast<std::size_t>(source.depth == 16 ? 2 : 1);
    std::vector<unsigned char> raw(source.samples.size() * sample_size);
    for (std::size_t i = 0; i < source.samples.size(); ++i) {
        if (sample_size == 1)
            raw[i] = static_cast<unsigned char>(source.samples[i]);
        else
            std::memcpy(&raw[2 * i], &source.samples[i], 2);
    }
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < static_cast<std::size_t>(source.height); ++y) {
        rows.push_back(&raw[y * width * sample_size]);
    }
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

std::vector<unsigned char> header_only(int width, int height) {
    std::vector<unsigned char> bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
    png_set_write_fn(png, &bytes, append, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

Png read(std::span<const unsigned char> bytes) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_read_fn(png, &bytes, consume);
    png_read_info(png, info);
    Png result;
    result.width = static_cast<int>(png_get_image_width(png, info));
    result.height = static_cast<int>(png_get_image_height(png, info));
    result.colour_type = png_get_color_type(png, info);
    result.depth = png_get_bit_depth(png, info);
    if (result.depth == 16 && std::endian::native == std::endian::little) png_set_swap(png);
    const std::size_t row_size = png_get_rowbytes(png, info);
    std::vector<unsigned char> raw(row_size * static_cast<std::size_t>(result.height));
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < static_cast<std::size_t>(result.height); ++y) {
        rows.push_back(&raw[y * row_size]);
    }
    png_read_image(png, rows.data());
    png_read_end(png, nullptr);
    png_destroy_read_struct(&png, &info, nullptr);

    const std::size_t sample_size = result.depth == 16 ? 2 : 1;
    result.samples.resize(raw.size() / sample_size);
    for (std::size_t i = 0; i < result.samples.size(); ++i) {
        if (sample_size == 1)
            result.samples[i] = raw[i];
        else
            std::memcpy(&result.samples[i], &raw[2 * i], 2);
    }
    return result;
}

}  // namespace intaglio::maps::witness

// One case: its picture, the map of its errors, and one of its pixels in words.
#include "src/cli/run_case.h"

#include <charconv>

#include <fmt/format.h>

#include "src/maps/png.h"
#include "src/measure/laboratory.h"
#include "src/report/picture.h"

namespace intaglio::cli {
namespace {

struct Pixel {
    int x, y;
};

// "12,40", within the picture.
Result<Pixel> parse_pixel(const std::string& text, int size) {
    Pixel pixel{};
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, pixel.x);
    const bool comma = first.ec == std::errc() && first.ptr != end && *first.ptr == ',';
    const auto second = comma ? std::from_chars(first.ptr + 1, end, pixel.y)
                              : std::from_chars_result{end, std::errc::invalid_argument};
    if (second.ec != std::errc() || second.ptr != end || pixel.x < 0 || pixel.y < 0 ||
        pixel.x >= size || pixel.y >= size)
        return input_error(
            "option-value",
            fmt::format("'{}' is no pixel of the form 12,40, each 0 to {}", text, size - 1));
    return pixel;
}

Result<measure::Case> case_of(const RunOptions& options) {
    if (options.mesh != "map" || options.geometry != "polygon" || !options.variant.split.empty())
        return input_error("option-value",
                           "--arithmetic and --pixel are of a whole map in one pass: --mesh map "
                           "and neither --geometry nor --split");
    if (options.view.light_elevation.size() > 1 || options.view.light_azimuth.size() > 1)
        return input_error("option-value",
                           "--arithmetic and --pixel aim the first light alone: give one "
                           "--light-elevation and --light-azimuth");
    const Result<Size> size = parse_size(options.size);
    if (!size) return size.error();
    if (size->width != size->height)
        return input_error("option-value",
                           "--arithmetic and --pixel are of square pictures: --size 256x256");
    Result<VariantRequest> request = request_of(options.variant);
    if (!request) return request.error();
    const Result<measure::Filtering> filtering = filtering_of(options.map.filtering);
    if (!filtering) return filtering.error();
    const Result<measure::Arithmetic> arithmetic = measure::arithmetic_named(options.arithmetic);
    if (!arithmetic) return arithmetic.error();
    return measure::Case{std::move(*request),  {options.view.elevation, options.view.azimuth},
                         options.view.light(), options.map.scale,
                         size->width,          *filtering,
                         *arithmetic,          0};
}

void print_pixel(const measure::WorstPixel& pixel) {
    fmt::print(stderr,
               "pixel ({}, {}): the ray enters at uv ({}), towards the eye ({})\n"
               "  exact hit at uv and height ({}), reported ({}): {} texels off{}\n",
               pixel.x, pixel.y, fmt::join(pixel.uv, ", "), fmt::join(pixel.view, ", "),
               fmt::join(pixel.exact, ", "), fmt::join(pixel.reported, ", "), pixel.texels,
               pixel.missed ? ", behind a feature that it went through" : "");
}

}  // namespace

bool is_case(const RunOptions& options) {
    return options.arithmetic != "fp32" || !options.pixel.empty();
}

Status write_error_map(const std::vector<measure::HitError>& errors, const std::string& path,
                       int width) {
    const measure::HitStatistics s = measure::summarize(errors, width);
    fmt::print(stderr,
               "hit error in texels: median {:.3g}, p95 {:.3g}, p99 {:.3g}, max {:.3g} at pixel "
               "({}, {}); missed {} of {}; NaN {}\n",
               s.median, s.p95, s.p99, s.max, s.worst_x, s.worst_y, s.missed, s.pixels, s.invalid);
    return maps::write_png(path, report::error_map(errors, width));
}

Status run_case(const dsl::Catalogue& catalogue, const RunOptions& options) {
    const Result<measure::Case> what = case_of(options);
    if (!what) return what.error();
    const Result<Pixel> pixel =
        parse_pixel(options.pixel.empty() ? "0,0" : options.pixel, what->size);
    if (!pixel) return pixel.error();
    Result<measure::MapSet> set = map_set_of(options.map);
    if (!set) return set.error();
    measure::CaseMap map;
    map.set = std::move(*set);
    map.hash = measure::content_hash(map.set);
    Result<measure::Laboratory> laboratory =
        measure::Laboratory::create(catalogue, {options.view.device, options.validation, 0});
    if (!laboratory) return laboratory.error();
    const Result<measure::CaseHits> hits = laboratory->hits(*what, map);
    if (!hits) return hits.error();
    if (!options.pixel.empty())
        print_pixel(measure::pixel_of(*hits, what->view, pixel->x, pixel->y));
    if (!options.error_map.empty())
        if (Status status = write_error_map(hits->errors, options.error_map, what->size); !status)
            return status;
    const auto pictures = laboratory->pictures(*what, map);
    if (!pictures) return pictures.error();
    return maps::write_png(options.output, report::to_image(pictures->drawn));
}

}  // namespace intaglio::cli

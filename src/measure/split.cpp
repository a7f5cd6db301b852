// Passes drawn through pictures of every format.
#include "src/measure/split.h"

#include <algorithm>
#include <cmath>

#include "generator/base/nearest.h"

namespace intaglio::measure {
namespace {

using Format = vulkan::Texture::Format;

// Offsets as hit - uv, coded, decoded and added to uv again: a few roundings of numbers below 2.
constexpr double float_roundings = 0x1p-21;

// A picture as the next pass reads it: the device stores again what it stored before.
vulkan::Texture texture_of(const vulkan::Picture& picture, Format format) {
    vulkan::Texture texture;
    texture.width = picture.width;
    texture.height = picture.height;
    texture.levels.resize(1);
    for (const std::array<float, 4>& pixel : picture.pixels)
        texture.levels[0].insert(texture.levels[0].end(), pixel.begin(), pixel.end());
    texture.filter = texture.mip_filter = vulkan::Texture::Filter::Nearest;
    texture.wrap = vulkan::Texture::Wrap::Clamp;
    texture.format = format;
    return texture;
}

double percentile(const std::vector<double>& sorted, double share) {
    if (sorted.empty()) return 0;
    return sorted[static_cast<std::size_t>(
        std::llround(share * static_cast<double>(sorted.size() - 1)))];
}

void compare_displaced(FormatError& error, const vulkan::Picture& expected,
                       const vulkan::Picture& actual, const SplitDraw& draw) {
    std::vector<double> texels;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const std::array<float, 4>&a = expected.pixels[i], &b = actual.pixels[i];
        if (draw.background && a == *draw.background) continue;
        texels.push_back(std::hypot((b[0] - a[0]) * static_cast<float>(draw.map_width),
                                    (b[1] - a[1]) * static_cast<float>(draw.map_height)));
        error.beyond += !(texels.back() <= error.bound);
        error.height_max = std::max(error.height_max, std::fabs(static_cast<double>(b[2]) - a[2]));
        error.visibility_changed += std::fabs(b[3] - a[3]) > 0.5f;
    }
    error.pixels = static_cast<std::int64_t>(texels.size());
    std::sort(texels.begin(), texels.end());
    error.median = percentile(texels, 0.5);
    error.p99 = percentile(texels, 0.99);
    error.max = texels.empty() ? 0 : texels.back();
}

void compare_colours(FormatError& error, const vulkan::Picture& expected,
                     const vulkan::Picture& actual) {
    double squares = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const double difference =
                static_cast<double>(actual.pixels[i][k]) - expected.pixels[i][k];
            error.colour_max = std::max(error.colour_max, std::fabs(difference));
            squares += difference * difference;
        }
    error.colour_rms =
        std::sqrt(squares / std::max(1.0, 3.0 * static_cast<double>(expected.pixels.size())));
}

// A surface drawn as it is measured: unsplit where that has the same steps.
Result<vulkan::Picture> draw_yardstick(const dsl::Catalogue& catalogue, const SplitDraw& draw,
                                       const std::vector<check::Program>& passes) {
    if (draw.request.split.sections > 1)
        return draw_passes(passes, offset_code(Format::Rgba32Float, draw.range), draw.prepare);
    VariantRequest whole = draw.request;
    whole.split = {};
    whole.pass = 0;
    const Result<std::vector<check::Program>> one = link_passes(catalogue, whole);
    if (!one) return one.error();
    return draw_passes(*one, offset_code(Format::Rgba32Float, draw.range), draw.prepare);
}

// One output of the surface: its passes, and what they should draw.
struct Drawn {
    std::vector<check::Program> passes;
    vulkan::Picture yardstick;
};

Result<Drawn> draw_output(const dsl::Catalogue& catalogue, SplitDraw draw,
                          std::string_view output) {
    if (!output.empty())
        draw.request.surface = dsl::with_part(draw.request.surface, "output", output);
    Result<std::vector<check::Program>> passes = link_passes(catalogue, draw.request);
    if (!passes) return passes.error();
    Result<vulkan::Picture> yardstick = draw_yardstick(catalogue, draw, *passes);
    if (!yardstick) return yardstick.error();
    return Drawn{std::move(*passes), std::move(*yardstick)};
}

// `each` gets the displaced coordinates of every format, to compare them further.
Result<std::vector<FormatError>> compare(
    const dsl::Catalogue& catalogue, const SplitDraw& draw, const std::vector<Format>& formats,
    const std::function<void(FormatError&, const vulkan::Picture&)>& each) {
    const Result<Drawn> displaced = draw_output(catalogue, draw, "displaced");
    if (!displaced) return displaced.error();
    const Result<Drawn> colours = draw_output(catalogue, draw, "colour");
    if (!colours) return colours.error();
    std::vector<FormatError> errors;
    for (const Format format : formats) {
        FormatError error;
        error.code = offset_code(format, draw.range);
        error.bound = (error.code.error + float_roundings) *
                      std::hypot(static_cast<double>(draw.map_width), draw.map_height);
        const auto hits = draw_passes(displaced->passes, error.code, draw.prepare);
        if (!hits) return hits.error();
        compare_displaced(error, displaced->yardstick, *hits, draw);
        each(error, *hits);
        const auto shaded = draw_passes(colours->passes, error.code, draw.prepare);
        if (!shaded) return shaded.error();
        compare_colours(error, colours->yardstick, *shaded);
        errors.push_back(error);
    }
    return errors;
}

// Steps of a unorm format on either side of the one that stands for 0.
OffsetCode unorm_code(Format format, double range, double steps) {
    const double top = 2 * steps + 1, zero = steps + 1;
    return {format,
            range,
            {static_cast<float>(steps / (range * top)), static_cast<float>(zero / top)},
            {static_cast<float>(range * top / steps), static_cast<float>(-range * zero / steps)},
            range / steps / 2};
}

}  // namespace

OffsetCode offset_code(Format format, double range) {
    switch (format) {
        case Format::Rgba8Unorm: return unorm_code(format, range, 127);
        case Format::Rgba16Unorm: return unorm_code(format, range, 32767);
        case Format::Rgba16Float: return {format, range, {1, 0}, {1, 0}, range * 0x1p-10};
        case Format::Rgba32Float: break;
    }
    return {format, range, {1, 0}, {1, 0}, 0};
}

double offset_range(Direction view, double scale) {
    const std::array<float, 3> v = vector_of(view);
    const double slope = static_cast<double>(std::max(std::fabs(v[0]), std::fabs(v[1]))) /
                         std::max(static_cast<double>(v[2]), 1.0 / 1024);
    // Straight down there are no offsets, and a scale of 0 has none at all: any range does.
    return std::max(slope * scale, 0x1p-10);
}

const std::vector<Format>& pass_formats() {
    static const std::vector<Format> all = {Format::Rgba8Unorm, Format::Rgba16Unorm,
                                            Format::Rgba16Float, Format::Rgba32Float};
    return all;
}

Result<Format> format_named(const std::string& name) {
    const std::vector<std::string> names = {"rgba8", "rgba16", "rgba16f", "rgba32f"};
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        return input_error(
            "format", unknown_name_sentence("format of the picture between passes", name, names));
    return pass_formats()[static_cast<std::size_t>(found - names.begin())];
}

Result<std::vector<check::Program>> link_passes(const dsl::Catalogue& catalogue,
                                                const VariantRequest& request) {
    std::vector<check::Program> programs;
    for (int pass = 1; pass <= dsl::pass_count(request.split); ++pass) {
        VariantRequest one = request;
        one.pass = pass;
        const Result<Variant> variant = make_variant(catalogue, one);
        if (!variant) return variant.error();
        Result<check::Program> program = link_variant(*variant);
        if (!program) return program.error();
        programs.push_back(std::move(*program));
    }
    return programs;
}

Result<vulkan::Picture> draw_passes(const std::vector<check::Program>& passes,
                                    const OffsetCode& code, const PreparePass& prepare) {
    PassLink link;
    // Vulkan's clip space and its pictures have row 0 at y = -1 and v = 0 alike.
    link.uniforms = {{"pixel_place", {0.5f, 0.5f, 0.5f, 0.5f}},
                     {"offset_to_colour", {code.to_colour.begin(), code.to_colour.end()}},
                     {"colour_to_offset", {code.to_offset.begin(), code.to_offset.end()}}};
    vulkan::Texture before;
    for (std::size_t pass = 0;; ++pass) {
        const bool last = pass + 1 == passes.size();
        link.target = last ? Format::Rgba32Float : code.format;
        link.before = pass == 0 ? nullptr : &before;
        Result<vulkan::Program> program = prepare(passes[pass], link);
        if (!program) return program.error();
        Result<std::vector<vulkan::Picture>> pictures = program->draw();
        if (!pictures) return pictures.error();
        if (last) return std::move(pictures->front());
        before = texture_of(pictures->front(), code.format);
    }
}

Result<std::vector<FormatError>> compare_formats(const dsl::Catalogue& catalogue,
                                                 const SplitDraw& draw,
                                                 const std::vector<Format>& formats) {
    return compare(catalogue, draw, formats, [](FormatError&, const vulkan::Picture&) {});
}

PreparePass prepare_shot(const vulkan::Device& device, const Textures& textures, const Shot& shot) {
    return [&](const check::Program& shaders, const PassLink& link) -> Result<vulkan::Program> {
        Result<vulkan::Program> program = prepare_quad(device, shaders, textures, shot.scale,
                                                       shot.width, shot.height, shot.look, link);
        if (!program) return program;
        if (Status status = aim(*program, shot.view, shot.light); !status) return status.error();
        return program;
    };
}

double shot_range(const Shot& shot) {
    return shot.range > 0 ? shot.range : offset_range(shot.view, shot.scale);
}

Result<std::vector<FormatError>> shot_formats(const vulkan::Device& device,
                                              const dsl::Catalogue& catalogue,
                                              const VariantRequest& request, const MapSet& set,
                                              const Textures& textures, const Shot& shot,
                                              const std::vector<Format>& formats) {
    const SplitDraw draw{request, shot_range(shot), textures.height.width, textures.height.height,
                         prepare_shot(device, textures, shot)};
    const reference::HeightField field = set.height_field(reference::FilterWeights::Exact);
    const float scale = static_cast<float>(shot.scale);
    const ExactPicture exact =
        trace_exact(field, shot.view, shot.light, scale, shot.width, shot.height);
    return compare(catalogue, draw, formats, [&](FormatError& error, const vulkan::Picture& hits) {
        error.hits = summarize(compare_hits(hits, exact, field, shot.view, scale), shot.width);
    });
}

}  // namespace intaglio::measure

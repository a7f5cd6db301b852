// `intaglio bake`: a map made from a height map, as one PNG.  Levels, images and slices of more
// than one lie below each other (docs/maps.md).
#include "src/cli/bake.h"

#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "src/cli/commands.h"
#include "src/maps/bake.h"
#include "src/maps/bake_cone.h"
#include "src/maps/bake_distance.h"
#include "src/maps/bake_horizon.h"
#include "src/maps/bake_max_mip.h"
#include "src/maps/bake_phong.h"
#include "src/maps/bake_summit.h"
#include "src/maps/bake_view_dependent.h"
#include "src/maps/png.h"

namespace intaglio::cli {
namespace {

struct Options {
    std::string input, output;
    double scale = 0.08;
    std::string kernel = "central";  // central, sobel
    std::string wrap = "repeat";     // repeat, clamp
    bool keep_height = false;
    std::string size;  // of a volume's slices, or the side of a phong map
    int slices = 32, views = 9, azimuths = 8;
    double shininess = 32;
};

using Heights = const maps::Image&;

Result<maps::Image> normals(Heights heights, const Options& options) {
    if (options.kernel != "central" && options.kernel != "sobel")
        return input_error("option-value",
                           fmt::format("--kernel is central or sobel, not '{}'", options.kernel));
    if (options.wrap != "repeat" && options.wrap != "clamp")
        return input_error("option-value",
                           fmt::format("--wrap is repeat or clamp, not '{}'", options.wrap));
    Result<maps::Image> made = maps::bake_normal(
        heights, options.scale,
        options.kernel == "central" ? maps::NormalKernel::Central : maps::NormalKernel::Sobel,
        options.wrap == "repeat" ? maps::Wrap::Repeat : maps::Wrap::Clamp);
    if (made && options.keep_height) made = maps::with_height_in_alpha(*made, heights);
    return made;
}

Result<maps::Image> below_each_other(const Result<std::vector<maps::Image>>& images) {
    if (!images) return images.error();
    return maps::stacked(*images);
}

Result<maps::Image> slices_of(Result<maps::Volume> volume) {
    if (!volume) return volume.error();
    return std::move(volume->slices);
}

Result<maps::Image> distances(Heights heights, const Options& options) {
    const Result<Size> size = parse_size(options.size);
    if (!size) return size.error();
    return slices_of(maps::bake_distance(heights, size->width, size->height, options.slices));
}

Result<maps::Image> views(Heights heights, const Options& options) {
    const Result<Size> size = parse_size(options.size);
    if (!size) return size.error();
    return slices_of(maps::bake_view_dependent(heights, size->width, size->height, options.views));
}

using Bake = std::function<Result<maps::Image>(Heights, const Options&)>;

Status bake_file(const Options& options, const Bake& bake) {
    const Result<maps::Image> source = maps::read_png(options.input);
    if (!source) return source.error();
    const Result<maps::Image> heights = maps::heights_of(*source, maps::HeightSource::Automatic);
    if (!heights) return heights.error();
    const Result<maps::Image> made = bake(*heights, options);
    if (!made) return made.error();
    return maps::write_png(options.output, *made);
}

Status bake_phong_file(const Options& options) {
    const Result<Size> size = parse_size(options.size);
    if (!size) return size.error();
    if (size->width != size->height)
        return input_error("option-value", "a phong map is square: --size 256x256");
    const Result<maps::Image> made = maps::bake_phong(options.shininess, size->width);
    if (!made) return made.error();
    return maps::write_png(options.output, *made);
}

CLI::App* add_kind(CLI::App& bake, const char* name, const char* sentence, Options& options) {
    CLI::App* kind = bake.add_subcommand(name, sentence);
    kind->add_option("-o,--output", options.output, "PNG file")->required();
    return kind;
}

}  // namespace

void add_bake(CLI::App& app, std::function<Status()>& chosen) {
    CLI::App* command = app.add_subcommand("bake", "Maps made from a height map");
    command->require_subcommand(1);
    // A kind of map that is made of heights.
    const auto from_heights = [&](const char* name, const char* sentence, const Bake& bake) {
        auto options = std::make_shared<Options>();
        CLI::App* kind = add_kind(*command, name, sentence, *options);
        kind->add_option("input", options->input, "Height map, PNG")->required();
        kind->callback([&chosen, options, bake] {
            chosen = [options, bake] { return bake_file(*options, bake); };
        });
        return std::pair{kind, options};
    };
    {
        const auto [kind, options] = from_heights(
            "normal", "Tangent-space normals, y along +v (downwards in the picture)", normals);
        kind->add_option("--scale", options->scale, "Depth of the relief in texture units")
            ->capture_default_str();
        kind->add_option("--kernel", options->kernel, "central or sobel")->capture_default_str();
        kind->add_option("--wrap", options->wrap, "repeat or clamp")->capture_default_str();
        kind->add_flag("--keep-height", options->keep_height, "Heights in the alpha channel");
    }
    from_heights("cone", "Heights, and in alpha how wide a cone over each texel is empty",
                 [](Heights heights, const Options&) {
                     return maps::bake_cone(heights, maps::ConeKind::Empty);
                 });
    from_heights("relaxed-cone", "The same for cones that a ray enters the relief in at most once",
                 [](Heights heights, const Options&) {
                     return maps::bake_cone(heights, maps::ConeKind::Relaxed);
                 });
    from_heights("max-mip", "Highest and lowest points by quadtree, levels below each other",
                 [](Heights heights, const Options&) {
                     return below_each_other(maps::bake_max_mip(heights));
                 });
    from_heights("summit", "Highest points of squares around each patch, levels below each other",
                 [](Heights heights, const Options&) {
                     return below_each_other(maps::bake_summit(heights));
                 });
    from_heights("patch", "The four heights at the corners of each patch",
                 [](Heights heights, const Options&) { return maps::bake_patch(heights); });
    {
        const auto [kind, options] =
            from_heights("horizon", "How high the relief stands around each texel, by azimuth",
                         [](Heights heights, const Options& given) {
                             return below_each_other(maps::bake_horizon(heights, given.azimuths));
                         });
        kind->add_option("--azimuths", options->azimuths, "A multiple of 4, four to an image")
            ->capture_default_str();
    }
    {
        const auto [kind, options] = from_heights(
            "distance", "How large a ball is empty around each point, slices below each other",
            distances);
        options->size = "256x256";
        kind->add_option("--size", options->size, "Of a slice, at most the map's")
            ->capture_default_str();
        kind->add_option("--slices", options->slices, "From height 0 to 1")->capture_default_str();
    }
    {
        const auto [kind, options] =
            from_heights("view-dependent",
                         "Where each view ray meets the relief, slices below each other", views);
        options->size = "128x128";
        kind->add_option("--size", options->size, "Of a slice, at most the map's")
            ->capture_default_str();
        kind->add_option("--views", options->views, "Directions along an axis")
            ->capture_default_str();
    }
    auto options = std::make_shared<Options>();
    options->size = "256x256";
    CLI::App* phong = add_kind(*command, "phong",
                               "Brightness by direction, which no height map is for", *options);
    phong->add_option("--size", options->size, "Of the map, square")->capture_default_str();
    phong->add_option("--shininess", options->shininess, "Exponent of the highlight")
        ->capture_default_str();
    phong->callback(
        [&chosen, options] { chosen = [options] { return bake_phong_file(*options); }; });
}

}  // namespace intaglio::cli

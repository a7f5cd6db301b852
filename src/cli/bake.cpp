// `intaglio bake`: a map made from a height map, as one PNG that says where it comes from.  Levels,
// images and slices of more than one lie below each other (docs/maps.md).
#include "src/cli/bake.h"

#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "src/cli/commands.h"
#include "src/cli/progress.h"
#include "src/maps/bake.h"
#include "src/maps/bake_cone.h"
#include "src/maps/bake_distance.h"
#include "src/maps/bake_horizon.h"
#include "src/maps/bake_max_mip.h"
#include "src/maps/bake_phong.h"
#include "src/maps/bake_summit.h"
#include "src/maps/bake_view_dependent.h"
#include "src/maps/makers.h"
#include "src/maps/png.h"
#include "src/maps/provenance.h"

namespace intaglio::cli {
namespace {

struct Options {
    std::string input, maker, output;
    std::string map_size = "256x256";  // of a procedural map
    std::uint32_t seed = 1;            // of a procedural map
    int threads = 0;                   // 0: as many as the machine has
    double scale = 0.08;
    std::string kernel = "central";  // central, sobel
    std::string wrap = "repeat";     // repeat, clamp
    bool keep_height = false;
    std::string size;  // of a volume's slices, or the side of a phong map
    int slices = 32, views = 9, azimuths = 8;
    double shininess = 32;
};

using Heights = const maps::Image&;
using maps::Work;

Result<maps::Image> normals(Heights heights, const Options& options, const Work& work) {
    if (options.kernel != "central" && options.kernel != "sobel")
        return input_error("option-value",
                           fmt::format("--kernel is central or sobel, not '{}'", options.kernel));
    if (options.wrap != "repeat" && options.wrap != "clamp")
        return input_error("option-value",
                           fmt::format("--wrap is repeat or clamp, not '{}'", options.wrap));
    Result<maps::Image> made = maps::bake_normal(
        heights, options.scale,
        options.kernel == "central" ? maps::NormalKernel::Central : maps::NormalKernel::Sobel,
        options.wrap == "repeat" ? maps::Wrap::Repeat : maps::Wrap::Clamp, work);
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

Result<maps::Image> distances(Heights heights, const Options& options, const Work& work) {
    const Result<Size> size = parse_size(options.size);
    if (!size) return size.error();
    return slices_of(maps::bake_distance(heights, size->width, size->height, options.slices, work));
}

Result<maps::Image> views(Heights heights, const Options& options, const Work& work) {
    const Result<Size> size = parse_size(options.size);
    if (!size) return size.error();
    return slices_of(
        maps::bake_view_dependent(heights, size->width, size->height, options.views, work));
}

// A kind of map that is made of heights.
struct Kind {
    const char* name;
    const char* sentence;
    std::function<Result<maps::Image>(Heights, const Options&, const Work&)> bake;
    // What shaped the map.
    std::function<maps::BakeSettings(const Options&)> settings = [](const Options&) {
        return maps::BakeSettings{};
    };
    const char* filter = "linear";
};

// The heights, and what they are called in the map made of them.
struct Source {
    maps::Image heights;
    std::string name;
};

Result<Source> source_of(const Options& options) {
    if (options.input.empty() && options.maker.empty())
        return input_error("no-map",
                           "a height map is needed: IN.png, or --maker NAME for a "
                           "procedural one");
    if (!options.input.empty()) {
        const Result<maps::Image> image = maps::read_png(options.input);
        if (!image) return image.error();
        Result<maps::Image> heights = maps::heights_of(*image, maps::HeightSource::Automatic);
        if (!heights) return heights.error();
        return Source{std::move(*heights),
                      std::filesystem::path(options.input).filename().string()};
    }
    const Result<Size> size = parse_size(options.map_size);
    if (!size) return size.error();
    Result<maps::Image> heights =
        maps::make_height_map(options.maker, size->width, size->height, options.seed);
    if (!heights) return heights.error();
    return Source{std::move(*heights),
                  measure::maker_arguments(options.maker, size->width, size->height, options.seed)};
}

Status bake_file(const Options& options, const Kind& kind) {
    const Result<Source> source = source_of(options);
    if (!source) return source.error();
    const Result<maps::Image> made = [&] {
        ProgressLine progress("baked", "rows");
        return kind.bake(source->heights, options, {options.threads, std::ref(progress)});
    }();
    if (!made) return made.error();
    return maps::write_baked(options.output, *made,
                             {kind.name, kind.settings(options), kind.filter,
                              maps::fingerprint(source->heights), source->name});
}

Status bake_phong_file(const Options& options) {
    const Result<Size> size = parse_size(options.size);
    if (!size) return size.error();
    if (size->width != size->height)
        return input_error("option-value", "a phong map is square: --size 256x256");
    const Result<maps::Image> made = maps::bake_phong(options.shininess, size->width);
    if (!made) return made.error();
    return maps::write_baked(
        options.output, *made,
        {"phong", {{"shininess", fmt::format("{}", options.shininess)}, {"size", options.size}}});
}

CLI::App* add_kind(CLI::App& bake, const char* name, const char* sentence, Options& options) {
    CLI::App* kind = bake.add_subcommand(name, sentence);
    kind->add_option("-o,--output", options.output, "PNG file")->required();
    return kind;
}

// The kind with what all kinds made of heights are given.
std::pair<CLI::App*, std::shared_ptr<Options>> add_from_heights(CLI::App& bake,
                                                                std::function<Status()>& chosen,
                                                                const Kind& kind) {
    auto options = std::make_shared<Options>();
    CLI::App* command = add_kind(bake, kind.name, kind.sentence, *options);
    CLI::Option* input = command->add_option("input", options->input, "Height map, PNG");
    command
        ->add_option("--maker", options->maker,
                     "Procedural map in place of a file; see `intaglio list maps`")
        ->excludes(input);
    command->add_option("--map-size", options->map_size, "Size of a procedural map")
        ->capture_default_str();
    command->add_option("--seed", options->seed, "Of a procedural map")->capture_default_str();
    command
        ->add_option("-j,--threads", options->threads, "Rows at once; 0: as the machine has cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 256));
    command->callback([&chosen, options, kind] {
        chosen = [options, kind] { return bake_file(*options, kind); };
    });
    return {command, options};
}

}  // namespace

void add_bake(CLI::App& app, std::function<Status()>& chosen) {
    CLI::App* command = app.add_subcommand("bake", "Maps made from a height map");
    command->require_subcommand(1);
    const auto from_heights = [&](const Kind& kind) {
        return add_from_heights(*command, chosen, kind);
    };
    {
        const auto [kind, options] = from_heights(
            {"normal", "Tangent-space normals, y along +v (downwards in the picture)", normals,
             [](const Options& given) {
                 return maps::BakeSettings{{"scale", fmt::format("{}", given.scale)},
                                           {"kernel", given.kernel},
                                           {"wrap", given.wrap},
                                           {"keep-height", given.keep_height ? "yes" : "no"}};
             }});
        kind->add_option("--scale", options->scale, "Depth of the relief in texture units")
            ->capture_default_str();
        kind->add_option("--kernel", options->kernel, "central or sobel")->capture_default_str();
        kind->add_option("--wrap", options->wrap, "repeat or clamp")->capture_default_str();
        kind->add_flag("--keep-height", options->keep_height, "Heights in the alpha channel");
    }
    from_heights({"cone", "Heights, and in alpha how wide a cone over each texel is empty",
                  [](Heights heights, const Options&, const Work& work) {
                      return maps::bake_cone(heights, maps::ConeKind::Empty, work);
                  }});
    from_heights({"relaxed-cone", "The same for cones that a ray enters the relief in at most once",
                  [](Heights heights, const Options&, const Work& work) {
                      return maps::bake_cone(heights, maps::ConeKind::Relaxed, work);
                  }});
    from_heights({"max-mip", "Highest and lowest points by quadtree, levels below each other",
                  [](Heights heights, const Options&, const Work&) {
                      return below_each_other(maps::bake_max_mip(heights));
                  },
                  [](const Options&) { return maps::BakeSettings{}; }, "nearest"});
    from_heights({"summit", "Highest points of squares around each patch, levels below each other",
                  [](Heights heights, const Options&, const Work&) {
                      return below_each_other(maps::bake_summit(heights));
                  },
                  [](const Options&) { return maps::BakeSettings{}; }, "nearest"});
    from_heights(
        {"patch", "The four heights at the corners of each patch",
         [](Heights heights, const Options&, const Work&) { return maps::bake_patch(heights); },
         [](const Options&) { return maps::BakeSettings{}; }, "nearest"});
    {
        const auto [kind, options] = from_heights(
            {"horizon", "How high the relief stands around each texel, by azimuth",
             [](Heights heights, const Options& given, const Work& work) {
                 return below_each_other(maps::bake_horizon(heights, given.azimuths, work));
             },
             [](const Options& given) {
                 return maps::BakeSettings{{"azimuths", fmt::format("{}", given.azimuths)}};
             }});
        kind->add_option("--azimuths", options->azimuths, "A multiple of 4, four to an image")
            ->capture_default_str();
    }
    {
        const auto [kind, options] = from_heights(
            {"distance", "How large a ball is empty around each point, slices below each other",
             distances,
             [](const Options& given) {
                 return maps::BakeSettings{{"size", given.size},
                                           {"slices", fmt::format("{}", given.slices)}};
             },
             "nearest"});
        options->size = "256x256";
        kind->add_option("--size", options->size, "Of a slice, at most the map's")
            ->capture_default_str();
        kind->add_option("--slices", options->slices, "From height 0 to 1")->capture_default_str();
    }
    {
        const auto [kind, options] = from_heights(
            {"view-dependent", "Where each view ray meets the relief, slices below each other",
             views, [](const Options& given) {
                 return maps::BakeSettings{{"size", given.size},
                                           {"views", fmt::format("{}", given.views)}};
             }});
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

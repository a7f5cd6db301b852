// `intaglio sheet`: all searches side by side.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/cli/progress.h"
#include "src/maps/png.h"
#include "src/measure/measure.h"
#include "src/report/exhibit.h"
#include "src/report/grid_sheet.h"
#include "src/report/wall.h"

namespace intaglio::cli {
namespace {

namespace fs = std::filesystem;

constexpr double scale = 0.08, eye_azimuth = 70;
constexpr measure::Direction light = {40, 205};
// Texels a side of the maps, and pixels of the straight pictures: larger maps are made smaller, so
// that their bakes take no longer than looking at them.
constexpr int side = 256;

maps::Image at_most_side(maps::Image image) {
    const std::vector<maps::Image> levels = maps::mip_chain(image);
    for (const maps::Image& level : levels)
        if (std::max(level.width, level.height) <= side) return level;
    return image;
}

Result<measure::MapSet> small_set(const measure::MapFiles& files) {
    Result<measure::MapSet> set = measure::load_map_set(files, scale);
    if (!set) return set;
    set->heights = at_most_side(std::move(set->heights));
    set->normal_height = at_most_side(std::move(set->normal_height));
    set->colour = at_most_side(std::move(set->colour));
    return set;
}

// The procedural maps first, then the real ones in the order of their names, or the user's.
Result<std::vector<measure::MapSet>> maps_of(const SheetOptions& options) {
    std::vector<measure::MapSet> sets;
    for (const char* maker : {"bricks", "text", "fur"}) {
        Result<measure::MapSet> set = measure::make_map_set(maker, side, side, scale);
        if (!set) return set.error();
        sets.push_back(std::move(*set));
    }
    std::vector<measure::MapFiles> files;
    if (!options.height.empty()) {
        files.push_back({options.height, {}, {}});
    } else {
        std::error_code failure;
        for (const fs::directory_entry& entry : fs::directory_iterator(options.maps, failure)) {
            const fs::path heights = entry.path() / "normal_height.png";
            if (fs::exists(heights, failure))
                files.push_back({heights, heights, entry.path() / "colour.png"});
        }
        if (files.empty())
            return input_error("no-map",
                               "no folder in here has a normal_height.png and a colour.png",
                               options.maps);
    }
    std::sort(files.begin(), files.end(),
              [](const auto& a, const auto& b) { return a.height < b.height; });
    for (const measure::MapFiles& map : files) {
        Result<measure::MapSet> set = small_set(map);
        if (!set) return set.error();
        sets.push_back(std::move(*set));
    }
    return sets;
}

// A search's two shaders, of any map.
struct Compiled {
    std::string name;
    check::Program shaded, displaced;
};

Result<std::vector<Compiled>> compile(const dsl::Catalogue& catalogue) {
    const auto program_of = [&](const std::string& surface) -> Result<check::Program> {
        VariantRequest request;
        request.surface = surface;
        request.target = "glsl_450";
        const Result<Variant> variant = make_variant(catalogue, request);
        if (!variant) return variant.error();
        return link_variant(*variant);
    };
    std::vector<Compiled> all;
    for (const auto& row : catalogue.searches) {
        const std::string surface = fmt::format("search={},shadow=march", row.name);
        Result<check::Program> shaded = program_of(surface);
        if (!shaded) return shaded.error();
        Result<check::Program> displaced =
            program_of(fmt::format("search={},output=displaced", row.name));
        if (!displaced) return displaced.error();
        all.push_back({row.name, std::move(*shaded), std::move(*displaced)});
    }
    return all;
}

// At most five letters.
std::string short_number(double texels) {
    if (texels < 0.001) return "<.001";
    return texels < 0.1 ? fmt::format("{:.3f}", texels) : fmt::format("{:.2g}", texels);
}

// The picture with the errors at its right, and both in figures below.
Result<report::Tile> cell(vulkan::Program& shaded, vulkan::Program& displaced,
                          const report::DressedMap& map, const measure::ExactPicture& exact,
                          measure::Direction eye, int pixels) {
    for (vulkan::Program* program : {&shaded, &displaced})
        if (Status status = measure::aim(*program, eye, light); !status) return status.error();
    const Result<std::vector<vulkan::Picture>> picture = shaded.draw();
    if (!picture) return picture.error();
    const Result<std::vector<vulkan::Picture>> hits = displaced.draw();
    if (!hits) return hits.error();
    const std::vector<measure::HitError> errors =
        measure::compare_hits(hits->front(), exact, map.field, eye, static_cast<float>(scale));
    const measure::HitStatistics statistics = measure::summarize(errors, side);
    // Hairs are too fine to be seen among as many of them.
    const report::WallView wall{eye, pixels, pixels, map.set.name == "fur" ? 0.25 : 0.6, {}};
    const maps::Image left = report::wall_picture(report::to_image(picture->front()), wall,
                                                  report::Footprint::Mean),
                      right = report::wall_picture(report::error_pixels(errors, side), wall,
                                                   report::Footprint::Nearest);
    maps::Image both = maps::blank_image(2 * pixels, pixels, 3, 8);
    for (int y = 0; y < pixels; ++y)
        for (int x = 0; x < 2 * pixels; ++x)
            for (int c = 0; c < 3; ++c)
                both.at(x, y, c) = x < pixels ? left.at(x, y, c) : right.at(x - pixels, y, c);
    return report::Tile{std::move(both),
                        fmt::format("p95 {} miss {:.1f}%", short_number(statistics.p95),
                                    100.0 * static_cast<double>(statistics.missed) /
                                        static_cast<double>(statistics.pixels))};
}

// One column of every sheet.
Status add_column(const vulkan::Device& device, const std::vector<Compiled>& searches,
                  measure::MapSet set, const SheetOptions& options,
                  std::vector<report::Grid>& sheets) {
    const report::DressedMap map(std::move(set));
    std::vector<measure::ExactPicture> exact;
    for (std::size_t i = 0; i < sheets.size(); ++i) {
        exact.push_back(measure::trace_exact(map.field, {options.elevations[i], eye_azimuth}, light,
                                             static_cast<float>(scale), side, side));
        sheets[i].column_titles.push_back(map.set.name);
    }
    for (std::size_t row = 0; row < searches.size(); ++row) {
        Result<vulkan::Program> shaded =
            measure::prepare_quad(device, searches[row].shaded, map.textures, scale, side, side);
        if (!shaded) return shaded.error();
        Result<vulkan::Program> displaced =
            measure::prepare_quad(device, searches[row].displaced, map.textures, scale, side, side);
        if (!displaced) return displaced.error();
        for (std::size_t i = 0; i < sheets.size(); ++i) {
            Result<report::Tile> tile = cell(*shaded, *displaced, map, exact[i],
                                             {options.elevations[i], eye_azimuth}, options.size);
            if (!tile) return tile.error();
            sheets[i].rows[row].cells.push_back(std::move(*tile));
        }
    }
    return Done{};
}

}  // namespace

Status write_sheets(const dsl::Catalogue& catalogue, const SheetOptions& options) {
    Result<std::vector<measure::MapSet>> sets = maps_of(options);
    if (!sets) return sets.error();
    const Result<std::vector<Compiled>> searches = compile(catalogue);
    if (!searches) return searches.error();
    const Result<vulkan::Device> device = vulkan::Device::create({options.device, false});
    if (!device) return device.error();
    std::error_code failure;
    fs::create_directories(options.output, failure);
    if (failure)
        return input_error("file-unwritable",
                           fmt::format("cannot make this folder: {}", failure.message()),
                           options.output);
    std::vector<report::Grid> sheets(options.elevations.size());
    for (std::size_t i = 0; i < sheets.size(); ++i) {
        sheets[i].title = fmt::format(
            "every search, seen {:g} degrees above the surface: picture | error in texels",
            options.elevations[i]);
        sheets[i].letters = 2;
        sheets[i].scale = report::error_strip(2 * options.size);
        for (const Compiled& search : *searches) sheets[i].rows.push_back({search.name, {}});
    }
    ProgressLine progress("drew", "maps");
    for (std::size_t i = 0; i < sets->size(); ++i) {
        if (Status status = add_column(*device, *searches, std::move((*sets)[i]), options, sheets);
            !status)
            return status;
        progress(static_cast<int>(i) + 1, static_cast<int>(sets->size()));
    }
    for (std::size_t i = 0; i < sheets.size(); ++i) {
        const Result<maps::Image> sheet = report::grid_sheet(sheets[i]);
        if (!sheet) return sheet.error();
        const fs::path path =
            fs::path(options.output) / fmt::format("searches.{:g}.png", options.elevations[i]);
        if (Status status = maps::write_png(path, *sheet); !status) return status;
    }
    return Done{};
}

}  // namespace intaglio::cli

// `intaglio pages`: what the pages of the techniques have from the generator and the runner.  Text
// is people's; blocks between two comments are written here, and the pictures beside them.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <thread>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/maps/files.h"
#include "src/maps/png.h"
#include "src/measure/measure.h"
#include "src/report/cost_table.h"
#include "src/report/exhibit.h"
#include "src/report/page_block.h"

namespace intaglio::cli {
namespace {

namespace fs = std::filesystem;
using Error = report::Exhibit::Error;
using report::Exhibit;

// One view for every page, so that they can be compared: neither eye nor light along an axis.
constexpr double scale = 0.08, eye_azimuth = 70, light_azimuth = 205, steep = 60, flat = 15;
constexpr measure::Direction eye = {30, eye_azimuth}, light = {40, light_azimuth};
constexpr int size = 256;
constexpr std::size_t largest_page = std::size_t{1} << 24;  // bytes

// A page and the blocks that are to be written into it.
struct Page {
    fs::path path;
    std::string text;
};

struct Work {
    const dsl::Catalogue& catalogue;
    const PagesOptions& options;
    std::vector<Exhibit> exhibits;
    std::vector<report::DressedMap> maps;               // text, stone_bricks, fur
    std::map<std::string, std::string> figures, costs;  // of each block

    std::vector<const report::DressedMap*> maps_of(const Exhibit& exhibit) const {
        if (exhibit.fur) return {&maps[2]};
        return {&maps[0], &maps[1]};
    }
    measure::Shot shot(measure::Direction view, measure::Direction sun, int side) const {
        measure::Shot made;
        made.view = view;
        made.light = sun;
        made.scale = scale;
        made.width = made.height = side;
        return made;
    }
};

Result<std::vector<Page>> read_pages(const fs::path& folder) {
    std::error_code failure;
    std::vector<fs::path> paths;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure))
        if (entry.path().extension() == ".md") paths.push_back(entry.path());
    if (failure)
        return input_error("file-missing",
                           fmt::format("cannot read this folder of pages: {}", failure.message()),
                           folder.string());
    std::sort(paths.begin(), paths.end());
    std::vector<Page> pages;
    for (const fs::path& path : paths) {
        const Result<std::vector<unsigned char>> bytes = maps::read_file(path, largest_page);
        if (!bytes) return bytes.error();
        pages.push_back({path, std::string(bytes->begin(), bytes->end())});
    }
    return pages;
}

// The page that has the block of that title.
Result<Page*> page_of(std::vector<Page>& pages, const std::string& title, const fs::path& folder) {
    for (Page& page : pages) {
        const std::vector<std::string> blocks = report::blocks_of(page.text);
        if (std::find(blocks.begin(), blocks.end(), title) != blocks.end()) return &page;
    }
    return input_error("page-missing",
                       fmt::format("no page has a block for {}: put '<!-- intaglio pages {} -->' "
                                   "and '<!-- end of what intaglio pages wrote -->' where it "
                                   "belongs",
                                   title, title),
                       folder.string());
}

Result<std::vector<Exhibit>> chosen_exhibits(const dsl::Catalogue& catalogue,
                                             const std::vector<std::string>& only) {
    std::vector<Exhibit> all = report::exhibits_of(catalogue), chosen;
    for (const std::string& title : only)
        if (std::none_of(all.begin(), all.end(),
                         [&](const Exhibit& e) { return e.title == title; }))
            return input_error("option-value",
                               fmt::format("--only: there is no block '{}'; they are called "
                                           "search=relief, shadow=march, fur",
                                           title));
    for (Exhibit& exhibit : all)
        if (only.empty() || std::find(only.begin(), only.end(), exhibit.title) != only.end())
            chosen.push_back(std::move(exhibit));
    return chosen;
}

Result<std::vector<report::DressedMap>> load_maps(const fs::path& folder) {
    const fs::path bricks = folder / "stone_bricks";
    Result<measure::MapSet> real = measure::load_map_set(
        {bricks / "normal_height.png", bricks / "normal_height.png", bricks / "colour.png"}, scale);
    if (!real) return real.error();
    std::vector<report::DressedMap> dressed;
    for (const char* maker : {"text", "fur"}) {
        Result<measure::MapSet> made = measure::make_map_set(maker, 256, 256, scale);
        if (!made) return made.error();
        dressed.emplace_back(std::move(*made));
    }
    dressed.insert(dressed.begin() + 1, report::DressedMap(std::move(*real)));
    return dressed;
}

// Rows of one kind of exhibit, drawn on the same maps, measured together: what is exact is traced
// once.
Status measure_rows(Work& work, Error kind, bool fur) {
    const bool shadows = kind == Error::Light;
    measure::Plan plan;
    plan.scale = scale;
    plan.size = size;
    plan.rounds = 0;
    std::vector<const Exhibit*> rows;
    const auto add = [&](const std::string& surface) {
        VariantRequest request;
        request.surface = surface;
        request.target = "glsl_450";
        plan.rows.push_back(std::move(request));
    };
    for (const Exhibit& exhibit : work.exhibits) {
        if (exhibit.error != kind || exhibit.fur != fur) continue;
        rows.push_back(&exhibit);
        // Of a search the reads are its own.
        add(shadows ? exhibit.shown : dsl::with_part(exhibit.shown, "shadow", "none"));
    }
    if (rows.empty()) return Done{};
    if (shadows) add("search=exact");
    for (const report::DressedMap* map : work.maps_of(*rows.front())) plan.maps.push_back(map->set);
    const std::vector<measure::Direction> varied = {{steep, shadows ? light_azimuth : eye_azimuth},
                                                    {flat, shadows ? light_azimuth : eye_azimuth}};
    plan.views = shadows ? std::vector{eye} : varied;
    plan.lights = shadows ? varied : std::vector{light};
    const Result<measure::Measurement> measured = measure::measure(work.catalogue, plan);
    if (!measured) return measured.error();
    for (std::size_t row = 0; row < rows.size(); ++row) {
        std::string text = shadows ? "| map, light | reads a pixel | wrong |\n|---|---|---|\n"
                                   : "| map, eye | reads a pixel | median | p95 | missed |\n"
                                     "|---|---|---|---|---|\n";
        for (std::size_t i = row; i < measured->cases.size(); i += plan.rows.size()) {
            const measure::CaseResult& result = measured->cases[i];
            const std::string name = plan.maps[static_cast<std::size_t>(result.map)].name;
            const double pixels = static_cast<double>(result.hits.pixels) / 100;
            if (shadows) {
                const measure::CaseResult& search = measured->cases[i - row + rows.size()];
                text += fmt::format("| {}, {:g} degrees | {:.1f} | {:.2f} % |\n", name,
                                    result.light.elevation, result.reads_mean - search.reads_mean,
                                    static_cast<double>(result.hits.shadow_wrong) / pixels);
            } else {
                text +=
                    fmt::format("| {}, {:g} degrees | {:.1f} | {:.2g} | {:.2g} | {:.2f} % |\n",
                                name, result.view.elevation, result.reads_mean, result.hits.median,
                                result.hits.p95, static_cast<double>(result.hits.missed) / pixels);
            }
        }
        work.figures[rows[row]->title] = text;
    }
    return Done{};
}

// How far colours are off, of the exhibits that are compared by them.
Result<std::string> colour_figures(const Work& work, const vulkan::Device& device,
                                   const Exhibit& exhibit) {
    std::string text = "| map, eye | mean | p95 | greatest, of 255 |\n|---|---|---|---|\n";
    for (const report::DressedMap* map : work.maps_of(exhibit))
        for (double elevation : {steep, flat}) {
            const Result<report::Drawn> drawn =
                report::draw_exhibit(device, work.catalogue, exhibit, *map,
                                     work.shot({elevation, eye_azimuth}, light, size));
            if (!drawn) return drawn.error();
            std::vector<float> values = drawn->values;
            std::sort(values.begin(), values.end());
            double sum = 0;
            for (float value : values) sum += static_cast<double>(value);
            text += fmt::format("| {}, {:g} degrees | {:.2f} | {:.0f} | {:.0f} |\n", map->set.name,
                                elevation, sum / static_cast<double>(values.size()),
                                values[values.size() * 95 / 100], values.back());
        }
    return text;
}

// What the surface of a block costs: alone, and shaded where that is something else.
std::vector<std::pair<std::string, std::string>> cost_surfaces(const Exhibit& exhibit) {
    const std::string part = exhibit.title.substr(0, exhibit.title.find('='));
    if (part == "search")
        return {{"alone", exhibit.title + ",output=displaced"},
                {"with normal map, colour map and Phong", exhibit.title}};
    if (part == "shadow") return {{"alone", "search=none," + exhibit.title + ",output=displaced"}};
    if (part == "output") return {{"with `search=parallax`", "search=parallax," + exhibit.title}};
    if (part == "fur") return {{"the whole surface", "fur"}};
    if (part != exhibit.title) return {{"with `search=none`", "search=none," + exhibit.title}};
    return {};
}

Status count_costs(Work& work) {
    std::atomic<std::size_t> next = 0;
    std::vector<Result<std::string>> texts(work.exhibits.size(), std::string());
    const auto cost_text = [&](const Exhibit& exhibit) -> Result<std::string> {
        std::vector<report::CostColumn> columns;
        for (const auto& [heading, surface] : cost_surfaces(exhibit)) {
            Result<std::vector<report::CostCell>> cells = report::costs_of(
                work.catalogue, surface,
                columns.empty() ? std::vector<report::CostCell>() : columns.front().cells);
            if (!cells) return cells.error();
            columns.push_back({heading, std::move(*cells)});
        }
        return columns.empty() ? std::string() : report::cost_table(columns);
    };
    {
        std::vector<std::jthread> threads;
        for (int i = 0; i < work.options.threads; ++i)
            threads.emplace_back([&] {
                for (std::size_t at = next++; at < texts.size(); at = next++)
                    texts[at] = cost_text(work.exhibits[at]);
            });
    }
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (!texts[i]) return texts[i].error();
        work.costs[work.exhibits[i].title] = std::move(*texts[i]);
    }
    return Done{};
}

std::string picture_name(const Exhibit& exhibit) {
    std::string name = exhibit.title;
    std::replace(name.begin(), name.end(), '=', '.');
    return name + ".png";
}

std::string_view error_words(const Exhibit& exhibit) {
    switch (exhibit.error) {
        case Error::Hits: return "how far the hit is from the exact one, in texels";
        case Error::Light: return "how far the light is from the exact one, in steps of 255";
        case Error::Colour: break;
    }
    return "the difference of the two pictures, in steps of 255";
}

std::string block(const Work& work, const Exhibit& exhibit) {
    std::string exact = fmt::format("`{}`", exhibit.exact);
    if (exhibit.geometry == Exhibit::Geometry::Tile) exact = "displaced geometry";
    std::string shown = fmt::format("`{}`", exhibit.shown);
    if (exhibit.geometry == Exhibit::Geometry::Tile) shown += " with `clip_tile = 1`";
    if (exhibit.geometry == Exhibit::Geometry::Shells) shown = "32 shells of `fur`";
    if (exhibit.geometry == Exhibit::Geometry::Displaced) shown = "displaced geometry";
    std::string text = fmt::format("![{} beside the exact picture, and the error]({})\n\n",
                                   exhibit.title, "../images/techniques/" + picture_name(exhibit));
    text += fmt::format(
        "*Left: {}. Middle: {}. Right: {}. `{}`, seen {:g} degrees above the "
        "surface.*\n\n",
        shown, exact, error_words(exhibit), work.maps_of(exhibit).front()->set.name, eye.elevation);
    text += work.figures.at(exhibit.title);
    const std::string& costs = work.costs.at(exhibit.title);
    if (!costs.empty()) text += "\n" + costs;
    return text;
}

// The searches of the front page's picture.
constexpr std::string_view overview[] = {"search=none",           "search=parallax",
                                         "search=steep_parallax", "search=parallax_occlusion",
                                         "search=cone_relaxed",   "search=exact"};

Status draw_pictures(Work& work, const vulkan::Device& device, const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure)
        return input_error("file-unwritable",
                           fmt::format("cannot make this folder: {}", failure.message()),
                           folder.string());
    std::vector<std::pair<std::string, report::Drawn>> at_a_glance;
    for (const Exhibit& exhibit : work.exhibits) {
        Result<report::Drawn> drawn =
            report::draw_exhibit(device, work.catalogue, exhibit, *work.maps_of(exhibit).front(),
                                 work.shot(eye, light, 2 * size));
        if (!drawn) return drawn.error();
        const Result<maps::Image> picture = report::exhibit_picture(exhibit, *drawn, eye);
        if (!picture) return picture.error();
        if (Status status = maps::write_png(folder / picture_name(exhibit), *picture); !status)
            return status;
        if (exhibit.error == Error::Colour) {
            Result<std::string> figures = colour_figures(work, device, exhibit);
            if (!figures) return figures.error();
            work.figures[exhibit.title] = std::move(*figures);
        }
        if (std::count(std::begin(overview), std::end(overview), exhibit.title) > 0)
            at_a_glance.emplace_back(exhibit.title.substr(exhibit.title.find('=') + 1),
                                     std::move(*drawn));
    }
    if (at_a_glance.size() < std::size(overview)) return Done{};  // a part of the pages alone
    const Result<maps::Image> picture = report::overview_picture(at_a_glance, eye);
    if (!picture) return picture.error();
    return maps::write_png(folder / "overview.png", *picture);
}

}  // namespace

Status write_pages(const dsl::Catalogue& catalogue, const PagesOptions& options) {
    Result<std::vector<Exhibit>> exhibits = chosen_exhibits(catalogue, options.only);
    if (!exhibits) return exhibits.error();
    const fs::path folder = fs::path(options.output) / "techniques";
    Result<std::vector<Page>> pages = read_pages(folder);
    if (!pages) return pages.error();
    for (const Exhibit& exhibit : *exhibits)
        if (const Result<Page*> page = page_of(*pages, exhibit.title, folder); !page)
            return page.error();
    Result<std::vector<report::DressedMap>> maps = load_maps(options.maps);
    if (!maps) return maps.error();
    Work work{catalogue, options, std::move(*exhibits), std::move(*maps), {}, {}};
    const Result<vulkan::Device> device = vulkan::Device::create({});
    if (!device) return device.error();
    if (Status status = count_costs(work); !status) return status;
    for (Error kind : {Error::Hits, Error::Light})
        for (bool fur : {false, true})
            if (Status status = measure_rows(work, kind, fur); !status) return status;
    const fs::path images = fs::path(options.output) / "images" / "techniques";
    if (Status status = draw_pictures(work, *device, images); !status) return status;
    for (const Exhibit& exhibit : work.exhibits) {
        const Result<Page*> page = page_of(*pages, exhibit.title, folder);
        if (!page) return page.error();
        Result<std::string> text = report::with_block((*page)->text, exhibit.title,
                                                      block(work, exhibit), (*page)->path.string());
        if (!text) return text.error();
        (*page)->text = std::move(*text);
    }
    for (const Page& page : *pages)
        if (Status status = write_product(page.path.string(), page.text, false); !status)
            return status;
    return Done{};
}

}  // namespace intaglio::cli

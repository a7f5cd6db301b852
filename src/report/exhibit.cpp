// Which surfaces stand beside each other, and how they are drawn.
#include "src/report/exhibit.h"

#include <cmath>

#include <fmt/format.h>

#include "src/measure/displaced.h"
#include "src/measure/shells.h"
#include "src/measure/split.h"
#include "src/report/grid_sheet.h"
#include "src/report/wall.h"

namespace intaglio::report {
namespace {

using Error = Exhibit::Error;
using Geometry = Exhibit::Geometry;

constexpr int shells = 32, subdivisions = 2;

// The search, shadow and normal that are right.
const std::string exact_surface = "search=exact,shadow=exact";

template <typename Kind>
void add_table(std::vector<Exhibit>& exhibits, std::string_view part,
               const std::vector<dsl::Entry<Kind>>& table, const Exhibit& model) {
    for (const dsl::Entry<Kind>& row : table) {
        Exhibit exhibit = model;
        exhibit.title = fmt::format("{}={}", part, row.name);
        exhibit.shown = dsl::with_part(exact_surface, part, row.name);
        exhibits.push_back(std::move(exhibit));
    }
}

// What the exact reference says, as the picture of output=displaced.
vulkan::Picture exact_hits(const measure::ExactPicture& exact) {
    vulkan::Picture picture{exact.width, exact.height, {}};
    for (std::size_t pixel = 0; pixel < exact.hits.size(); ++pixel) {
        const reference::Hit& hit = exact.hits[pixel];
        picture.pixels.push_back({static_cast<float>(hit.uv.x), static_cast<float>(hit.uv.y),
                                  static_cast<float>(hit.height), exact.lit[pixel] ? 1.0f : 0.0f});
    }
    return picture;
}

// Coordinates, which leave the map, repeated as the map is.
vulkan::Picture wrapped_coordinates(vulkan::Picture picture) {
    for (std::array<float, 4>& pixel : picture.pixels)
        for (std::size_t i = 0; i < 2; ++i) pixel[i] -= std::floor(pixel[i]);
    return picture;
}

struct Scene {
    const vulkan::Device& device;
    const dsl::Catalogue& catalogue;
    const DressedMap& map;
    const measure::Shot& shot;

    Result<vulkan::Picture> polygon(const std::string& surface,
                                    std::vector<std::pair<std::string, std::string>> knobs) const {
        VariantRequest request;
        request.surface = surface;
        request.target = "glsl_450";
        request.knobs = std::move(knobs);
        return measure::draw_shot(device, catalogue, request, map.textures, shot);
    }

    // Worn once; what leaves the map is background.
    Result<vulkan::Picture> tile(const std::string& surface) const {
        Result<vulkan::Picture> picture = polygon(surface, {{"clip_tile", "1"}});
        if (!picture) return picture;
        for (std::array<float, 4>& pixel : picture->pixels)
            if (pixel[3] == 0) pixel = measure::mesh_background;
        return picture;
    }

    // The relief as triangles; `margin`: how far they reach beyond the map's edges.
    Result<vulkan::Picture> displaced(const std::string& surface, double margin) const {
        const Result<vulkan::Mesh> mesh =
            measure::displaced_map(map.field, shot.scale, subdivisions, margin);
        if (!mesh) return mesh.error();
        VariantRequest request;
        request.surface = dsl::with_part(surface, "search", "displaced");
        request.target = "glsl_450";
        return geometry(request, *mesh, {});
    }

    Result<vulkan::Picture> layers(const std::string& surface) const {
        VariantRequest request;
        request.surface = surface;
        request.target = "glsl_450";
        const std::vector<double> edges = {-margin(), 1 + margin()};
        const Result<vulkan::Mesh> mesh =
            measure::shells_of(vulkan::quad({edges, edges}), shells, shot.scale);
        if (!mesh) return mesh.error();
        return geometry(measure::shells_request(request, shells), *mesh, measure::shells_link());
    }

    Result<vulkan::Picture> geometry(const VariantRequest& request, const vulkan::Mesh& mesh,
                                     const measure::PassLink& link) const {
        const Result<std::vector<check::Program>> passes =
            measure::link_passes(measure::with_geometry(catalogue), request);
        if (!passes) return passes.error();
        Result<vulkan::Program> program =
            measure::prepare_parallel(device, passes->front(), map.textures, shot.scale, shot.width,
                                      shot.height, mesh, shot.view, shot.light, link);
        if (!program) return program.error();
        if (!link.uniforms.empty())
            if (Status status = measure::set_shells(*program); !status) return status.error();
        Result<std::vector<vulkan::Picture>> pictures = program->draw();
        if (!pictures) return pictures.error();
        return std::move(pictures->front());
    }

    Result<vulkan::Picture> shown(const Exhibit& exhibit) const {
        switch (exhibit.geometry) {
            case Geometry::Displaced: return displaced(exhibit.shown, margin());
            case Geometry::Shells: return layers(exhibit.shown);
            case Geometry::Tile: return tile(exhibit.shown);
            case Geometry::Polygon: break;
        }
        return polygon(exhibit.shown, {});
    }

    Result<vulkan::Picture> exact(const Exhibit& exhibit) const {
        if (exhibit.geometry == Geometry::Tile) return displaced(exhibit.exact, 0);
        return polygon(exhibit.exact, {});
    }

    double margin() const { return measure::reach_of(shot.view, shot.scale) + 0.01; }
};

// The largest difference of a channel of what a screen shows, in steps of 8 bits.
std::vector<float> differences(const maps::Image& one, const maps::Image& other) {
    std::vector<float> values;
    for (int y = 0; y < one.height; ++y)
        for (int x = 0; x < one.width; ++x) {
            float most = 0;
            for (int c = 0; c < 3; ++c)
                most = std::max(most, std::abs(one.at(x, y, c) - other.at(x, y, c)));
            values.push_back(most * 255);
        }
    return values;
}

Result<Drawn> draw_hits(const Scene& scene, const Exhibit& exhibit, Drawn drawn) {
    const measure::Shot& shot = scene.shot;
    const Result<vulkan::Picture> displaced =
        scene.polygon(dsl::with_part(exhibit.shown, "output", "displaced"), {});
    if (!displaced) return displaced.error();
    const float scale = static_cast<float>(shot.scale);
    const measure::ExactPicture exact = measure::trace_exact(scene.map.field, shot.view, shot.light,
                                                             scale, shot.width, shot.height);
    if (exhibit.error == Error::Light) {
        for (std::size_t pixel = 0; pixel < exact.lit.size(); ++pixel)
            drawn.values.push_back(
                255 * std::abs(displaced->pixels[pixel][3] - (exact.lit[pixel] ? 1.0f : 0.0f)));
        drawn.error = error_pixels(drawn.values, shot.width, level_scale);
        return drawn;
    }
    const std::vector<measure::HitError> errors =
        measure::compare_hits(*displaced, exact, scene.map.field, shot.view, scale);
    for (const measure::HitError& error : errors) drawn.values.push_back(error.texels);
    drawn.error = error_pixels(errors, shot.width);
    if (exhibit.title == "output=displaced") {
        drawn.shown = to_image(wrapped_coordinates(*displaced));
        drawn.exact = to_image(wrapped_coordinates(exact_hits(exact)));
    }
    return drawn;
}

// Fewer colours, so that a picture among many in a repository stays small: steps that the grain of
// the maps hides.
maps::Image with_few_colours(maps::Image image) {
    constexpr float steps = 15;
    for (float& texel : image.texels) texel = std::round(texel * steps) / steps;
    return image;
}

}  // namespace

std::vector<Exhibit> exhibits_of(const dsl::Catalogue& catalogue) {
    std::vector<Exhibit> all;
    Exhibit model;
    model.exact = exact_surface;
    model.error = Error::Hits;
    add_table(all, "search", catalogue.searches, model);
    model.error = Error::Light;
    add_table(all, "shadow", catalogue.shadows, model);
    model.error = Error::Colour;
    model.exact_name = "phong";
    add_table(all, "shading", catalogue.shadings, model);
    model.exact = exact_surface + ",normal=from_hit";
    model.exact_name = "from_hit";
    add_table(all, "normal", catalogue.normals, model);
    model.exact = exact_surface;
    model.exact_name = "displaced geometry";
    model.geometry = Geometry::Tile;
    add_table(all, "output", catalogue.outputs, model);
    for (Exhibit& exhibit : all) {
        if (exhibit.title == "shadow=fur_depth") exhibit.fur = true;
        if (exhibit.title == "output=displaced") {
            exhibit.error = Error::Hits;
            exhibit.geometry = Geometry::Polygon;
            exhibit.exact_name = "exact";
        }
    }
    for (const dsl::Preset& preset : catalogue.presets)
        if (preset.name == "fur")
            all.push_back({"fur", "fur", "search=exact,shadow=fur_depth", Error::Hits,
                           Geometry::Polygon, true, "exact"});
    all.push_back({"shells", "fur", "search=exact,shadow=fur_depth", Error::Colour,
                   Geometry::Shells, true, "exact"});
    all.push_back({"displaced_geometry", exact_surface, exact_surface, Error::Colour,
                   Geometry::Displaced, false, "exact"});
    return all;
}

Result<Drawn> draw_exhibit(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                           const Exhibit& exhibit, const DressedMap& map,
                           const measure::Shot& shot) {
    const Scene scene{device, catalogue, map, shot};
    const Result<vulkan::Picture> shown = scene.shown(exhibit);
    if (!shown) return shown.error();
    const Result<vulkan::Picture> exact = scene.exact(exhibit);
    if (!exact) return exact.error();
    Drawn drawn{to_image(*shown), to_image(*exact), {}, {}};
    if (exhibit.error != Error::Colour) return draw_hits(scene, exhibit, std::move(drawn));
    drawn.values = differences(drawn.shown, drawn.exact);
    drawn.error = error_pixels(drawn.values, shot.width, level_scale);
    return drawn;
}

Result<maps::Image> exhibit_picture(const Exhibit& exhibit, const Drawn& drawn,
                                    measure::Direction view) {
    WallView wall;
    wall.view = view;
    wall.width = wall.height = 168;
    wall.across = exhibit.fur ? 0.25 : 0.5;
    if (exhibit.geometry == Geometry::Tile) {
        wall.across = 1.3;
        wall.outside = {0.112f, 0.117f, 0.131f};  // measure::mesh_background on a screen
    }
    const bool hits = exhibit.error == Error::Hits;
    Grid grid;
    grid.column_titles = {exhibit.title, exhibit.exact_name, "error"};
    grid.rows = {{"",
                  {{with_few_colours(wall_picture(drawn.shown, wall, Footprint::Mean)), ""},
                   {with_few_colours(wall_picture(drawn.exact, wall, Footprint::Mean)), ""},
                   {with_few_colours(wall_picture(drawn.error, wall, Footprint::Nearest)), ""}}}};
    grid.scale = error_strip(wall.height, hits ? texel_scale : level_scale, hits);
    return grid_sheet(grid);
}

Result<maps::Image> overview_picture(const std::vector<std::pair<std::string, Drawn>>& searches,
                                     measure::Direction view) {
    WallView wall;
    wall.view = view;
    wall.width = wall.height = 150;
    wall.across = 0.45;
    Grid grid;
    grid.rows.resize(2);
    for (const auto& [name, drawn] : searches) {
        grid.column_titles.push_back(name);
        const auto seen = [&](const maps::Image& image, Footprint footprint) {
            return Tile{with_few_colours(wall_picture(image, wall, footprint)), ""};
        };
        grid.rows[0].cells.push_back(seen(drawn.shown, Footprint::Mean));
        grid.rows[1].cells.push_back(seen(drawn.error, Footprint::Nearest));
    }
    grid.scale = error_strip(wall.height);
    return grid_sheet(grid);
}

}  // namespace intaglio::report

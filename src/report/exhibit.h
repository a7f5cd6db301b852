// What a page shows of a technique: its picture, the exact one, and where they differ.
#pragma once

#include <string>
#include <vector>

#include "generator/dsl/catalogue.h"
#include "src/measure/shot.h"
#include "src/report/picture.h"

namespace intaglio::report {

struct Exhibit {
    std::string title;         // "search=relief", "fur": what a page's block is called
    std::string shown, exact;  // surfaces
    // The error is of hits in texels, of light (visibility) or of colours, both in steps of 255.
    enum class Error { Hits, Light, Colour } error = Error::Colour;
    // Displaced: the relief as triangles; Shells: as layers; Tile: worn once, what leaves it is
    // dropped.
    enum class Geometry { Polygon, Displaced, Shells, Tile } geometry = Geometry::Polygon;
    bool fur = false;                  // looked at on a map of hairs
    std::string exact_name = "exact";  // what the second picture is called
};

// One for each technique of the catalogue but the vertex work, one for the preset fur where there
// is one, and one for each of the runner's geometries.
std::vector<Exhibit> exhibits_of(const dsl::Catalogue& catalogue);

// A map ready to be drawn.
struct DressedMap {
    measure::MapSet set;
    reference::HeightField field;
    measure::Textures textures;

    explicit DressedMap(measure::MapSet made)
        : set(std::move(made)),
          field(set.height_field(reference::FilterWeights::Exact)),
          textures(set, measure::Filtering::Float) {}
};

// Straight pictures, one pixel for each place of the polygon, and what is wrong with the first.
struct Drawn {
    maps::Image shown, exact, error;
    std::vector<float> values;  // of the error, by pixel
};

Result<Drawn> draw_exhibit(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                           const Exhibit& exhibit, const DressedMap& map,
                           const measure::Shot& shot);

// Some searches side by side, their errors below: what they are for at one glance.
Result<maps::Image> overview_picture(const std::vector<std::pair<std::string, Drawn>>& searches,
                                     measure::Direction view);

// The three side by side as the eye sees the wall, with the error's scale: a page's picture.
Result<maps::Image> exhibit_picture(const Exhibit& exhibit, const Drawn& drawn,
                                    measure::Direction view);

}  // namespace intaglio::report

// The tables of techniques a program knows: its own templates and a user's.  A technique is one
// row.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "generator/dsl/surface.h"

namespace intaglio::dsl {

template <typename Kind>
struct Entry {
    std::string name;     // "steep_parallax"
    std::string summary;  // one sentence
    std::string source;   // paper or page; empty: ours
    std::unique_ptr<Kind> (*make)();
};

// The row of technique T.
template <typename Kind, typename T>
Entry<Kind> entry(std::string name, std::string summary, std::string source) {
    return {std::move(name), std::move(summary), std::move(source),
            []() -> std::unique_ptr<Kind> { return std::make_unique<T>(); }};
}

// A composition that has a name of its own: "fur" = "search=steep_parallax,shadow=fur_depth".
struct Preset {
    std::string name;
    std::string composition;
};

struct Catalogue {
    std::vector<Entry<Search>> searches;
    std::vector<Entry<Shadow>> shadows;
    std::vector<Entry<NormalSource>> normals;
    std::vector<Entry<Shading>> shadings;
    std::vector<Entry<Output>> outputs;
    std::vector<Entry<VertexWork>> vertex_works;
    std::vector<Preset> presets;
};

// A surface from what a user writes: items separated by commas, each part=technique with the parts
// search, shadow, normal, shading, output and vertex.  The first item may be a preset's or a
// search's name instead, whose parts the others replace: "fur,output=displaced".  What is not named
// is the first row of its table.  Wrong names get a sentence with the nearest right one.
Result<Surface> make_surface(const Catalogue& catalogue, std::string_view text);

// The same composition with one part replaced: with_part("fur", "output", "displaced").
std::string with_part(std::string_view composition, std::string_view part,
                      std::string_view technique);

}  // namespace intaglio::dsl

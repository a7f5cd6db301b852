// Compositions from text.
#include "generator/dsl/catalogue.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "generator/base/nearest.h"

namespace intaglio::dsl {
namespace {

using Choices = std::map<std::string, std::string, std::less<>>;

const std::vector<std::string> part_names = {"search", "shadow", "normal", "shading", "output", "vertex"};

Result<Choices> split_composition(std::string_view text) {
    Choices choices;
    while (!text.empty()) {
        const std::size_t comma = text.find(',');
        const std::string_view item = text.substr(0, comma);
        text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos)
            return input_error("surface-syntax", fmt::format("'{}' is not of the form part=technique", item));
        const std::string part(item.substr(0, equals));
        if (std::find(part_names.begin(), part_names.end(), part) == part_names.end())
            return input_error("unknown-part", unknown_name_sentence("part of a surface", part, part_names));
        if (!choices.emplace(part, item.substr(equals + 1)).second)
            return input_error("surface-syntax", fmt::format("part '{}' is given twice", part));
    }
    return choices;
}

// Makes the technique chosen for a part, or the table's first row; notes its source in the description.
template <typename Kind>
Status choose(const std::vector<Entry<Kind>>& table, const Choices& choices, const std::string& part,
              std::unique_ptr<Kind>& chosen, std::string& description) {
    const auto choice = choices.find(part);
    const auto row = choice == choices.end()
                         ? table.begin()
                         : std::find_if(table.begin(), table.end(), [&](const auto& e) { return e.name == choice->second; });
    if (row == table.end()) {
        std::vector<std::string> names;
        for (const Entry<Kind>& e : table) names.push_back(e.name);
        return input_error("unknown-technique", unknown_name_sentence(part, choice->second, names));
    }
    chosen = row->make();
    if (!row->source.empty())
        description += fmt::format("{}{}: {} ({})", description.empty() ? "" : "\n", part, row->summary, row->source);
    return Done{};
}

}  // namespace

Result<Surface> make_surface(const Catalogue& catalogue, std::string_view text) {
    std::string composition(text);
    if (text.find('=') == std::string_view::npos) {
        const auto preset = std::find_if(catalogue.presets.begin(), catalogue.presets.end(),
                                         [&](const Preset& p) { return p.name == text; });
        const bool is_search = std::any_of(catalogue.searches.begin(), catalogue.searches.end(),
                                           [&](const auto& e) { return e.name == text; });
        if (preset == catalogue.presets.end() && !is_search) {
            std::vector<std::string> names;
            for (const Preset& p : catalogue.presets) names.push_back(p.name);
            for (const Entry<Search>& e : catalogue.searches)
                if (std::find(names.begin(), names.end(), e.name) == names.end()) names.push_back(e.name);
            return input_error("unknown-surface", unknown_name_sentence("surface", text, names));
        }
        composition = preset != catalogue.presets.end() ? preset->composition : "search=" + composition;
    }
    Result<Choices> choices = split_composition(composition);
    if (!choices) return choices.error();

    Surface surface;
    surface.name = text;
    for (const Status& status :
         {choose(catalogue.searches, *choices, "search", surface.search, surface.description),
          choose(catalogue.shadows, *choices, "shadow", surface.shadow, surface.description),
          choose(catalogue.normals, *choices, "normal", surface.normal, surface.description),
          choose(catalogue.shadings, *choices, "shading", surface.shading, surface.description),
          choose(catalogue.outputs, *choices, "output", surface.output, surface.description),
          choose(catalogue.vertex_works, *choices, "vertex", surface.vertex, surface.description)})
        if (!status) return status.error();
    return surface;
}

}  // namespace intaglio::dsl

// Compositions from text.
#include "generator/dsl/catalogue.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "generator/base/nearest.h"

namespace intaglio::dsl {
namespace {

using Choices = std::map<std::string, std::string, std::less<>>;

const std::vector<std::string> part_names = {"search",  "shadow", "normal",
                                             "shading", "output", "vertex"};

std::vector<std::string_view> split_items(std::string_view text) {
    std::vector<std::string_view> items;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        items.push_back(text.substr(begin, comma - begin));
        begin = comma + 1;
    }
    return items;
}

bool names_technique(std::string_view item) { return item.find('=') == std::string_view::npos; }

Result<Choices> parse_items(const std::vector<std::string_view>& items) {
    Choices choices;
    for (std::string_view item : items) {
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos)
            return input_error("surface-syntax",
                               fmt::format("'{}' is not of the form part=technique", item));
        const std::string part(item.substr(0, equals));
        if (std::find(part_names.begin(), part_names.end(), part) == part_names.end())
            return input_error("unknown-part",
                               unknown_name_sentence("part of a surface", part, part_names));
        if (!choices.emplace(part, item.substr(equals + 1)).second)
            return input_error("surface-syntax", fmt::format("part '{}' is given twice", part));
    }
    return choices;
}

// The parts that a preset's or a search's name stands for.
Result<Choices> choices_named(const Catalogue& catalogue, std::string_view name) {
    for (const Preset& preset : catalogue.presets)
        if (preset.name == name) return parse_items(split_items(preset.composition));
    std::vector<std::string> names;
    for (const Preset& preset : catalogue.presets) names.push_back(preset.name);
    for (const Entry<Search>& row : catalogue.searches) {
        if (row.name == name) return Choices{{"search", row.name}};
        names.push_back(row.name);
    }
    return input_error("unknown-surface", unknown_name_sentence("surface", name, names));
}

Result<Choices> parse_composition(const Catalogue& catalogue, std::string_view text) {
    std::vector<std::string_view> items = split_items(text);
    Choices base;
    if (names_technique(items.front())) {
        Result<Choices> named = choices_named(catalogue, items.front());
        if (!named) return named;
        base = std::move(*named);
        items.erase(items.begin());
    }
    Result<Choices> choices = parse_items(items);
    if (choices) choices->merge(base);  // keeps what the text says itself
    return choices;
}

// Makes the technique chosen for a part, or the table's first row; notes its source in the
// description.
template <typename Kind>
Status choose(const std::vector<Entry<Kind>>& table, const Choices& choices,
              const std::string& part, std::unique_ptr<Kind>& chosen, std::string& description) {
    const auto choice = choices.find(part);
    const auto row = choice == choices.end()
                         ? table.begin()
                         : std::find_if(table.begin(), table.end(),
                                        [&](const auto& e) { return e.name == choice->second; });
    if (row == table.end()) {
        std::vector<std::string> names;
        for (const Entry<Kind>& e : table) names.push_back(e.name);
        return input_error("unknown-technique", unknown_name_sentence(part, choice->second, names));
    }
    chosen = row->make();
    if (!row->source.empty())
        description += fmt::format("{}{}: {} ({})", description.empty() ? "" : "\n", part,
                                   row->summary, row->source);
    return Done{};
}

}  // namespace

Result<Surface> make_surface(const Catalogue& catalogue, std::string_view text) {
    const Result<Choices> choices = parse_composition(catalogue, text);
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

std::string with_part(std::string_view composition, std::string_view part,
                      std::string_view technique) {
    std::string replaced;
    for (std::string_view item : split_items(composition))
        if (item.substr(0, item.find('=')) != part || names_technique(item))
            replaced += (replaced.empty() ? "" : ",") + std::string(item);
    return fmt::format("{}{}{}={}", replaced, replaced.empty() ? "" : ",", part, technique);
}

}  // namespace intaglio::dsl

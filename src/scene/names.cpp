// Names in scene files.
#include "src/scene/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "generator/base/nearest.h"
#include "src/scene/words_of_cpp.h"

namespace intaglio::scene {
namespace {

// Names of the language's own headers (NAME.h would be found in their place), of what they define
// as macros or what a program has, and of Windows' devices (which no file can have).  In lower
// case.
constexpr std::string_view taken[] = {
    "assert",  "aux",    "com1",   "com2",     "com3",     "com4",      "complex",
    "con",     "ctype",  "errno",  "fenv",     "inttypes", "iso646",    "limits",
    "linux",   "locale", "lpt1",   "lpt2",     "lpt3",     "lpt4",      "main",
    "malloc",  "math",   "memory", "nul",      "null",     "posix",     "prn",
    "setjmp",  "signal", "std",    "stdalign", "stdarg",   "stdatomic", "stdbool",
    "stddef",  "stdint", "stdio",  "stdlib",   "string",   "strings",   "tgmath",
    "threads", "time",   "uchar",  "unistd",   "unix",     "wchar",     "wctype"};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

struct Row {
    std::string name;
    std::vector<std::string> knobs;
};

std::vector<std::string> names_of(const std::vector<dsl::KnobBase*>& knobs) {
    std::vector<std::string> names;
    for (const dsl::KnobBase* knob : knobs) names.push_back(knob->name());
    return names;
}

template <typename Kind>
std::vector<Row> rows_of(const std::vector<dsl::Entry<Kind>>& entries) {
    std::vector<Row> rows;
    for (const auto& entry : entries) rows.push_back({entry.name, names_of(entry.make()->knobs())});
    return rows;
}

std::vector<Row> rows_of(const dsl::Catalogue& catalogue, std::string_view part) {
    if (part == "search") return rows_of(catalogue.searches);
    if (part == "shadow") return rows_of(catalogue.shadows);
    if (part == "normal") return rows_of(catalogue.normals);
    if (part == "shading") return rows_of(catalogue.shadings);
    if (part == "output") return rows_of(catalogue.outputs);
    return rows_of(catalogue.vertex_works);
}

}  // namespace

std::vector<std::pair<std::string, Position>> read_names(Reader& reader, const Value& table,
                                                         std::string_view key) {
    std::vector<std::pair<std::string, Position>> names;
    const Member* member = table.find(key);
    if (!member) return names;
    const bool list = member->value.kind == Kind::Array;
    if (list && member->value.items.empty()) return names;
    const std::vector<std::string> texts = reader.texts(table, key);
    std::size_t text = 0;
    const auto add = [&](const Value& value) {
        if (value.kind == Kind::String && text < texts.size())
            names.emplace_back(texts[text++], value.position);
    };
    if (!list) add(member->value);
    for (const Value& item : member->value.items) add(item);
    return names;
}

std::string in_lower_case(std::string name) {
    for (char& c : name)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return name;
}

std::string wrong_identifier(const std::string& name) {
    const bool letters = std::all_of(name.begin(), name.end(),
                                     [](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
    if (name.empty() || !letters || !is_letter(name.front()))
        return fmt::format(
            "'{}' must be letters, digits and underscores, no digit first: it names files and C++ "
            "types",
            name);
    if (is_word_of_cpp(name))
        return fmt::format("'{}' is a word of C++, and types are named after it", name);
    return {};
}

std::string wrong_surface_name(const std::string& name) {
    if (std::string wrong = wrong_identifier(name); !wrong.empty()) return wrong;
    const bool capital = name.size() > 1 && name[0] == '_' && name[1] >= 'A' && name[1] <= 'Z';
    if (capital || name.find("__") != std::string::npos)
        return fmt::format(
            "'{}' is a name that C++ keeps for itself: two underscores, or one before a capital",
            name);
    if (std::find(std::begin(taken), std::end(taken), in_lower_case(name)) != std::end(taken))
        return fmt::format(
            "'{0}' is taken: {0}.h or a namespace {0} would stand in the way of the system's own",
            name);
    return {};
}

void check_pinned(Reader& reader, const Value& surface, const dsl::Catalogue& catalogue) {
    std::vector<std::string> knobs;
    for (std::string_view part : part_names) {
        const Member* member = surface.find(part);
        const bool pinned = member && member->value.kind == Kind::String;
        std::vector<std::string> names;
        for (const Row& row : rows_of(catalogue, part)) {
            names.push_back(row.name);
            if (pinned && row.name != member->value.text) continue;
            knobs.insert(knobs.end(), row.knobs.begin(), row.knobs.end());
        }
        if (pinned && std::find(names.begin(), names.end(), member->value.text) == names.end())
            reader.refuse(member->value.position, "unknown-technique",
                          unknown_name_sentence(part, member->value.text, names));
    }
    // Those of the surface as a whole.
    if (const auto any = dsl::make_surface(catalogue, catalogue.searches.front().name)) {
        const std::vector<std::string> whole = names_of(any->knobs());
        knobs.insert(knobs.end(), whole.begin(), whole.end());
    }
    std::sort(knobs.begin(), knobs.end());
    knobs.erase(std::unique(knobs.begin(), knobs.end()), knobs.end());
    const Value& table = reader.table(surface, "knobs");
    for (const Member& member : table.members)
        if (!std::binary_search(knobs.begin(), knobs.end(), member.key))
            reader.refuse(member.position, "unknown-knob",
                          unknown_name_sentence("knob", member.key, knobs));
}

}  // namespace intaglio::scene

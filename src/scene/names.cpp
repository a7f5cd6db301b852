// Names in scene files.
#include "src/scene/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "generator/base/nearest.h"

namespace intaglio::scene {
namespace {

// A struct of this name would not compile.
constexpr std::string_view words_of_cpp[] = {"alignas",       "alignof",     "and",
                                             "and_eq",        "asm",         "auto",
                                             "bitand",        "bitor",       "bool",
                                             "break",         "case",        "catch",
                                             "char",          "char16_t",    "char32_t",
                                             "char8_t",       "class",       "co_await",
                                             "co_return",     "co_yield",    "compl",
                                             "concept",       "const",       "const_cast",
                                             "consteval",     "constexpr",   "constinit",
                                             "continue",      "decltype",    "default",
                                             "delete",        "do",          "double",
                                             "dynamic_cast",  "else",        "enum",
                                             "explicit",      "export",      "extern",
                                             "false",         "float",       "for",
                                             "friend",        "goto",        "if",
                                             "inline",        "int",         "long",
                                             "mutable",       "namespace",   "new",
                                             "noexcept",      "not",         "not_eq",
                                             "nullptr",       "operator",    "or",
                                             "or_eq",         "private",     "protected",
                                             "public",        "register",    "reinterpret_cast",
                                             "requires",      "return",      "short",
                                             "signed",        "sizeof",      "static",
                                             "static_assert", "static_cast", "struct",
                                             "switch",        "template",    "this",
                                             "thread_local",  "throw",       "true",
                                             "try",           "typedef",     "typeid",
                                             "typename",      "union",       "unsigned",
                                             "using",         "virtual",     "void",
                                             "volatile",      "wchar_t",     "while",
                                             "xor",           "xor_eq"};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

template <typename Kind>
std::vector<std::string> names_of(const std::vector<dsl::Entry<Kind>>& entries) {
    std::vector<std::string> names;
    for (const auto& entry : entries) names.push_back(entry.name);
    return names;
}

std::vector<std::string> techniques_of(const dsl::Catalogue& catalogue, std::string_view part) {
    if (part == "search") return names_of(catalogue.searches);
    if (part == "shadow") return names_of(catalogue.shadows);
    if (part == "normal") return names_of(catalogue.normals);
    if (part == "shading") return names_of(catalogue.shadings);
    if (part == "output") return names_of(catalogue.outputs);
    return names_of(catalogue.vertex_works);
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

std::string wrong_identifier(const std::string& name) {
    const bool letters = std::all_of(name.begin(), name.end(),
                                     [](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
    if (name.empty() || !letters || !is_letter(name.front()))
        return fmt::format(
            "'{}' must be letters, digits and underscores, no digit first: it names files and C++ "
            "types",
            name);
    if (std::find(std::begin(words_of_cpp), std::end(words_of_cpp), name) != std::end(words_of_cpp))
        return fmt::format("'{}' is a word of C++, and types are named after it", name);
    return {};
}

void check_techniques(Reader& reader, const Value& surface, const dsl::Catalogue& catalogue) {
    for (std::string_view part : part_names) {
        const Member* member = surface.find(part);
        if (!member || member->value.kind != Kind::String) continue;
        const std::vector<std::string> names = techniques_of(catalogue, part);
        if (std::find(names.begin(), names.end(), member->value.text) == names.end())
            reader.refuse(member->value.position, "unknown-technique",
                          unknown_name_sentence(part, member->value.text, names));
    }
}

}  // namespace intaglio::scene

// toml++'s tree, copied into ours.
#include "src/scene/document.h"

#include <toml++/toml.h>

#include <algorithm>
#include <exception>

namespace intaglio::scene {
namespace {

Position position_of(const toml::source_region& region) {
    return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Value value_of(const toml::node& node);

// A table made by a header or a dotted key has no place of its own in every case: its first
// member's serves.
Value table_of(const toml::table& table) {
    Value value;
    for (const auto& [key, member] : table)
        value.members.push_back(
            {std::string(key.str()), position_of(key.source()), value_of(member)});
    std::stable_sort(value.members.begin(), value.members.end(),
                     [](const Member& a, const Member& b) { return a.position < b.position; });
    value.position = position_of(table.source());
    if (value.position.line == 0 && !value.members.empty())
        value.position = value.members.front().position;
    return value;
}

Value value_of(const toml::node& node) {
    if (const toml::table* table = node.as_table()) return table_of(*table);
    Value value;
    value.position = position_of(node.source());
    if (const toml::array* array = node.as_array()) {
        value.kind = Kind::Array;
        for (const toml::node& item : *array) value.items.push_back(value_of(item));
        if (value.position.line == 0 && !value.items.empty())
            value.position = value.items.front().position;
    } else if (const auto* text = node.as_string()) {
        value.kind = Kind::String;
        value.text = text->get();
    } else if (const auto* integer = node.as_integer()) {
        value.kind = Kind::Integer;
        value.integer = integer->get();
        value.real = static_cast<double>(value.integer);
    } else if (const auto* real = node.as_floating_point()) {
        value.kind = Kind::Float;
        value.real = real->get();
    } else if (const auto* boolean = node.as_boolean()) {
        value.kind = Kind::Boolean;
        value.boolean = boolean->get();
    } else {
        value.kind = Kind::Date;
        if (const auto* date = node.as_date())
            value.text = fmt::format("{:04}-{:02}-{:02}", date->get().year, date->get().month,
                                     date->get().day);
    }
    return value;
}

// One line, without the full stop that a Diagnostic does not have.
std::string one_sentence(std::string_view text) {
    std::string sentence(text);
    std::replace_if(
        sentence.begin(), sentence.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    while (!sentence.empty() && (sentence.back() == '.' || sentence.back() == ' '))
        sentence.pop_back();
    return sentence;
}

}  // namespace

std::string_view noun_of(Kind kind) {
    switch (kind) {
        case Kind::Boolean: return "true or false";
        case Kind::Integer: return "a whole number";
        case Kind::Float: return "a number with a fraction";
        case Kind::String: return "a string";
        case Kind::Array: return "an array";
        case Kind::Table: return "a table";
        case Kind::Date: break;
    }
    return "a date or time";
}

const Member* Value::find(std::string_view key) const {
    for (const Member& member : members)
        if (member.key == key) return &member;
    return nullptr;
}

Result<Value> parse_toml(std::string_view text, const std::string& file) {
    try {
        return table_of(toml::parse(text, file));
    } catch (const toml::parse_error& error) {
        const Position position = position_of(error.source());
        return input_error("scene-syntax", one_sentence(error.description()), file, position.line,
                           position.column);
    } catch (const std::exception& error) {
        return input_error("scene-syntax", one_sentence(error.what()), file);
    }
}

}  // namespace intaglio::scene

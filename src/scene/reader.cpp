// Typed reading with sentences.
#include "src/scene/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "generator/base/nearest.h"

namespace intaglio::scene {

std::string Reader::code(std::string_view what) const { return fmt::format("{}-{}", kind_, what); }

void Reader::refuse(Position position, std::string code, std::string sentence) {
    if (error_ && Position{error_->line, error_->column} <= position) return;
    error_ =
        input_error(std::move(code), std::move(sentence), file_, position.line, position.column);
}

bool Reader::is(const Value& value, Kind kind, std::string_view what) {
    if (value.kind == kind || (kind == Kind::Float && value.kind == Kind::Integer)) return true;
    refuse(value.position, code("type"),
           fmt::format("{} must be {}, and is {}", what,
                       kind == Kind::Float ? "a number" : noun_of(kind), noun_of(value.kind)));
    return false;
}

bool Reader::check_keys(const Value& table, std::string_view table_name,
                        std::span<const std::string_view> keys) {
    const std::vector<std::string> names(keys.begin(), keys.end());
    bool known = true;
    for (const Member& member : table.members) {
        if (std::find(names.begin(), names.end(), member.key) != names.end()) continue;
        known = false;
        refuse(member.position, code("unknown-key"),
               unknown_name_sentence(fmt::format("key of {}", table_name), member.key, names));
    }
    return known;
}

double Reader::number_of(const Value& value, std::string_view what, Range range) {
    if (!is(value, Kind::Float, what)) return range.least;
    if (value.real >= range.least && value.real <= range.most) return value.real;
    refuse(value.position, code("range"),
           fmt::format("{} is {}, and must be from {} to {}", what, value.real, range.least,
                       range.most));
    return range.least;
}

double Reader::number(const Value& table, std::string_view key, double fallback, Range range) {
    const Member* member = table.find(key);
    return member ? number_of(member->value, key, range) : fallback;
}

std::int64_t Reader::whole(const Value& table, std::string_view key, std::int64_t fallback,
                           Range range) {
    const Member* member = table.find(key);
    if (!member) return fallback;
    if (!is(member->value, Kind::Integer, key)) return fallback;
    const double value = number_of(member->value, key, range);
    return value == member->value.real ? member->value.integer : fallback;
}

std::string Reader::text(const Value& table, std::string_view key, std::string fallback) {
    const Member* member = table.find(key);
    return member && is(member->value, Kind::String, key) ? member->value.text
                                                          : std::move(fallback);
}

std::string Reader::date(const Value& table, std::string_view key) {
    const Member* member = table.find(key);
    return member && is(member->value, Kind::Date, key) ? member->value.text : std::string();
}

bool Reader::boolean(const Value& table, std::string_view key, bool fallback) {
    const Member* member = table.find(key);
    return member && is(member->value, Kind::Boolean, key) ? member->value.boolean : fallback;
}

std::vector<const Value*> Reader::items_of(const Member& member) {
    std::vector<const Value*> items;
    if (member.value.kind != Kind::Array) return {&member.value};
    for (const Value& item : member.value.items) items.push_back(&item);
    if (items.empty())
        refuse(member.value.position, code("empty"),
               fmt::format("{} must have at least one value", member.key));
    return items;
}

std::vector<double> Reader::numbers(const Value& table, std::string_view key,
                                    std::vector<double> fallback, Range range) {
    const Member* member = table.find(key);
    if (!member) return fallback;
    std::vector<double> values;
    for (const Value* item : items_of(*member)) {
        const double value = number_of(*item, key, range);
        if (std::find(values.begin(), values.end(), value) != values.end())
            refuse(item->position, code("duplicate"), fmt::format("{} has {} twice", key, value));
        values.push_back(value);
    }
    return values;
}

Span Reader::span(const Value& table, std::string_view key, Span fallback, Range range) {
    const Member* member = table.find(key);
    if (!member) return fallback;
    if (member->value.kind != Kind::Array) {
        const double one = number_of(member->value, key, range);
        return {one, one};
    }
    const std::vector<Value>& items = member->value.items;
    if (items.size() != 2) {
        refuse(member->value.position, code("type"),
               fmt::format("{} is a number or a range of two, and has {}", key, items.size()));
        return fallback;
    }
    const Span span{number_of(items[0], key, range), number_of(items[1], key, range)};
    if (span.least <= span.most) return span;
    refuse(member->value.position, code("range"),
           fmt::format("{} begins at {} and ends at {}: write the lesser first", key, span.least,
                       span.most));
    return fallback;
}

std::vector<double> Reader::vector_of(const Value& value, std::string_view what, std::size_t least,
                                      std::size_t most) {
    constexpr double any = std::numeric_limits<float>::max();
    std::vector<double> numbers;
    if (!is(value, Kind::Array, what)) return std::vector<double>(least);
    if (value.items.size() < least || value.items.size() > most) {
        const std::string wanted =
            least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
        refuse(
            value.position, code("type"),
            fmt::format("{} must have {} numbers, and has {}", what, wanted, value.items.size()));
        return std::vector<double>(least);
    }
    for (const Value& item : value.items) numbers.push_back(number_of(item, what, {-any, any}));
    return numbers;
}

std::vector<std::string> Reader::texts(const Value& table, std::string_view key) {
    const Member* member = table.find(key);
    std::vector<std::string> values;
    if (!member) return values;
    for (const Value* item : items_of(*member)) {
        if (!is(*item, Kind::String, key)) continue;
        if (std::find(values.begin(), values.end(), item->text) != values.end())
            refuse(item->position, code("duplicate"),
                   fmt::format("{} has '{}' twice", key, item->text));
        values.push_back(item->text);
    }
    return values;
}

std::size_t Reader::choice(const Value& table, std::string_view key, std::size_t fallback,
                           std::initializer_list<std::string_view> choices) {
    const Member* member = table.find(key);
    if (!member || !is(member->value, Kind::String, key)) return fallback;
    const auto found = std::find(choices.begin(), choices.end(), member->value.text);
    if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
    const std::vector<std::string> names(choices.begin(), choices.end());
    refuse(member->value.position, code("choice"),
           unknown_name_sentence(fmt::format("value of {}", key), member->value.text, names));
    return fallback;
}

const Value& Reader::table(const Value& parent, std::string_view key) {
    static const Value none;
    const Member* member = parent.find(key);
    if (!member || !is(member->value, Kind::Table, key)) return none;
    return member->value;
}

std::vector<const Value*> Reader::tables(const Value& parent, std::string_view key) {
    std::vector<const Value*> all;
    const Member* member = parent.find(key);
    if (!member) return all;
    if (member->value.kind != Kind::Array) {
        refuse(member->position, code("type"),
               fmt::format("there may be several of {0}, so write [[{0}]]", key));
        return all;
    }
    for (const Value& item : member->value.items)
        if (is(item, Kind::Table, fmt::format("each [[{}]]", key))) all.push_back(&item);
    return all;
}

}  // namespace intaglio::scene

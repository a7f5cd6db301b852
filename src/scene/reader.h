// Takes typed values out of a TOML tree and keeps the first thing that is wrong, as a sentence with
// the key, the line and the column.  A getter that refuses gives its fallback, so that the caller
// reads on and asks once, at the end.
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "src/scene/document.h"
#include "src/scene/span.h"

namespace intaglio::scene {

// Inclusive bounds.
struct Range {
    double least, most;
};

class Reader {
  public:
    // `kind` of file: what the codes below begin with in place of "scene".
    explicit Reader(std::string file, std::string kind = "scene")
        : file_(std::move(file)), kind_(std::move(kind)) {}

    // Of all refusals the one that stands first in the file.
    const std::optional<Diagnostic>& error() const { return error_; }
    void refuse(Position position, std::string code, std::string sentence);

    // Refuses members whose key is not among `keys`, with the nearest; `table_name` as in "[run]".
    // False where there is one: then what seems missing is probably there, misspelled.  Code
    // "scene-unknown-key".
    bool check_keys(const Value& table, std::string_view table_name,
                    std::span<const std::string_view> keys);
    bool check_keys(const Value& table, std::string_view table_name,
                    std::initializer_list<std::string_view> keys) {
        return check_keys(table, table_name, {keys.begin(), keys.size()});
    }

    // The member's value, or `fallback` where the table has none.  Codes: "scene-type",
    // "scene-range".
    double number(const Value& table, std::string_view key, double fallback, Range range);
    std::int64_t whole(const Value& table, std::string_view key, std::int64_t fallback,
                       Range range);
    std::string text(const Value& table, std::string_view key, std::string fallback);
    // "2026-12-31", written as a date of TOML; empty where there is none.
    std::string date(const Value& table, std::string_view key);
    bool boolean(const Value& table, std::string_view key, bool fallback);
    // A value on its own, `what` naming it.
    double number_of(const Value& value, std::string_view what, Range range);
    // A number or a list of different numbers, not empty.  Codes also "scene-empty",
    // "scene-duplicate".
    std::vector<double> numbers(const Value& table, std::string_view key,
                                std::vector<double> fallback, Range range);
    // A number, or [least, most].
    Span span(const Value& table, std::string_view key, Span fallback, Range range);
    // An array of `least` to `most` finite numbers; that many zeros where it is refused.
    std::vector<double> vector_of(const Value& value, std::string_view what, std::size_t least,
                                  std::size_t most);
    // A string or a list of different strings, not empty.
    std::vector<std::string> texts(const Value& table, std::string_view key);
    // The position in `choices` of the string under `key`; `fallback` where there is none.  Code
    // "scene-choice".
    std::size_t choice(const Value& table, std::string_view key, std::size_t fallback,
                       std::initializer_list<std::string_view> choices);

    // A table under `key`: written as [key] or key = {...}; an empty one where there is none.
    const Value& table(const Value& parent, std::string_view key);
    // The tables of [[key]].
    std::vector<const Value*> tables(const Value& parent, std::string_view key);

  private:
    bool is(const Value& value, Kind kind, std::string_view what);
    // The value itself, or its items.
    std::vector<const Value*> items_of(const Member& member);

    std::string code(std::string_view what) const;

    std::string file_, kind_;
    std::optional<Diagnostic> error_;
};

}  // namespace intaglio::scene

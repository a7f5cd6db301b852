// A TOML text as a tree of values that know their line and column, members in the order of the
// file.  Sentences about a scene point into it, and sweeps follow its order; toml++ sorts members
// by name, so the order is restored here.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::scene {

// 1-based; lines and columns as editors count them.
struct Position {
    int line = 0;
    int column = 0;
    auto operator<=>(const Position&) const = default;
};

enum class Kind { Boolean, Integer, Float, String, Array, Table, Date };

// "a string", "an array", ...: for sentences that say what was found.
std::string_view noun_of(Kind kind);

struct Member;

struct Value {
    Kind kind = Kind::Table;
    Position position;
    bool boolean = false;         // of Boolean
    std::int64_t integer = 0;     // of Integer
    double real = 0;              // of Float and Integer
    std::string text;             // of String; of a Date without time "2026-12-31"
    std::vector<Value> items;     // of Array
    std::vector<Member> members;  // of Table

    // The member of that name, or nothing.
    const Member* find(std::string_view key) const;
};

struct Member {
    std::string key;
    Position position;
    Value value;
};

// The whole text as one table.  `file` is what errors name.  Codes: "scene-syntax" (not TOML;
// toml++ says what it expected there).
Result<Value> parse_toml(std::string_view text, const std::string& file);

}  // namespace intaglio::scene

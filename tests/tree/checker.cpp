// An include is recognised at the start of a line, as the preprocessor does, also under #if: an
// arrow that only some build follows is an arrow.
#include "tests/tree/checker.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <set>

namespace intaglio::tree {
namespace {

struct Include {
    std::string_view name;
    bool quoted = false;
};

bool holds(std::string_view folder, std::string_view path) {
    return path == folder || (path.starts_with(folder) && path[folder.size()] == '/');
}

const Row* row_of(const Rules& rules, std::string_view path) {
    const Row* longest = nullptr;
    for (const Row& row : rules.rows)
        if (holds(row.path, path) && (!longest || row.path.size() > longest->path.size()))
            longest = &row;
    return longest;
}

bool contains(const std::vector<std::string_view>& list, std::string_view item) {
    return std::find(list.begin(), list.end(), item) != list.end();
}

void skip_blanks(std::string_view& text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
}

bool skip(std::string_view& text, std::string_view word) {
    skip_blanks(text);
    if (!text.starts_with(word)) return false;
    text.remove_prefix(word.size());
    return true;
}

// What the line includes; an empty name for an include whose name is a macro or is not closed.
std::optional<Include> include_of(std::string_view line) {
    if (!skip(line, "#") || !skip(line, "include")) return std::nullopt;
    skip_blanks(line);
    const bool quoted = line.starts_with('"');
    if (!quoted && !line.starts_with('<')) return Include{};
    line.remove_prefix(1);
    const std::size_t end = line.find(quoted ? '"' : '>');
    if (end == std::string_view::npos) return Include{};
    return Include{line.substr(0, end), quoted};
}

std::string list(const std::vector<std::string_view>& items) {
    std::string text;
    for (std::string_view item : items) (text += text.empty() ? "" : ", ") += item;
    return text.empty() ? "nothing" : text;
}

// Why a pure folder may not include this header of the C++ library or of another library; empty if
// it may.
std::string impurity(const Rules& rules, std::string_view name) {
    if (contains(rules.impure_headers, name)) return "reaches files, time, threads or chance";
    const bool foreign = name.find_first_of("/.") != std::string_view::npos;
    const bool allowed =
        std::any_of(rules.pure_libraries.begin(), rules.pure_libraries.end(),
                    [&](std::string_view prefix) { return name.starts_with(prefix); });
    return foreign && !allowed ? "belongs to a library other than fmt" : "";
}

std::string fault_of(const Rules& rules, std::string_view path, const Row& from, Include include) {
    if (include.name.empty()) return "includes a name that cannot be read here";
    const std::string name(include.name);
    if (!include.quoted) {
        const bool pure = std::any_of(rules.pure.begin(), rules.pure.end(),
                                      [&](std::string_view folder) { return holds(folder, path); });
        const std::string why = pure ? impurity(rules, include.name) : "";
        return why.empty() ? "" : "includes <" + name + ">, which " + why;
    }
    const Row* to = row_of(rules, include.name);
    if (!to)
        return "includes \"" + name +
               "\", which is no path from the root of the repository into a " +
               "folder with a row in tests/tree/rules.h";
    if (to == &from || contains(from.sees, to->path)) return "";
    return "includes \"" + name + "\" of " + std::string(to->path) + ", but " +
           std::string(from.path) + " may see only " + list(from.sees);
}

template <typename Visit>
void each_line(std::string_view text, Visit visit) {
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        visit(number, text.substr(0, end));
        if (end == std::string_view::npos) return;
        text.remove_prefix(end + 1);
    }
}

std::string at(std::string_view path, int line) {
    return std::string(path) + ":" + std::to_string(line) + ": ";
}

bool has_word(std::string_view line, std::string_view word) {
    const auto part_of_word = [&](std::size_t i) {
        return i < line.size() &&
               (std::isalnum(static_cast<unsigned char>(line[i])) || line[i] == '_');
    };
    for (std::size_t i = line.find(word); i != std::string_view::npos; i = line.find(word, i + 1))
        if ((i == 0 || !part_of_word(i - 1)) && !part_of_word(i + word.size())) return true;
    return false;
}

}  // namespace

std::vector<std::string> check_includes(const Rules& rules, std::string_view path,
                                        std::string_view text) {
    const Row* row = row_of(rules, path);
    if (!row) return {at(path, 1) + "is in a folder that has no row in tests/tree/rules.h"};
    std::vector<std::string> faults;
    each_line(text, [&](int number, std::string_view line) {
        const std::optional<Include> include = include_of(line);
        const std::string fault = include ? fault_of(rules, path, *row, *include) : "";
        if (!fault.empty()) faults.push_back(at(path, number) + fault);
    });
    return faults;
}

std::vector<std::string> check_text(const Rules& rules, std::string_view path,
                                    std::string_view text) {
    std::vector<std::string> faults;
    int lines = 0;
    each_line(text, [&](int number, std::string_view line) {
        lines = number;
        // In two parts, so that this file does not report itself.
        for (std::string_view mark : {"TO"
                                      "DO",
                                      "FIX"
                                      "ME"})
            if (has_word(line, mark))
                faults.push_back(at(path, number) + "marks unfinished work (" + std::string(mark) +
                                 ")");
    });
    if (lines > rules.longest_file && !contains(rules.tables, path))
        faults.push_back(at(path, rules.longest_file + 1) + "has " + std::to_string(lines) +
                         " lines; a file is full at " + std::to_string(rules.longest_file));
    return faults;
}

std::vector<std::string> check_rules(const Rules& rules) {
    std::vector<std::string> faults;
    // Take away rows that see only rows already taken: what remains sees itself in a circle.
    std::set<std::string_view> taken;
    for (std::size_t before = rules.rows.size() + 1; taken.size() != before;) {
        before = taken.size();
        for (const Row& row : rules.rows)
            if (std::all_of(row.sees.begin(), row.sees.end(),
                            [&](std::string_view seen) { return taken.contains(seen); }))
                taken.insert(row.path);
    }
    for (const Row& row : rules.rows) {
        for (std::string_view seen : row.sees)
            if (std::none_of(rules.rows.begin(), rules.rows.end(),
                             [&](const Row& other) { return other.path == seen; }))
                faults.push_back(std::string(row.path) + " sees " + std::string(seen) +
                                 ", which has no row");
        if (!taken.contains(row.path))
            faults.push_back(std::string(row.path) + " stands in or above a circle");
    }
    return faults;
}

}  // namespace intaglio::tree

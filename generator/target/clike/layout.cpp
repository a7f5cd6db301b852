// Breaking works on the finished text of one statement: it holds no strings and no comments, so
// parentheses tell the structure.
#include "generator/target/clike/layout.h"

#include <algorithm>

namespace intaglio::clike {
namespace {

struct Operator {
    std::string_view word;
    int strength;  // loose ones are better places to break; a comma has 0
};

constexpr Operator operators[] = {{"?", 1},  {":", 1}, {"||", 2}, {"&&", 3}, {"<", 4},
                                  {"<=", 4}, {">", 4}, {">=", 4}, {"==", 4}, {"!=", 4},
                                  {"+", 5},  {"-", 5}, {"*", 6},  {"/", 6}};
constexpr int strengths = 7;

// The strength of the operator that starts here; -1 if none does.
int operator_at(std::string_view text, std::size_t i) {
    const std::size_t end = text.find(' ', i);
    const std::string_view word = text.substr(i, end == std::string_view::npos ? end : end - i);
    for (const Operator& known : operators)
        if (known.word == word) return known.strength;
    return -1;
}

// The best place to end a line of at most `width`: least nested, then loosest, then furthest right;
// 0 if there is none.
std::size_t best_break(std::string_view text, std::size_t width) {
    std::size_t best_at = 0;
    int best_cost = 0;
    int depth = 0;
    for (std::size_t i = 1; i < text.size() && i <= width; ++i) {
        const char before = text[i - 1];
        if (before == '(' || before == '[') ++depth;
        if (before == ')' || before == ']') --depth;
        if (before != ' ') continue;
        const bool after_comma = i >= 2 && (text[i - 2] == ',' || text[i - 2] == ';');
        const int strength = after_comma ? 0 : operator_at(text, i);
        if (strength < 0) continue;
        const int cost = depth * strengths + strength;
        if (best_at == 0 || cost <= best_cost) {
            best_at = i;
            best_cost = cost;
        }
    }
    return best_at;
}

}  // namespace

void put_statement(TextBuilder& out, std::string_view statement) {
    bool continued = false;
    while (true) {
        const auto room = static_cast<std::size_t>(std::max(20, line_width - out.column()));
        std::size_t end = statement.size() <= room ? 0 : best_break(statement, room);
        if (end == 0) {
            out.line(statement);
            break;
        }
        std::string_view line = statement.substr(0, end);
        while (line.ends_with(' ')) line.remove_suffix(1);
        out.line(line);
        statement.remove_prefix(end);
        if (!continued) out.indent();
        continued = true;
    }
    if (continued) out.outdent();
}

void put_comment(TextBuilder& out, std::string_view words) {
    std::string clean;
    for (char c : words) clean += c == '\n' || c == '\r' || c == '\t' ? ' ' : c == '\\' ? '/' : c;
    const auto room = static_cast<std::size_t>(std::max(20, line_width - out.column() - 3));
    std::string_view rest = clean;
    while (rest.size() > room) {
        std::size_t end = rest.rfind(' ', room);
        if (end == std::string_view::npos || end == 0) end = rest.find(' ', 1);
        if (end == std::string_view::npos) break;
        out.format("// {}", rest.substr(0, end));
        rest.remove_prefix(end + 1);
    }
    out.format("// {}", rest);
}

}  // namespace intaglio::clike
